#include "solve/direct/nested_dissection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "littoral/error.h"
#include "solve/direct/bisection.h"
#include "solve/direct/elimination.h"
#include "solve/direct/minimum_degree.h"

namespace littoral {
namespace {

using Edges = std::vector<std::pair<int, int>>;

SpMat matrix_of(int n, const Edges& edges) {
  std::vector<Eigen::Triplet<double>> entries;
  for (auto [a, b] : edges) entries.emplace_back(std::max(a, b), std::min(a, b), 1);
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1);
  SpMat A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

Graph graph_of_edges(int n, const Edges& edges) {
  std::vector<std::set<int>> rows(n);
  for (auto [a, b] : edges) {
    rows[a].insert(b);
    rows[b].insert(a);
  }
  Graph g;
  g.weight.assign(n, 1);
  for (const auto& row : rows) {
    g.to.insert(g.to.end(), row.begin(), row.end());
    g.begin.push_back(static_cast<int>(g.to.size()));
  }
  return g;
}

/// Nodes of an n x n grid, each joined with its up to eight neighbours.
Edges grid_edges(int n) {
  Edges edges;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (auto [di, dj] : {std::pair(0, 1), std::pair(1, 0), std::pair(1, 1), std::pair(1, -1)})
        if (i + di < n && j + dj >= 0 && j + dj < n)
          edges.emplace_back(i * n + j, (i + di) * n + j + dj);
  return edges;
}

Edges random_edges(int n, int count, unsigned seed) {
  std::mt19937 random(seed);
  Edges edges;
  while (static_cast<int>(edges.size()) < count) {
    const int a = static_cast<int>(random() % unsigned(n)),
              b = static_cast<int>(random() % unsigned(n));
    if (a != b) edges.emplace_back(a, b);
  }
  return edges;
}

Edges complete_edges(int n) {
  Edges edges;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j) edges.emplace_back(i, j);
  return edges;
}

void expect_permutation(int n, const Edges& edges) {
  Ordering order = dissection(matrix_of(n, edges), {});
  std::sort(order.begin(), order.end());
  Ordering all(n);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order, all);
}

Edges star_edges(int n) {
  Edges edges;
  for (int i = 1; i < n; ++i) edges.emplace_back(0, i);
  return edges;
}

TEST(NestedDissection, OrdersEveryUnknownOnceWhateverTheGraph) {
  for (int n : {0, 1, 2, 3, 170, 5000}) {
    expect_permutation(n, {});
    expect_permutation(n, star_edges(n));
  }
  for (int n : {2, 50, 161, 700}) expect_permutation(n, complete_edges(n));
  for (unsigned seed = 0; seed < 20; ++seed) {
    const int n = 200 + 300 * static_cast<int>(seed);
    expect_permutation(n, random_edges(n, n / 2, seed));  // many components
    expect_permutation(n, random_edges(n, 3 * n, seed));  // no small separators
    if (seed < 3) expect_permutation(n, random_edges(n, 60 * n, seed));
  }
}

TEST(NestedDissection, AStarIsEliminatedFromItsTips) {
  const SpMat A = matrix_of(5000, star_edges(5000));
  const Ordering order = dissection(A, {});
  EXPECT_GE(std::find(order.begin(), order.end(), 0) - order.begin(), 4998);
  EXPECT_LE(Elimination(A, order).flops(), 20000);
}

// Nested dissection of a square of n x n nodes: 31/4 n^2 log2 n entries and 829/84 n^3 operations
// (George 1973), here with the zeros that supernodes hold.
TEST(NestedDissection, FillOfASquareIsThatOfTheory) {
  for (int n : {63, 127, 255}) {
    const SpMat A = matrix_of(n * n, grid_edges(n));
    const Elimination E(A, dissection(A, {}));
    EXPECT_LE(double(E.values()), 1.05 * 31 / 4 * n * n * std::log2(n)) << n;
    EXPECT_LE(E.flops(), 1.45 * 829 / 84 * n * n * n) << n;
  }
}

