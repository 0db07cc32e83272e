#include "solve/network/l1_integration.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/index.h"
#include "littoral/error.h"
#include "solve/network/flow_interior_point.h"
#include "solve/network/network_simplex.h"
#include "solve/network/spanning_tree.h"

namespace littoral {

namespace {

constexpr int simplex_alone = 8000;   // nodes
constexpr double near_enough = 1e-5;  // gap at which the simplex takes over
constexpr double at_bound = 0.03;     // room, as a share of all, that a flow has left at its bound

void check(const L1Integration& p) {
  const std::size_t m = p.c.size();
  const bool bounded = p.lo.size() > 0 || p.hi.size() > 0;
  if (p.f.size() != m || p.g.size() != m || p.w.size() != p.c.size() ||
      (bounded && (p.lo.size() != p.c.size() || p.hi.size() != p.c.size())))
    throw InputError("L1 integration: the lists have different lengths", "sizes-differ");
  for (std::size_t k = 0; k < m; ++k) {
    const Eigen::Index e = k;
    const std::string arc = "L1 integration: arc " + std::to_string(k);
    if (p.f[k] < 0 || p.f[k] >= p.n || p.g[k] < 0 || p.g[k] >= p.n || p.f[k] == p.g[k])
      throw InputError(arc + " does not join two nodes");
    if (!std::isfinite(p.c[e]) || !std::isfinite(p.w[e]) || p.w[e] < 0)
      throw InputError(arc + " has a negative or non-finite number");
    if (bounded && !(p.lo[e] <= 0 && p.hi[e] >= 0))
      throw InputError(arc + " has bounds that exclude zero");
  }
}

/// s such that c_e + s_f - s_g is `jump` on every arc of a forest, 0 at its roots. jump_at(arc)
/// gives the problem's arc e and the jump there.
template <class JumpAt>
VecX along_forest(const L1Integration& p, const Forest& forest, const JumpAt& jump_at) {
  VecX s = VecX::Zero(p.n);
  for (int u : forest.order) {
    if (forest.parent_arc[u] < 0) continue;
    const auto [e, jump] = jump_at(forest.parent_arc[u]);
    s[u] = p.f[e] == u ? s[p.g[e]] - p.c[e] + jump : s[p.f[e]] + p.c[e] - jump;
  }
  return s;
}

/// Integrates c along a spanning forest of the dearest arcs: with s measured from there, c is 0 on
/// the forest and round all loops where it is closed, exactly so where it was but for rounding.
/// What is left of it lies where jumps are cheap, near the optimum.
VecX integrate_over_forest(L1Integration& p) {
  std::vector<int> order;
  for (int e = 0; e < p.n_arcs(); ++e)
    if (p.w[e] > 0) order.push_back(e);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return p.w[a] > p.w[b]; });
  const VecX s = along_forest(p, spanning_forest(p.n, p.f, p.g, order),
                              [](int e) { return std::pair(Eigen::Index{e}, 0.0); });
  const double noise = p.c.size() ? 1e-12 * p.c.cwiseAbs().maxCoeff() : 0;
  for (Eigen::Index e = 0; e < p.n_arcs(); ++e) {
    p.c[e] += s[p.f[e]] - s[p.g[e]];
    if (std::abs(p.c[e]) < noise) p.c[e] = 0;
  }
  return s;
}

/// The flow problem in integers. Arc e of the problem is arc e of the network; then come the arcs
/// of bounds, `bound_arc` naming the problem's arc and `bound_sign` +1 for hi, -1 for lo.
struct Scaled {
  FlowNetwork network;
  std::vector<Eigen::Index> bound_arc;
  std::vector<int> bound_sign;
  double flow_unit = 1;  // value of one integer step of flow
};

double power_of_two_above(double x) { return std::ldexp(1.0, std::ilogb(x) + 1); }

