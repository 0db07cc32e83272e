#include "solve/network/network_simplex.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string>

#include "base/index.h"
#include "littoral/error.h"
#include "solve/network/spanning_tree.h"

namespace littoral {

namespace {

using Int = std::int64_t;

/// One run of the method: the network's arcs, then one artificial arc from or to the root for every
/// node that needs it, at a cost no real path can have.
class Simplex {
 public:
  Simplex(const FlowNetwork& network, const FlowStart& start)
      : n_(network.n_nodes), n_real_(network.n_arcs()), root_(network.n_nodes), tree_(n_ + 1) {
    Int dearest = 1;
    for (Int c : network.cost) dearest = std::max(dearest, std::abs(c));
    artificial_cost_ = (dearest + 1) * (Int{n_} + 1);
    arcs_.resize(n_real_);
    for (int e = 0; e < n_real_; ++e) {
      Arc& arc = arcs_[e];
      arc = {network.cost[e],  network.tail[e],  network.head[e],
             network.lower[e], network.upper[e], 0,
             State::between};
      const Int wanted = start.flow.empty() ? 0 : start.flow[e];
      arc.x = std::clamp(wanted, arc.lower, arc.upper);
    }
    pi_.assign(n_ + 1, 0);
    first_tree(network, start);
  }

  FlowSolution run(const Task& task) {
    FlowSolution solution;
    while (const int in = entering()) {
      if (solution.pivots % 256 == 0) task.checkpoint();
      ++solution.pivots;
      if (!pivot(in - 1)) {
        solution.status = FlowSolution::Status::unbounded;
        break;
      }
    }
    for (std::size_t e = n_real_; e < arcs_.size(); ++e)
      if (arcs_[e].x != 0 && solution.status == FlowSolution::Status::optimal)
        solution.status = FlowSolution::Status::infeasible;
    solution.flow.resize(n_real_);
    for (int e = 0; e < n_real_; ++e) {
      solution.flow[e] = arcs_[e].x;
      if (arcs_[e].state == State::tree) solution.tree.push_back(e);
    }
    solution.potential.assign(pi_.begin(), pi_.end() - 1);
    return solution;
  }

 private:
  enum class State : signed char { at_upper = -1, tree = 0, at_lower = 1, between = 2, fixed = 3 };
  struct Arc {
    Int cost;
    int tail, head;
    Int lower, upper, x;
    State state;
  };

  /// The state of an arc that is not in the tree.
  static State resting(const Arc& arc) {
    if (arc.lower == arc.upper) return State::fixed;
    if (arc.x == arc.lower) return State::at_lower;
    return arc.x == arc.upper ? State::at_upper : State::between;
  }

  /// A spanning forest of the arcs by descending key; its trees and what its arcs cannot carry hang
  /// on the root by artificial arcs.
  void first_tree(const FlowNetwork& network, const FlowStart& start) {
    std::vector<int> order(n_real_);
    std::iota(order.begin(), order.end(), 0);
    if (!start.key.empty())
      std::stable_sort(order.begin(), order.end(),
                       [&](int a, int b) { return start.key[a] > start.key[b]; });
    const Forest forest = spanning_forest(n_, network.tail, network.head, order);
    std::vector<Int> excess(n_, 0);  // what a node still has to send to its parent
    if (!network.supply.empty()) excess = network.supply;
    std::vector<char> in_tree(n_real_, 0);
    for (int e : forest.parent_arc)
      if (e >= 0) in_tree[e] = 1;
    for (int e = 0; e < n_real_; ++e) {
      Arc& arc = arcs_[e];
      if (in_tree[e]) continue;
      arc.state = resting(arc);
      excess[arc.tail] -= arc.x;
      excess[arc.head] += arc.x;
    }
    // Children before parents: an arc takes what it can; the rest goes over the root.
    std::vector<int> parent_arc = forest.parent_arc;
    for (auto it = forest.order.rbegin(); it != forest.order.rend(); ++it) {
      const int u = *it, e = parent_arc[u];
      if (e < 0) continue;
      Arc& arc = arcs_[e];
      const bool up = arc.tail == u;
      const int parent = up ? arc.head : arc.tail;
      arc.x = std::clamp(up ? excess[u] : -excess[u], arc.lower, arc.upper);
      const Int sent = up ? arc.x : -arc.x;
      excess[u] -= sent;
      excess[parent] += sent;
      if (excess[u] == 0) {
        arc.state = State::tree;
      } else {
        arc.state = resting(arc);
        parent_arc[u] = -1;
      }
    }
    for (int u : forest.order) {  // parents before children
      int& e = parent_arc[u];
      if (e < 0) e = hang_on_root(u, excess[u]);
      const Arc& arc = arcs_[e];
      pi_[u] = arc.tail == u ? pi_[arc.head] - arc.cost : pi_[arc.tail] + arc.cost;
    }
    tree_.build(
        forest.order,
        [&](int u) {
          const Arc& arc = arcs_[parent_arc[u]];
          return arc.tail == u ? arc.head : arc.tail;
        },
        [&](int u) { return parent_arc[u]; });
    block_ = std::max(16, static_cast<int>(std::sqrt(static_cast<double>(arcs_.size()))));
  }

