#include "methods/winding/dual_winding.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/index.h"
#include "base/stopwatch.h"
#include "solve/network/l1_integration.h"
#include "solve/poisson/poisson.h"

namespace littoral {

namespace {

/// A step from one face to another; `jump`, left minus right, belongs to the curve.
struct DualEdge {
  int left, right, edge;  // edge -1: one of the pairs
  double jump, star1, length;
};

std::vector<DualEdge> dual_edges(const JumpCalculus& J, const DualCurve& curve) {
  std::vector<DualEdge> all;
  for (int e = 0; e < J.n_edges; ++e) {
    if (!J.interior(e) || J.sides[e][0].face == J.sides[e][1].face) continue;
    all.push_back(
        {J.sides[e][0].face, J.sides[e][1].face, e, curve.edge[e], J.star1[e], J.length[e]});
  }
  for (const FacePair& p : curve.pairs)
    all.push_back({p.left, p.right, -1, p.jump, p.star1, J.length[p.edge]});
  return all;
}

/// The same surface; components connected by pairs are one.
JumpCalculus joined(const JumpCalculus& J, const std::vector<FacePair>& pairs) {
  JumpCalculus D = J;
  DisjointSets components(J.n_components);
  for (const FacePair& p : pairs) components.join(J.component[p.left], J.component[p.right]);
  const std::vector<int> number = components.numbered(D.n_components);
  for (int& c : D.component) c = number[c];
  return D;
}

/// argmin sum (u_left - u_right - jump)^2 / star1: d * d u = d * c. Mean 0 over each component.
VecX solve_dual_laplace(const JumpCalculus& D, const std::vector<DualEdge>& edges, const Task& task,
                        Report& report) {
  Triplets entries;
  for (int f = 0; f < D.n_faces; ++f) entries.emplace_back(f, f, 0.0);
  VecX b = VecX::Zero(D.n_faces);
  for (const DualEdge& e : edges) {
    const double w = 1 / e.star1;
    entries.emplace_back(e.left, e.left, w);
    entries.emplace_back(e.right, e.right, w);
    entries.emplace_back(std::max(e.left, e.right), std::min(e.left, e.right), -w);
    b[e.left] += w * e.jump;
    b[e.right] -= w * e.jump;
  }
  SpMat L(D.n_faces, D.n_faces);
  L.setFromTriplets(entries.begin(), entries.end());
  VecX u = Poisson(L, D.component, D.n_components, task).solve(b, report);
  VecX sum = VecX::Zero(D.n_components), area = sum;
  for (int f = 0; f < D.n_faces; ++f) {
    sum[D.component[f]] += D.area[f] * u[f];
    area[D.component[f]] += D.area[f];
  }
  for (int f = 0; f < D.n_faces; ++f) u[f] -= sum[D.component[f]] / area[D.component[f]];
  return u;
}

/// Once round a node, from face to face: the edges crossed, +1 from left to right.
using Turns = std::vector<std::pair<int, int>>;

/// Turns round all nodes inside the surface; empty on the boundary and where the surface is not
/// glued. The sense of each is its own.
std::vector<Turns> turns(const JumpCalculus& J) {
  std::vector<Turns> all(J.n_nodes);
  std::vector<char> seen(all.size(), 0);
  for (int start = 0; start < 3 * J.n_faces; ++start) {
    int f = start / 3, c = start % 3, k = c;
    const int i = J.node(f, c);
    if (seen[i]) continue;
    seen[i] = 1;
    do {
      const JumpCalculus::Side at = J.across(f, k);
      if (at.face < 0) {
        all[i].clear();
        break;
      }
      const int e = J.edge(f, k);
      const JumpCalculus::Side& left = J.sides[e][0];
      all[i].emplace_back(e, left.face == f && left.k == k ? 1 : -1);
      c = J.corner_across(f, c, at);
      f = at.face;
      k = at.k == c ? (c + 2) % 3 : c;
    } while (3 * f + c != start || k != start % 3);
  }
  return all;
}

/// gamma = omega - delta beta with d delta beta = d omega round every node (eq. 6.1.2, dual).
void subtract_coexact(const JumpCalculus& J, const Task& task, VecX& omega) {
  const std::vector<Turns> turn = turns(J);
  std::vector<int> unknown(turn.size(), -1), node_component(turn.size());
  std::vector<char> whole(J.n_components, 0);
  for (int c = 0; c < J.n_components; ++c) whole[c] = J.orientable[c];
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) {
      node_component[J.node(f, k)] = J.component[f];
      if (turn[J.node(f, k)].empty()) whole[J.component[f]] = 0;
    }
  int n = 0;
  for (std::size_t i = 0; i < turn.size(); ++i) {
    if (turn[i].empty()) continue;
    char& fix = whole[node_component[i]];  // constants are free there: one is fixed
    if (!std::exchange(fix, 0)) unknown[i] = n++;
  }
  if (n == 0) return;
  std::vector<std::vector<std::pair<int, int>>> at(J.n_edges);
  VecX curl = VecX::Zero(n);
  for (std::size_t i = 0; i < turn.size(); ++i) {
    if (unknown[i] < 0) continue;
    for (const auto& [e, sign] : turn[i]) {
      at[e].emplace_back(unknown[i], sign);
      curl[unknown[i]] += sign * omega[e];
    }
  }
  Triplets entries;
  for (int e = 0; e < J.n_edges; ++e)
    for (const auto& [i, si] : at[e])
      for (const auto& [j, sj] : at[e])
        if (i >= j) entries.emplace_back(i, j, si * sj * J.star1[e]);
  SpMat Delta(n, n);
  Delta.setFromTriplets(entries.begin(), entries.end());
  const VecX beta = DefiniteSystem(Delta, task).solve(curl);
  for (int e = 0; e < J.n_edges; ++e)
    for (const auto& [i, sign] : at[e]) omega[e] -= sign * J.star1[e] * beta[i];
}

/// What bounds nothing: the shortest chain that differs from the harmonic part by a boundary, least
/// of all on the curve, and there at most the curve. Subtracts it from the jumps of `edges`.
void take_out_nonbounding(const JumpCalculus& D, const VecX& gamma, const SurfaceWinding& options,
                          const Task& task, std::vector<DualEdge>& edges, WindingNumbers& result,
                          Report& report) {
  const Eigen::Index m = edges.size();
  L1Integration problem;
  problem.n = D.n_faces;
  problem.c = gamma;
  problem.w.resize(m);
  problem.lo = VecX::Constant(m, -infinity);
  problem.hi = -problem.lo;
  for (Eigen::Index a = 0; a < m; ++a) {
    const DualEdge& e = edges[a];
    problem.f.push_back(e.left);
    problem.g.push_back(e.right);
    problem.w[a] = e.length * (e.jump != 0 ? options.curve_weight : 1);
    if (e.jump == 0) continue;
    problem.lo[a] = std::min(0.0, -e.jump);
    problem.hi[a] = std::max(0.0, -e.jump);
  }
  bool bounded = true;
  const L1Solution v = integrate_l1_if_bounded(std::move(problem), {}, task, report, bounded);
  if (!bounded) report.warn("curve-crosses-itself", unbounded_warning);
  result.objective = v.primal;
  result.gap = v.gap();
  for (Eigen::Index a = 0; a < m; ++a) {
    DualEdge& e = edges[a];
    const double share = -(gamma[a] + v.s[e.left] - v.s[e.right]);
    if (e.jump == 0 || std::abs(share) <= 1e-7) continue;
    result.nonbounding[e.edge] = share;
    if (std::abs(share) > 0.5 * std::abs(e.jump)) e.jump = 0;
  }
}

CornerFunction at_corners(const JumpCalculus& J, const VecX& u) {
  return {u.replicate(1, 3), std::vector<char>(J.n_nodes, 0)};
}

}  // namespace