Scaled scale(const L1Integration& p) {
  double largest_cost = p.c.size() ? p.c.cwiseAbs().maxCoeff() : 0;
  for (Eigen::Index e = 0; e < p.lo.size(); ++e) {
    if (std::isfinite(p.hi[e])) largest_cost = std::max(largest_cost, p.hi[e] - p.c[e]);
    if (std::isfinite(p.lo[e])) largest_cost = std::max(largest_cost, p.c[e] - p.lo[e]);
  }
  const double largest_flow = p.w.size() ? p.w.maxCoeff() : 0;
  // The artificial cost is about cost x nodes and potentials may be twice that.
  const int bits = std::min(36, 58 - std::ilogb(static_cast<double>(p.n) + 2));
  Scaled out;
  const double cost_unit =
      largest_cost > 0 ? std::ldexp(power_of_two_above(largest_cost), -bits) : 1;
  if (largest_flow > 0) out.flow_unit = std::ldexp(power_of_two_above(largest_flow), -36);
  const auto cost = [&](double c) { return std::llround(c / cost_unit); };
  FlowNetwork& network = out.network;
  network.n_nodes = p.n;
  const auto add = [&](int tail, int head, std::int64_t lower, std::int64_t upper, double price) {
    network.tail.push_back(tail);
    network.head.push_back(head);
    network.lower.push_back(lower);
    network.upper.push_back(upper);
    network.cost.push_back(cost(price));
  };
  for (Eigen::Index e = 0; e < p.n_arcs(); ++e) {
    const auto capacity = p.w[e] > 0 ? std::max(std::llround(p.w[e] / out.flow_unit), 1LL) : 0;
    add(p.f[e], p.g[e], -capacity, capacity, -p.c[e]);
  }
  for (Eigen::Index e = 0; e < p.lo.size(); ++e)
    for (const int sign : {1, -1}) {
      const double bound = sign > 0 ? p.hi[e] : p.lo[e];
      if (!std::isfinite(bound)) continue;
      const bool up = sign > 0;
      add(up ? p.f[e] : p.g[e], up ? p.g[e] : p.f[e], 0, FlowNetwork::unlimited,
          up ? bound - p.c[e] : p.c[e] - bound);
      out.bound_arc.push_back(e);
      out.bound_sign.push_back(sign);
    }
  return out;
}

/// The simplex's start from a point inside: its flows, those near a bound at it, and a tree of the
/// arcs farthest from their bounds. Arcs outside of the tree that only approach their bounds would
/// each take a pivot.
FlowStart start_from(const InteriorPoint& point, const L1Integration& p, const Scaled& scaled) {
  FlowStart start;
  const auto add = [&](double flow, double slack, double bound) {
    start.flow.push_back(std::llround((slack < at_bound ? bound : flow) / scaled.flow_unit));
    start.key.push_back(slack);
  };
  for (Eigen::Index e = 0; e < p.n_arcs(); ++e)
    add(point.x[e], p.w[e] > 0 ? 1 - std::abs(point.x[e]) / p.w[e] : 0,
        std::copysign(p.w[e], point.x[e]));
  for (std::size_t k = 0; k < scaled.bound_arc.size(); ++k) {
    const Eigen::Index e = scaled.bound_arc[k];
    const double flow = scaled.bound_sign[k] > 0 ? point.up[e] : point.down[e];
    add(flow, p.w[e] > 0 ? std::min(1.0, flow / p.w[e]) : 0, 0);
  }
  return start;
}

/// Potentials in double: on the arcs of the optimal tree the jump is exactly 0 or at its bound.
/// Parts that the tree's arcs do not connect are 0 at their lowest nodes.
VecX tree_potentials(const L1Integration& p, const Scaled& scaled, const FlowSolution& flow) {
  const FlowNetwork& network = scaled.network;
  std::vector<int> arcs;
  for (int arc : flow.tree)
    if (arc >= p.n_arcs() || p.w[arc] > 0) arcs.push_back(arc);
  const Forest forest = spanning_forest(p.n, network.tail, network.head, arcs);
  return along_forest(p, forest, [&](int arc) {
    const Eigen::Index bound = arc - p.n_arcs();
    if (bound < 0) return std::pair(Eigen::Index{arc}, 0.0);
    const Eigen::Index e = scaled.bound_arc[bound];
    return std::pair(e, scaled.bound_sign[bound] > 0 ? p.hi[e] : p.lo[e]);
  });
}

