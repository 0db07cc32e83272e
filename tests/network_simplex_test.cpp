// Minimum-cost flows against an independent implementation, certificates and bad input.

#include "solve/network/network_simplex.h"

#include <gtest/gtest.h>
#include <lemon/network_simplex.h>
#include <lemon/static_graph.h>

#include <random>

#include "littoral/error.h"
#include "solve/network/spanning_tree.h"

namespace littoral {
namespace {

using Int = std::int64_t;

FlowNetwork random_network(std::mt19937& random, int n, int m, bool with_supply) {
  const auto between = [&](Int a, Int b) {
    return std::uniform_int_distribution<Int>(a, b)(random);
  };
  FlowNetwork network;
  network.n_nodes = n;
  for (int e = 0; e < m; ++e) {
    network.tail.push_back(static_cast<int>(between(0, n - 1)));
    network.head.push_back(static_cast<int>(between(0, n - 1)));
    const Int lower = between(-20, 5);
    network.lower.push_back(lower);
    network.upper.push_back(lower + between(0, 30));
    network.cost.push_back(between(-50, 50));
  }
  network.supply.assign(n, 0);
  for (int k = 0; with_supply && k < n; ++k) {
    const Int amount = between(0, 6);
    network.supply[between(0, n - 1)] += amount;
    network.supply[between(0, n - 1)] -= amount;
  }
  return network;
}

Int value(const FlowNetwork& network, const std::vector<Int>& flow) {
  Int sum = 0;
  for (int e = 0; e < network.n_arcs(); ++e) sum += network.cost[e] * flow[e];
  return sum;
}

/// Feasible, and no reduced cost says that a flow could be changed for the better.
void expect_certified(const FlowNetwork& network, const FlowSolution& solution) {
  std::vector<Int> out(network.n_nodes, 0);
  for (int e = 0; e < network.n_arcs(); ++e) {
    const Int x = solution.flow[e];
    ASSERT_GE(x, network.lower[e]);
    ASSERT_LE(x, network.upper[e]);
    out[network.tail[e]] += x;
    out[network.head[e]] -= x;
    const Int rc =
        network.cost[e] + solution.potential[network.tail[e]] - solution.potential[network.head[e]];
    ASSERT_TRUE(x == network.upper[e] || rc >= 0) << "arc " << e;
    ASSERT_TRUE(x == network.lower[e] || rc <= 0) << "arc " << e;
  }
  for (int u = 0; u < network.n_nodes; ++u)
    ASSERT_EQ(out[u], network.supply.empty() ? 0 : network.supply[u]);
}

/// The optimum by LEMON; false if it finds the network infeasible.
bool lemon_optimum(const FlowNetwork& network, Int& best) {
  // Its static graph wants arcs sorted by tail.
  std::vector<int> order(network.n_arcs());
  for (int e = 0; e < network.n_arcs(); ++e) order[e] = e;
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return network.tail[a] < network.tail[b]; });
  std::vector<std::pair<int, int>> arcs;
  for (int e : order) arcs.emplace_back(network.tail[e], network.head[e]);
  lemon::StaticDigraph graph;
  graph.build(network.n_nodes, arcs.begin(), arcs.end());
  lemon::StaticDigraph::ArcMap<Int> lower(graph), upper(graph), cost(graph);
  lemon::StaticDigraph::NodeMap<Int> supply(graph);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto arc = graph.arc(static_cast<int>(k));
    lower[arc] = network.lower[order[k]];
    upper[arc] = network.upper[order[k]];
    cost[arc] = network.cost[order[k]];
  }
  for (int u = 0; u < network.n_nodes; ++u) supply[graph.node(u)] = network.supply[u];
  lemon::NetworkSimplex<lemon::StaticDigraph, Int, Int> simplex(graph);
  simplex.lowerMap(lower).upperMap(upper).costMap(cost).supplyMap(supply);
  if (simplex.run() != simplex.OPTIMAL) return false;
  best = simplex.totalCost<Int>();
  return true;
}

TEST(NetworkSimplex, FindsTheOptimaThatLemonFinds) {
  std::mt19937 random(7);
  int feasible = 0, infeasible = 0;
  for (int k = 0; k < 300; ++k) {
    const int n = 2 + k % 40, m = n * (1 + k % 7);
    const FlowNetwork network = random_network(random, n, m, k % 2 == 0);
    const FlowSolution solution = network_simplex(network, {}, {});
    Int best = 0;
    if (!lemon_optimum(network, best)) {
      EXPECT_EQ(solution.status, FlowSolution::Status::infeasible) << "network " << k;
      ++infeasible;
      continue;
    }
    ++feasible;
    ASSERT_EQ(solution.status, FlowSolution::Status::optimal) << "network " << k;
    EXPECT_EQ(value(network, solution.flow), best) << "network " << k;
    expect_certified(network, solution);
  }
  EXPECT_GT(feasible, 50);
  EXPECT_GT(infeasible, 20);
}