WindingNumbers dual_winding(const JumpCalculus& J, const DualCurve& curve,
                            const SurfaceWinding& options, Task task, Report& report) {
  const JumpCalculus D = joined(J, curve.pairs);
  std::vector<DualEdge> edges = dual_edges(J, curve);
  WindingNumbers result;
  result.curve = curve.edge;
  result.nonbounding = VecX::Zero(J.n_edges);
  result.v = MatX3::Zero(J.n_faces, 3);
  VecX u;
  {
    const Stopwatch watch(report, "dual Laplace");
    u = solve_dual_laplace(D, edges, task.stage(0.2, "dual Laplace"), report);
  }
  result.u = result.w = at_corners(J, u);
  // Round edges of three or more faces turns would have to be told apart from loops.
  if (!options.keep_nonbounding && !curve.pairs.empty())
    report.warn("nonmanifold-edges",
                "edges of three or more faces: parts of curves that bound nothing are kept");
  if (!options.keep_nonbounding && curve.pairs.empty()) {
    const Stopwatch watch(report, "residual function");
    // Steps 2 to 4.
    VecX omega = VecX::Zero(J.n_edges), gamma(edges.size());
    for (std::size_t a = 0; a < edges.size(); ++a) {
      const DualEdge& e = edges[a];
      omega[e.edge] = u[e.left] - u[e.right] - e.jump;
    }
    subtract_coexact(J, task.stage(0.3, "harmonic part"), omega);
    for (std::size_t a = 0; a < edges.size(); ++a) gamma[a] = omega[edges[a].edge];
    if (gamma.size() && gamma.cwiseAbs().maxCoeff() > 1e-9) {
      take_out_nonbounding(D, gamma, options, task.stage(0.7, "residual function"), edges, result,
                           report);
      result.w =
          at_corners(J, solve_dual_laplace(D, edges, task.stage(0.6, "dual Laplace"), report));
    }
  }
  result.bounding = bounding_part(result);
  label_regions(D, curve.pairs, options, task.stage(1, "labels"), result, report);
  return result;
}

}  // namespace littoral