TEST(NestedDissection, TheOrderDoesNotDependOnThreads) {
  for (const auto& [n, edges] :
       {std::pair(40000, grid_edges(200)), std::pair(30000, random_edges(30000, 40000, 1))}) {
    const SpMat A = matrix_of(n, edges);
    set_thread_count(1);
    const Ordering expected = dissection(A, {});
    for (int threads : {2, 3, 8}) {
      set_thread_count(threads);
      EXPECT_EQ(dissection(A, {}), expected) << threads;
    }
    set_thread_count(0);
  }
}

TEST(NestedDissection, StopsSoonWhenAsked) {
  const SpMat A = matrix_of(1000 * 1000, grid_edges(1000));
  for (int wait : {0, 20, 300}) {
    const CancelToken cancel;
    std::chrono::steady_clock::time_point asked;
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(wait));
      asked = std::chrono::steady_clock::now();
      cancel.cancel();
    });
    EXPECT_THROW(dissection(A, Task(cancel)), Cancelled);
    const auto stopped = std::chrono::steady_clock::now();
    other.join();
    EXPECT_LT(std::chrono::duration<double>(stopped - asked).count(), 1.0);  // on a busy machine
  }
}

TEST(NestedDissection, SeparatorsSeparate) {
  Bisection bisection;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const int n = 50 + 61 * static_cast<int>(seed);
    const Graph g = graph_of_edges(n, random_edges(n, n + 13 * static_cast<int>(seed), seed));
    const std::vector<signed char>& side = bisection.cut(g, {});
    ASSERT_EQ(static_cast<int>(side.size()), n);
    for (int v = 0; v < n; ++v)
      for (int e = g.begin[v]; e < g.begin[v + 1]; ++e)
        EXPECT_FALSE(side[v] != 2 && side[g.to[e]] == 1 - side[v]);
  }
}

TEST(NestedDissection, SeparatorsAreLight) {
  Bisection bisection;
  const auto count = [&](const Graph& g) {
    const std::vector<signed char>& side = bisection.cut(g, {});
    std::array<int, 3> n{};
    for (int s : side) ++n[s];
    return n;
  };
  const auto square = count(graph_of_edges(100 * 100, grid_edges(100)));
  EXPECT_LE(square[2], 105);
  EXPECT_LE(std::max(square[0], square[1]), 6500);

  Edges dumbbell;  // two complete graphs and one vertex between them
  for (int part : {0, 300})
    for (auto [a, b] : complete_edges(300)) dumbbell.emplace_back(part + a, part + b);
  dumbbell.emplace_back(600, 0);
  dumbbell.emplace_back(600, 300);
  EXPECT_EQ(count(graph_of_edges(601, dumbbell))[2], 1);
}

/// The same on sets.
std::vector<int> minimum_degree_on_sets(int n, const Edges& edges) {
  std::vector<std::set<int>> rows(n);
  for (auto [a, b] : edges) {
    if (a < n) rows[a].insert(b);
    if (b < n) rows[b].insert(a);
  }
  std::vector<int> order;
  std::set<int> left;
  for (int v = 0; v < n; ++v) left.insert(v);
  while (!left.empty()) {
    const int v = *std::min_element(left.begin(), left.end(), [&](int a, int b) {
      return std::pair(rows[a].size(), a) < std::pair(rows[b].size(), b);
    });
    left.erase(v);
    order.push_back(v);
    for (int u : rows[v]) {
      if (u >= n) continue;
      rows[u].insert(rows[v].begin(), rows[v].end());
      rows[u].erase(u);
      rows[u].erase(v);
    }
  }
  return order;
}

TEST(NestedDissection, MinimumDegreeOnBitsIsThatOnSets) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const int n = 1 + 5 * static_cast<int>(seed), boundary = static_cast<int>(seed * 7 % 90);
    const Edges edges = n + boundary > 1 ? random_edges(n + boundary, 2 * n, seed) : Edges{};
    MinimumDegree bits(n, boundary);
    for (auto [a, b] : edges) {
      if (a < n) bits.add_edge(a, b);
      if (b < n) bits.add_edge(b, a);
    }
    EXPECT_EQ(bits.order(), minimum_degree_on_sets(n, edges)) << n;
  }
}

}  // namespace
}  // namespace littoral