void evaluate(const L1Integration& p, L1Solution& solution, const VecX& multiplier_hi,
              const VecX& multiplier_lo) {
  VecX out = VecX::Zero(p.n);
  double violated = 0;
  const double unit_c = p.c.size() ? std::max(p.c.cwiseAbs().maxCoeff(), 1e-300) : 1;
  for (Eigen::Index e = 0; e < p.n_arcs(); ++e) {
    const double J = p.c[e] + solution.s[p.f[e]] - solution.s[p.g[e]];
    solution.primal += p.w[e] * std::abs(J);
    solution.scale += p.w[e] * std::abs(p.c[e]);
    double flow = solution.x[e];
    solution.dual += p.c[e] * flow;
    if (p.lo.size() > 0) {
      violated = std::max({violated, J - p.hi[e], p.lo[e] - J});
      if (multiplier_hi[e] != 0) solution.dual += (p.c[e] - p.hi[e]) * multiplier_hi[e];
      if (multiplier_lo[e] != 0) solution.dual -= (p.c[e] - p.lo[e]) * multiplier_lo[e];
      flow += multiplier_hi[e] - multiplier_lo[e];
    }
    out[p.f[e]] += flow;
    out[p.g[e]] -= flow;
  }
  const double unit_w = p.w.size() ? std::max(p.w.maxCoeff(), 1e-300) : 1;
  solution.infeasibility =
      std::max(violated / unit_c, p.n > 0 ? out.cwiseAbs().maxCoeff() / unit_w : 0);
}

}  // namespace

double L1Solution::gap() const { return primal > 1e-9 * scale ? (primal - dual) / primal : 0; }

L1Solution integrate_l1(const L1Integration& problem, const L1Options& options, const Task& whole,
                        Report& report) {
  check(problem);
  Task task = whole;
  L1Integration p = problem;
  const VecX s0 = integrate_over_forest(p);
  const auto algorithm = static_cast<L1Algorithm>(options.algorithm);
  const bool interior = algorithm == L1Algorithm::interior_point ||
                        (algorithm == L1Algorithm::automatic && p.n > simplex_alone);
  L1Solution solution;
  const Scaled scaled = scale(p);
  FlowStart start;
  if (interior && p.n_arcs() > 0 && p.w.maxCoeff() > 0) {
    const InteriorPoint point = interior_point(p, near_enough, task.stage(0.7, "interior point"));
    solution.iterations = point.iterations;
    start = start_from(point, p, scaled);
  }
  const FlowSolution flow =
      network_simplex(scaled.network, start, task.stage(1, "network simplex"));
  if (flow.status != FlowSolution::Status::optimal)
    throw InputError("L1 integration: no potentials satisfy the bounds");
  solution.pivots = static_cast<double>(flow.pivots);
  solution.s = s0 + tree_potentials(p, scaled, flow);
  solution.x.resize(p.n_arcs());
  for (Eigen::Index e = 0; e < p.n_arcs(); ++e)
    solution.x[e] = scaled.flow_unit * static_cast<double>(flow.flow[e]);
  VecX hi = VecX::Zero(p.n_arcs()), lo = hi;
  for (std::size_t k = 0; k < scaled.bound_arc.size(); ++k)
    (scaled.bound_sign[k] > 0 ? hi : lo)[scaled.bound_arc[k]] =
        scaled.flow_unit * static_cast<double>(flow.flow[p.n_arcs() + index(k)]);
  evaluate(problem, solution, hi, lo);
  report.iterations.emplace_back("L1 interior point", solution.iterations);
  report.iterations.emplace_back("L1 pivots", solution.pivots);
  report.residuals.emplace_back("L1 gap", std::abs(solution.gap()));
  return solution;
}

L1Solution integrate_l1_if_bounded(L1Integration problem, const L1Options& options,
                                   const Task& task, Report& report, bool& bounded) {
  bounded = true;
  try {
    return integrate_l1(problem, options, task, report);
  } catch (const InputError&) {
    if (!problem.lo.size()) throw;
  }
  problem.lo.resize(0);
  problem.hi.resize(0);
  bounded = false;
  return integrate_l1(problem, options, task, report);
}

}  // namespace littoral
