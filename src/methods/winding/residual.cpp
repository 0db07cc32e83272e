#include "methods/winding/residual.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/index.h"
#include "littoral/error.h"
#include "methods/winding/jump_laplace.h"
#include "solve/poisson/poisson.h"

namespace littoral {

VecX harmonic_part(const JumpCalculus& J, const VecX& omega, const Task& task) {
  // Delta_2 = d1 star1^-1 d1^T; beta is 0 outside the boundary. Without one, constants are free on
  // orientable components: their first face is fixed.
  const VecX curl = J.d1(omega);
  std::vector<char> fixed(J.n_components, 0);
  for (int c = 0; c < J.n_components; ++c) fixed[c] = J.orientable[c];
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k)
      if (!J.interior(J.edge(f, k))) fixed[J.component[f]] = 0;
  std::vector<char> grounded(J.n_faces, 0);
  for (int f = 0; f < J.n_faces; ++f)
    if (fixed[J.component[f]]) {
      grounded[f] = 1;
      fixed[J.component[f]] = 0;
    }
  Triplets entries;
  entries.reserve(6 * std::size_t(J.n_faces));
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) {
      const int e = J.edge(f, k);
      const JumpCalculus::Side at = J.across(f, k);
      entries.emplace_back(f, f, 1 / J.star1[e]);
      if (at.face >= 0 && at.face < f && !grounded[f] && !grounded[at.face])
        entries.emplace_back(f, at.face, J.along(f, k) * J.along(at.face, at.k) / J.star1[e]);
    }
  SpMat Delta(J.n_faces, J.n_faces);
  Delta.setFromTriplets(entries.begin(), entries.end());
  VecX b = curl;
  for (int f = 0; f < J.n_faces; ++f)
    if (grounded[f]) b[f] = 0;
  const VecX beta = DefiniteSystem(Delta, task).solve(b);
  return omega - J.d1_transpose(beta).cwiseQuotient(J.star1);
}

MatX3 integrate_locally(const JumpCalculus& J, const VecX& gamma) {
  MatX3 v = MatX3::Zero(J.n_faces, 3);
  for (int f = 0; f < J.n_faces; ++f) {
    v(f, 1) = J.along(f, 0) * gamma[J.edge(f, 0)];
    v(f, 2) = -J.along(f, 2) * gamma[J.edge(f, 2)];
  }
  return v;
}

ResidualFunction integrate_jumps(const JumpCalculus& J, const MatX3& local, const VecX& weight,
                                 const VecX& lo, const VecX& hi, const std::vector<char>& take,
                                 const std::vector<int>& part, const L1Options& options,
                                 const Task& task, Report& report) {
  // What is free is one shift s per face, or part.
  ResidualFunction out{local, {}, 0, 0, true};
  const VecX offset = jump_derivative(J, out.v);
  L1Integration problem;
  std::vector<int> node(J.n_faces, -1), edges;
  std::vector<int> node_of_part(part.empty() ? 0 : J.n_faces, -1);
  for (int f = 0; f < J.n_faces; ++f) {
    if (!take[J.component[f]]) continue;
    int& n = part.empty() ? node[f] : node_of_part[part[f]];
    if (n < 0) n = problem.n++;
    node[f] = n;
  }
  double within = 0;  // cost of jumps that no shift changes
  for (int e = 0; e < J.n_edges; ++e)
    if (J.interior(e) && node[J.sides[e][0].face] >= 0) {
      if (node[J.sides[e][0].face] == node[J.sides[e][1].face]) {
        within += weight[e] * std::abs(offset[e]);
        continue;
      }
      edges.push_back(e);
      problem.f.push_back(node[J.sides[e][0].face]);
      problem.g.push_back(node[J.sides[e][1].face]);
    }
  const auto gather = [&](const VecX& all) {
    VecX some(all.size() ? index(edges.size()) : 0);
    for (Eigen::Index i = 0; i < some.size(); ++i) some[i] = all[edges[i]];
    return some;
  };
  problem.c = gather(offset);
  problem.w = gather(weight);
  problem.lo = gather(lo);
  problem.hi = gather(hi);
  const L1Solution solution =
      integrate_l1_if_bounded(std::move(problem), options, task, report, out.bounded);
  for (int f = 0; f < J.n_faces; ++f)
    if (node[f] >= 0) out.v.row(f).array() += solution.s[node[f]];
  out.jump = jump_derivative(J, out.v);
  out.objective = solution.primal + within;
  out.gap = solution.gap();
  return out;
}

}  // namespace littoral