  int hang_on_root(int u, Int sends) {
    Arc arc{artificial_cost_, u,          root_, 0, 2 * FlowNetwork::unlimited,
            std::abs(sends),  State::tree};
    if (sends < 0) std::swap(arc.tail, arc.head);
    arcs_.push_back(arc);
    return int_size(arcs_) - 1;
  }

  Int reduced_cost(const Arc& arc) const { return arc.cost + pi_[arc.tail] - pi_[arc.head]; }

  /// 1 + the arc with the largest violation in the next block that has one; 0 at the optimum.
  int entering() {
    const int m = arcs_.size();
    int best = -1, left = block_;
    Int largest = 0;
    for (int seen = 0; seen < m; ++seen) {
      const Arc& arc = arcs_[next_];
      const Int rc = reduced_cost(arc);
      Int violation = 0;
      switch (arc.state) {
        case State::at_lower:
          violation = -rc;
          break;
        case State::at_upper:
          violation = rc;
          break;
        case State::between:
          violation = std::abs(rc);
          break;
        default:
          break;
      }
      if (violation > largest) {
        largest = violation;
        best = next_;
      }
      if (++next_ == m) next_ = 0;
      if (--left == 0) {
        if (best >= 0) return best + 1;
        left = block_;
      }
    }
    return best + 1;
  }

  /// What u's tree arc can still carry away from u (towards the root) or down to it.
  Int room(int u, bool upward) const {
    const Arc& arc = arcs_[tree_.arc(u)];
    return (arc.tail == u) == upward ? arc.upper - arc.x : arc.x - arc.lower;
  }
  void push(int u, bool upward, Int amount) {
    Arc& arc = arcs_[tree_.arc(u)];
    arc.x += (arc.tail == u) == upward ? amount : -amount;
  }

  /// Sends flow round the cycle that `in` closes until an arc is full; false if none ever is.
  bool pivot(int in) {
    const bool forward = reduced_cost(arcs_[in]) < 0;
    const int first = forward ? arcs_[in].tail : arcs_[in].head;
    const int second = forward ? arcs_[in].head : arcs_[in].tail;
    const int join = tree_.join(first, second);
    Int amount = forward ? arcs_[in].upper - arcs_[in].x : arcs_[in].x - arcs_[in].lower;
    int out = -1;
    bool out_on_first = false;
    // The last blocking arc in the direction of the cycle, seen from the join, leaves the tree.
    for (int u = first; u != join; u = tree_.parent(u))
      if (const Int r = room(u, false); r < amount) amount = r, out = u, out_on_first = true;
    for (int u = second; u != join; u = tree_.parent(u))
      if (const Int r = room(u, true); r <= amount) amount = r, out = u, out_on_first = false;
    if (amount >= FlowNetwork::unlimited / 2) return false;
    if (amount > 0) {
      arcs_[in].x += forward ? amount : -amount;
      for (int u = first; u != join; u = tree_.parent(u)) push(u, false, amount);
      for (int u = second; u != join; u = tree_.parent(u)) push(u, true, amount);
    }
    if (out < 0) {
      arcs_[in].state = resting(arcs_[in]);
      return true;
    }
    Arc& leaving = arcs_[tree_.arc(out)];
    const Int rc = reduced_cost(arcs_[in]);
    leaving.state = resting(leaving);
    arcs_[in].state = State::tree;
    const int below = out_on_first ? first : second, above = out_on_first ? second : first;
    const Int tail_shift = -rc, head_shift = rc;
    tree_.exchange(out, below, above, in, [&, tail = arcs_[in].tail](int u, int top) {
      pi_[u] += top == tail ? tail_shift : head_shift;
    });
    return true;
  }

  int n_, n_real_, root_;
  Int artificial_cost_ = 0;
  std::vector<Arc> arcs_;
  std::vector<Int> pi_;
  RootedTree tree_;
  int block_ = 16, next_ = 0;
};

void check(const FlowNetwork& network, const FlowStart& start) {
  const std::size_t m = network.tail.size(), n = network.n_nodes;
  if (network.head.size() != m || network.lower.size() != m || network.upper.size() != m ||
      network.cost.size() != m || (!network.supply.empty() && network.supply.size() != n) ||
      (!start.flow.empty() && start.flow.size() != m) ||
      (!start.key.empty() && start.key.size() != m))
    throw InputError("flow network: the lists have different lengths", "sizes-differ");
  for (std::size_t e = 0; e < m; ++e) {
    const auto inside = [&](int v) { return v >= 0 && v < network.n_nodes; };
    if (!inside(network.tail[e]) || !inside(network.head[e]))
      throw InputError("flow network: arc " + std::to_string(e) + " ends at no node");
    if (network.lower[e] > network.upper[e])
      throw InputError("flow network: arc " + std::to_string(e) + " has crossed bounds");
  }
  Int total = 0;
  for (Int s : network.supply) total += s;
  if (total != 0) throw InputError("flow network: the supplies do not sum to zero");
}

}  // namespace

FlowSolution network_simplex(const FlowNetwork& network, const FlowStart& start, const Task& task) {
  check(network, start);
  return Simplex(network, start).run(task);
}

}  // namespace littoral