TEST(NetworkSimplex, AnyStartLeadsToTheOptimum) {
  std::mt19937 random(11);
  for (int k = 0; k < 60; ++k) {
    FlowNetwork network = random_network(random, 20, 90, false);
    for (auto& lower : network.lower) lower = std::min<Int>(lower, 0);
    for (auto& upper : network.upper) upper = std::max<Int>(upper, 0);
    const FlowSolution plain = network_simplex(network, {}, {});
    FlowStart start;
    for (int e = 0; e < network.n_arcs(); ++e) {
      start.flow.push_back(std::uniform_int_distribution<Int>(-40, 40)(random));
      start.key.push_back(std::uniform_real_distribution<double>(0, 1)(random));
    }
    const FlowSolution other = network_simplex(network, start, {});
    ASSERT_EQ(other.status, FlowSolution::Status::optimal);
    EXPECT_EQ(value(network, plain.flow), value(network, other.flow));
    expect_certified(network, other);
    // From the optimum nothing is left to do but to make the flow basic.
    const FlowSolution again = network_simplex(network, {plain.flow, {}}, {});
    EXPECT_EQ(value(network, plain.flow), value(network, again.flow));
  }
}

TEST(NetworkSimplex, TellsUnboundedFromOptimal) {
  FlowNetwork network;
  network.n_nodes = 3;
  network.tail = {0, 1, 2};
  network.head = {1, 2, 0};
  network.lower = {0, 0, 0};
  network.upper = std::vector<Int>(3, FlowNetwork::unlimited);
  network.cost = {1, 2, -4};
  EXPECT_EQ(network_simplex(network, {}, {}).status, FlowSolution::Status::unbounded);
  network.cost[2] = -3;
  EXPECT_EQ(network_simplex(network, {}, {}).status, FlowSolution::Status::optimal);
}

TEST(NetworkSimplex, RefusesNetworksThatAreNone) {
  FlowNetwork network;
  network.n_nodes = 2;
  network.tail = {0};
  network.head = {2};
  network.lower = {0};
  network.upper = {1};
  network.cost = {1};
  EXPECT_THROW(network_simplex(network, {}, {}), InputError);
  network.head = {1};
  network.lower = {2};
  EXPECT_THROW(network_simplex(network, {}, {}), InputError);
  network.lower = {0};
  network.supply = {1, 0};
  EXPECT_THROW(network_simplex(network, {}, {}), InputError);
}

TEST(SpanningForest, TakesArcsInTheOrderGiven) {
  const std::vector<int> tail{0, 1, 0, 3}, head{1, 2, 2, 4};
  const Forest forest = spanning_forest(5, tail, head, {2, 1, 0, 3});
  EXPECT_EQ(forest.parent_arc, (std::vector<int>{-1, 1, 2, -1, 3}));
  EXPECT_EQ(forest.order.size(), 5u);
}

TEST(RootedTree, ExchangesArcsAndMovesTheSmallerPart) {
  RootedTree tree(6);  // root 5
  const std::vector<int> parents{5, 0, 1, 1, 5};
  tree.build(
      {0, 1, 2, 3, 4}, [&](int u) { return parents[u]; }, [](int u) { return 10 + u; });
  EXPECT_EQ(tree.join(2, 3), 1);
  int moved = 0;
  const auto count = [&](int, int) { ++moved; };
  EXPECT_EQ(tree.exchange(1, 3, 4, 20, count), 3);  // cuts 0-1; {1, 2, 3} hangs on 4 by 3
  EXPECT_EQ(tree.parent(3), 4);
  EXPECT_EQ(tree.arc(3), 20);
  EXPECT_EQ(tree.parent(1), 3);
  EXPECT_EQ(tree.arc(1), 13);
  EXPECT_EQ(tree.parent(2), 1);
  EXPECT_EQ(tree.join(2, 0), 5);
  std::vector<int> seen;
  tree.for_subtree(4, [&](int u) { seen.push_back(u); });
  EXPECT_EQ(seen, (std::vector<int>{4, 3, 1, 2}));
  EXPECT_EQ(tree.exchange(4, 2, 0, 30, count), 0);  // cuts 5-4: the rest, {0, 5}, moves below 2
  EXPECT_EQ(tree.parent(0), 2);
  EXPECT_EQ(tree.parent(5), 0);
  EXPECT_EQ(tree.arc(5), 10);
  EXPECT_EQ(tree.parent(4), -1);
  EXPECT_EQ(tree.join(5, 1), 1);
  EXPECT_EQ(moved, 5);
}

}  // namespace
}  // namespace littoral
