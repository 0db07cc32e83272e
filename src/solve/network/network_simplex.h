#pragma once
// Minimum-cost flow in integers by the primal network simplex method.

#include <cstdint>
#include <vector>

#include "base/task.h"

namespace littoral {

/// min cost . x subject to lower <= x <= upper and, at every node, flow out - flow in = supply.
struct FlowNetwork {
  static constexpr std::int64_t unlimited = std::int64_t{1} << 52;  // an upper bound never reached

  int n_nodes = 0;
  std::vector<int> tail, head;             // arcs
  std::vector<std::int64_t> lower, upper;  // arcs; finite, except for `unlimited`
  std::vector<std::int64_t> cost;          // arcs; |cost| (nodes + 1) must stay below 2^60
  std::vector<std::int64_t> supply;        // nodes; or empty: none (a circulation)

  int n_arcs() const { return tail.size(); }
};

/// Where to begin: flows (moved into their bounds) and how much an arc is wanted in the first
/// spanning tree. Either may be empty: flows as near zero as the bounds allow, tree in arc order.
struct FlowStart {
  std::vector<std::int64_t> flow;  // arcs
  std::vector<double> key;         // arcs; larger first
};

struct FlowSolution {
  enum class Status { optimal, infeasible, unbounded };
  Status status = Status::optimal;
  std::vector<std::int64_t> flow;       // arcs
  std::vector<std::int64_t> potential;  // nodes; reduced cost = cost + potential[tail] -
                                        //   potential[head] certifies optimality
  std::vector<int> tree;  // arcs of the last spanning tree; reduced costs are 0 on them
  std::int64_t pivots = 0;
};

/// An optimal flow and potentials that prove it. A start need not be basic: arcs strictly between
/// their bounds outside the tree are priced from both sides, so a feasible start with good
/// potentials needs few pivots. Strongly feasible pivots (Cunningham, "A network simplex method",
/// 1976), block search pricing. Throws InputError for ends out of range or crossed bounds.
FlowSolution network_simplex(const FlowNetwork& network, const FlowStart& start, const Task& task);

}  // namespace littoral
