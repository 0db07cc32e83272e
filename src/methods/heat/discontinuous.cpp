#include "methods/heat/discontinuous.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/disjoint_sets.h"
#include "base/index.h"
#include "methods/winding/jump_laplace.h"
#include "solve/network/l1_integration.h"
#include "solve/poisson/poisson.h"

namespace littoral {

namespace {

/// Y along side k of face f, from its corner k to k + 1.
double along_side(const JumpCalculus& J, const VecX& Y, int f, int k) {
  const Complex y(Y[2 * f], Y[2 * f + 1]);
  return (std::conj(y) * J.side[f][k]).real();
}

/// Where more than two corners meet in a value of its own: along an edge of three or more faces
/// (its sides), or at a vertex that faces share without an edge (their corners, twice).
struct Meeting {
  int edge = -1;
  double weight = 0;                   // what a jump of 1 costs each of them
  std::vector<std::array<int, 3>> at;  // face, corner, corner
};

std::vector<Meeting> meetings(const JumpCalculus& J, const MatX3i& vertex, const VecX& weight) {
  std::map<int, Meeting> at_edges;
  DisjointSets joined(3 * J.n_faces);
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) {
      const int e = J.edge(f, k);
      if (J.manifold[e]) continue;
      const auto [tail, head] = J.ends({f, k});
      Meeting& meeting = at_edges[e];
      if (!meeting.at.empty()) {
        const auto& [g, other_tail, other_head] = meeting.at[0];
        joined.join(3 * f + tail, 3 * g + other_tail);
        joined.join(3 * f + head, 3 * g + other_head);
      }
      meeting.at.push_back({f, tail, head});
    }
  std::vector<Meeting> all;
  for (auto& [e, meeting] : at_edges) {
    meeting.edge = e;
    meeting.weight = weight[e];
    all.push_back(std::move(meeting));
  }
  // Corners of one node are joined; what stays apart at a vertex touches there only.
  std::vector<int> of_node(J.n_nodes, -1);
  std::map<int, std::vector<int>> corners;  // by vertex
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) {
      int& first = of_node[J.node(f, k)];
      if (first >= 0)
        joined.join(3 * f + k, first);
      else
        corners[vertex(f, k)].push_back(first = 3 * f + k);
    }
  const double least = 1e-4 * J.length.sum() / static_cast<double>(J.length.size());
  for (const auto& [v, firsts] : corners) {
    const int one = joined.find(firsts[0]);
    if (std::all_of(firsts.begin(), firsts.end(), [&](int c) { return joined.find(c) == one; }))
      continue;
    Meeting& meeting = all.emplace_back();
    meeting.weight = least;
    for (const int c : firsts) meeting.at.push_back({c / 3, c % 3, c % 3});
  }
  return all;
}

/// Values at corners before the faces are shifted, as eq. 16's problem of one unknown per face, per
/// meeting, and for what is held.
struct Integration {
  L1Integration problem;
  std::vector<double> c, w;

  void add(int f, int g, double offset, double weight) {
    problem.f.push_back(f);
    problem.g.push_back(g);
    c.push_back(offset);
    w.push_back(weight);
  }
};

double mean_of(const MatX3& phi, const std::array<int, 3>& at) {
  return 0.5 * (phi(at[0], at[1]) + phi(at[0], at[2]));
}

/// Corners at one node that are joined, across edges and in meetings, by jumps below the threshold.
MatX3i pieces(const JumpCalculus& J, const MatX3& phi, const VecX& jump,
              const std::vector<Meeting>& all, const VecX& value, double threshold, int& n) {
  DisjointSets corners(3 * J.n_faces);
  for (int e = 0; e < J.n_edges; ++e) {
    if (!J.interior(e) || !(std::abs(jump[e]) < threshold)) continue;
    const auto& [left, right] = J.sides[e];
    const auto a = J.ends(left), b = J.ends(right);
    for (int end = 0; end < 2; ++end) corners.join(3 * left.face + a[end], 3 * right.face + b[end]);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::array<int, 3>* first = nullptr;
    for (const auto& at : all[i].at) {
      if (!(std::abs(mean_of(phi, at) - value[i]) < threshold)) continue;
      if (first)
        for (int end = 1; end < 3; ++end)
          corners.join(3 * (*first)[0] + (*first)[end], 3 * at[0] + at[end]);
      else
        first = &at;
    }
  }
  const std::vector<int> piece = corners.numbered(n);
  return Eigen::Map<const MatX3i>(piece.data(), J.n_faces, 3);
}

