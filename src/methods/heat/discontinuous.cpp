#include "methods/heat/discontinuous.h"

#include <algorithm>
#include <cmath>

#include "base/disjoint_sets.h"
#include "methods/winding/jump_laplace.h"
#include "methods/winding/residual.h"
#include "solve/poisson/poisson.h"

namespace littoral {

namespace {

/// Y along side k of face f, from its corner k to k + 1.
double along_side(const JumpCalculus& J, const VecX& Y, int f, int k) {
  const Complex y(Y[2 * f], Y[2 * f + 1]);
  return (std::conj(y) * J.side[f][k]).real();
}

/// Corners at one node that are joined across edges where `joined`.
MatX3i pieces(const JumpCalculus& J, const std::vector<char>& joined, int& n) {
  DisjointSets corners(3 * J.n_faces);
  for (int e = 0; e < J.n_edges; ++e) {
    if (!J.interior(e) || !joined[e]) continue;
    const auto& [left, right] = J.sides[e];
    const auto a = J.ends(left), b = J.ends(right);
    for (int end = 0; end < 2; ++end) corners.join(3 * left.face + a[end], 3 * right.face + b[end]);
  }
  const std::vector<int> piece = corners.numbered(n);
  return Eigen::Map<const MatX3i>(piece.data(), J.n_faces, 3);
}

/// One backward Euler step (M + t L) phi = M phi0 of heat flow on the split surface, from the mean
/// of the corners that share a value.
void flow(const JumpCalculus& J, DiscontinuousField& field, int n, double t, const Task& task) {
  Triplets entries;
  entries.reserve(12 * std::size_t(J.n_faces));
  VecX mass = VecX::Zero(n), b = mass;
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) {
      const int i = field.piece(f, k), j = field.piece(f, (k + 1) % 3);
      const double w = t * J.weight(f, k), m = J.area[f] / 3;
      mass[i] += m;
      b[i] += m * field.phi(f, k);
      entries.emplace_back(i, i, w);
      entries.emplace_back(j, j, w);
      entries.emplace_back(std::max(i, j), std::min(i, j), -w);
    }
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, mass[i]);
  SpMat A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  const VecX phi = DefiniteSystem(A, task).solve(b);
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) field.phi(f, k) = phi[field.piece(f, k)];
}

}  // namespace

VecX edge_curl(const JumpCalculus& J, const VecX& Y) {
  VecX curl = VecX::Zero(J.n_edges);
  for (int e = 0; e < J.n_edges; ++e) {
    if (!J.interior(e)) continue;
    const auto& [left, right] = J.sides[e];
    curl[e] = (J.along(left.face, left.k) * along_side(J, Y, left.face, left.k) -
               J.along(right.face, right.k) * along_side(J, Y, right.face, right.k)) /
              J.length[e];
  }
  return curl;
}

DiscontinuousField integrate_discontinuous(const JumpCalculus& J, const VecX& Y,
                                           double jump_threshold, double t, const Task& whole,
                                           Report& report) {
  Task task = whole;
  MatX3 local = MatX3::Zero(J.n_faces, 3);
  for (int f = 0; f < J.n_faces; ++f) {
    local(f, 1) = along_side(J, Y, f, 0);
    local(f, 2) = -along_side(J, Y, f, 2);
  }
  const VecX weight = J.length.cwiseProduct((-edge_curl(J, Y).cwiseAbs()).array().exp().matrix());
  const ResidualFunction found =
      integrate_jumps(J, local, weight, {}, {}, std::vector<char>(J.n_components, 1), {}, {},
                      task.stage(0.8, "least jumps"), report);
  DiscontinuousField field{found.v, {}, found.jump, found.objective, found.gap};
  std::vector<char> joined(J.n_edges, 0);
  for (int e = 0; e < J.n_edges; ++e) joined[e] = t > 0 && std::abs(found.jump[e]) < jump_threshold;
  int n = 0;
  field.piece = pieces(J, joined, n);
  if (t > 0) flow(J, field, n, t, task.stage(0.2, "heat flow"));
  return field;
}

}  // namespace littoral