/// One backward Euler step of heat flow on the split surface, from the mean of the corners that
/// share a value. Only what the jumps bring in flows: (M + t L) phi = M phi0 + t div Y, so that a
/// function without jumps stays as it is, at the boundary too. Values at held corners are 0.
void flow(const JumpCalculus& J, DiscontinuousField& field, int n, const HeldSource& held, double t,
          const Task& task) {
  std::vector<char> zero(std::size_t(n), 0);
  for (const auto& [f, k] : held.corners) zero[field.piece(f, k)] = 1;
  Triplets entries;
  entries.reserve(12 * std::size_t(J.n_faces));
  VecX mass = VecX::Zero(n), b = mass;
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) {
      const int i = field.piece(f, k), j = field.piece(f, (k + 1) % 3);
      const double w = t * J.weight(f, k), m = J.area[f] / 3;
      mass[i] += m;
      const double slope = w * (field.phi(f, k) - field.phi(f, (k + 1) % 3));
      b[i] += m * field.phi(f, k) + slope;
      b[j] -= slope;
      entries.emplace_back(i, i, w);
      entries.emplace_back(j, j, w);
      entries.emplace_back(std::max(i, j), std::min(i, j), -w);
    }
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, mass[i]);
  SpMat A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  for (int i = 0; i < n; ++i)
    if (zero[i]) b[i] = 0;
  const VecX phi = DefiniteSystem(eliminated(A, zero), task).solve(b);
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) field.phi(f, k) = phi[field.piece(f, k)];
}

}  // namespace

VecX edge_curl(const JumpCalculus& J, const VecX& Y) {
  VecX least = VecX::Constant(J.n_edges, infinity), largest = VecX::Constant(J.n_edges, -infinity);
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) {
      const int e = J.edge(f, k);
      const double along = J.along(f, k) * along_side(J, Y, f, k) / J.length[e];
      least[e] = std::min(least[e], along);
      largest[e] = std::max(largest[e], along);
    }
  return (least.array() < infinity).select(largest - least, 0.0);
}

DiscontinuousField integrate_discontinuous(const JumpCalculus& J, const MatX3i& vertex,
                                           const VecX& Y, const HeldSource& held,
                                           double jump_threshold, double t, const Task& whole,
                                           Report& report) {
  Task task = whole;
  DiscontinuousField field{MatX3::Zero(J.n_faces, 3), {}, {}, 0, 0};
  MatX3& phi = field.phi;
  for (int f = 0; f < J.n_faces; ++f) {
    phi(f, 1) = along_side(J, Y, f, 0);
    phi(f, 2) = -along_side(J, Y, f, 2);
  }
  const VecX weight = J.length.cwiseProduct((-edge_curl(J, Y)).array().exp().matrix());
  const VecX local_jump = jump_derivative(J, phi);
  const std::vector<Meeting> all = meetings(J, vertex, weight);
  Integration find;
  for (int e = 0; e < J.n_edges; ++e)
    if (J.interior(e) && J.sides[e][0].face != J.sides[e][1].face)
      find.add(J.sides[e][0].face, J.sides[e][1].face, local_jump[e], weight[e]);
  int n = J.n_faces;
  for (const Meeting& meeting : all) {
    for (const auto& at : meeting.at) find.add(at[0], n, mean_of(phi, at), meeting.weight);
    ++n;
  }
  const int zero = n;
  for (const HeldPoint& point : held.points) {
    double value = 0;
    for (int k = 0; k < 3; ++k) value += point.b[k] * phi(point.face, k);
    find.add(point.face, zero, value, point.weight);
  }
  find.problem.n = held.points.empty() ? n : n + 1;
  find.problem.c = Eigen::Map<const VecX>(find.c.data(), index(find.c.size()));
  find.problem.w = Eigen::Map<const VecX>(find.w.data(), index(find.w.size()));
  const L1Solution found = integrate_l1(find.problem, {}, task.stage(0.8, "least jumps"), report);
  VecX s = found.s;
  if (!held.points.empty()) s.array() -= s[zero];
  for (int f = 0; f < J.n_faces; ++f) phi.row(f).array() += s[f];
  field.jump = jump_derivative(J, phi);
  for (const Meeting& meeting : all) {
    if (meeting.edge < 0) continue;
    double least = mean_of(phi, meeting.at[0]), largest = least;
    for (const auto& at : meeting.at) {
      least = std::min(least, mean_of(phi, at));
      largest = std::max(largest, mean_of(phi, at));
    }
    field.jump[meeting.edge] = largest - least;
  }
  field.objective = found.primal;
  field.gap = found.gap();
  const VecX value = s.segment(J.n_faces, index(all.size()));
  int n_pieces = 0;
  field.piece = pieces(J, phi, field.jump, all, value, t > 0 ? jump_threshold : 0, n_pieces);
  if (t > 0) flow(J, field, n_pieces, held, t, task.stage(0.2, "heat flow"));
  return field;
}

double misaligned_fraction(const JumpCalculus& J, const MatX3& phi, const VecX& Y) {
  // The gradient g of a face has <g, side_k> = the difference of phi along it; the sign of <g, Y>
  // is all that matters.
  double all = 0, against = 0;
  for (int f = 0; f < J.n_faces; ++f) {
    const Complex y(Y[2 * f], Y[2 * f + 1]), a = J.side[f][0], b = -J.side[f][2];
    if (y == 0.0) continue;
    const double along_a = phi(f, 1) - phi(f, 0), along_b = phi(f, 2) - phi(f, 0);
    const double area = (std::conj(a) * b).imag();
    const Complex g = Complex(0, 1) * (along_b * a - along_a * b) / area;
    all += J.area[f];
    if (!((std::conj(g) * y).real() > 0)) against += J.area[f];
  }
  return all > 0 ? against / all : 0;
}

}  // namespace littoral
