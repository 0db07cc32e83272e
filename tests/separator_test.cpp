// Separators beside the best ones there are, and orders of unknowns that follow from others.

#include "solve/direct/separator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "solve/direct/ordering.h"

namespace littoral {
namespace {

using testing::ElementsAre;

/// A random connected graph whose vertices weigh 1 to 3: a tree and some edges more.
Graph random_graph(int n, int more, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::set<int>> rows(static_cast<std::size_t>(n));
  const auto join = [&](int a, int b) {
    if (a == b) return;
    rows[std::size_t(a)].insert(b);
    rows[std::size_t(b)].insert(a);
  };
  for (int v = 1; v < n; ++v) join(v, static_cast<int>(random() % unsigned(v)));
  for (int i = 0; i < more; ++i)
    join(static_cast<int>(random() % unsigned(n)), static_cast<int>(random() % unsigned(n)));
  Graph g;
  for (const auto& row : rows) {
    g.weight.push_back(1 + static_cast<int>(random() % 3));
    g.to.insert(g.to.end(), row.begin(), row.end());
    g.begin.push_back(static_cast<int>(g.to.size()));
  }
  return g;
}

bool separates(const Graph& g, const std::vector<signed char>& side) {
  for (std::size_t v = 0; v < side.size(); ++v)
    for (int e = g.begin[v]; e < g.begin[v + 1]; ++e)
      if (side[v] != 2 && side[std::size_t(g.to[std::size_t(e)])] == 1 - side[v]) return false;
  return true;
}

/// As the header says: its weight times that of the graph; a quarter more where one part has all,
/// and two weights for each that a part has beyond 65 %. In sixteenths.
std::int64_t cost_of(const Graph& g, const std::vector<signed char>& side) {
  std::int64_t weight[3] = {0, 0, 0};
  for (std::size_t v = 0; v < side.size(); ++v) weight[side[v]] += g.weight[v];
  const std::int64_t all = weight[0] + weight[1] + weight[2];
  const std::int64_t limit = 65 * all / 100, heavy = std::max(weight[0], weight[1]);
  return weight[2] * (16 * all + 4 * std::abs(weight[0] - weight[1])) +
         32 * all * std::max<std::int64_t>(0, heavy - limit);
}

/// The least there is, by trying all.
std::int64_t least_cost(const Graph& g) {
  std::vector<signed char> side(static_cast<std::size_t>(g.size()), 0);
  std::int64_t least = cost_of(g, side);
  for (;;) {
    std::size_t v = 0;
    while (v < side.size() && side[v] == 2) side[v++] = 0;
    if (v == side.size()) return least;
    ++side[v];
    if (separates(g, side)) least = std::min(least, cost_of(g, side));
  }
}

TEST(Separator, StartsWithAllInOnePart) {
  const Graph g = random_graph(10, 5, 1);
  Separator s;
  s.start(g);
  EXPECT_THAT(s.sides(), testing::Each(1));
  EXPECT_EQ(s.cost(), cost_of(g, s.sides()));
}

TEST(Separator, SeparatesAndKnowsItsCost) {
  Separator s;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const int n = 20 + 3 * static_cast<int>(seed);
    const Graph g = random_graph(n, n, seed);
    s.start(g);
    s.grow(static_cast<int>(seed) % n);
    EXPECT_TRUE(separates(g, s.sides()));
    const std::int64_t grown = s.cost();
    EXPECT_EQ(grown, cost_of(g, s.sides()));
    s.improve(10);
    EXPECT_TRUE(separates(g, s.sides()));
    EXPECT_EQ(s.cost(), cost_of(g, s.sides()));
    EXPECT_LE(s.cost(), grown);
    const std::int64_t improved = s.cost();
    const std::vector<signed char> kept = s.sides();
    s.grow((static_cast<int>(seed) + 1) % n);
    s.restore(kept);
    EXPECT_EQ(s.cost(), improved);
    EXPECT_EQ(s.sides(), kept);
  }
}

TEST(Separator, OfAPathFromAnEndIsItsMiddle) {
  Graph g;
  for (int v = 0; v < 31; ++v) {
    g.weight.push_back(1);
    if (v > 0) g.to.push_back(v - 1);
    if (v < 30) g.to.push_back(v + 1);
    g.begin.push_back(static_cast<int>(g.to.size()));
  }
  Separator s;
  for (const int seed : {0, 30}) {
    s.start(g);
    s.grow(seed);
    s.improve(20);
    EXPECT_EQ(s.sides()[15], 2) << seed;
    EXPECT_EQ(std::count(s.sides().begin(), s.sides().end(), 2), 1) << seed;
  }
}

TEST(Separator, OfSmallGraphsIsNearlyTheBest) {
  Separator s;
  double sum = 0, best = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Graph g = random_graph(9, 6, seed);
    std::int64_t least = -1;
    for (int start = 0; start < 9; ++start) {
      s.start(g);
      s.grow(start);
      s.improve(10);
      least = least < 0 ? s.cost() : std::min(least, s.cost());
    }
    EXPECT_GE(least, least_cost(g));
    sum += static_cast<double>(least);
    best += static_cast<double>(least_cost(g));
  }
  EXPECT_LE(sum, 1.02 * best);
}

TEST(Separator, GoesToAFinerGraphAsItIs) {
  const Graph coarse = random_graph(12, 8, 5);
  Separator s;
  s.start(coarse);
  s.grow(3);
  const std::vector<signed char> before = s.sides();
  const Graph fine = random_graph(24, 10, 6);
  std::vector<int> coarse_of;
  for (int v = 0; v < 24; ++v) coarse_of.push_back(v * 5 % 12);
  s.refined(fine, coarse_of, {});
  for (std::size_t v = 0; v < 24; ++v) EXPECT_EQ(s.sides()[v], before[std::size_t(coarse_of[v])]);
  EXPECT_EQ(s.cost(), cost_of(fine, s.sides()));
}

TEST(Ordering, UnknownsBetweenNodesGoWithTheFirstOfThem) {
  Rows<int, 2> nodes(5, 2);
  nodes << 0, 1, 1, 2, 2, 3, 3, 0, 0, 2;
  EXPECT_THAT(between_nodes({2, 0, 3, 1}, nodes), ElementsAre(1, 2, 4, 0, 3));
  EXPECT_THAT(between_nodes({0, 1, 2, 3}, nodes), ElementsAre(0, 3, 4, 1, 2));
}

TEST(Ordering, BlocksStayTogether) {
  EXPECT_THAT(in_blocks({2, 0, 1}, 2), ElementsAre(4, 5, 0, 1, 2, 3));
  EXPECT_THAT(in_blocks({1, 0}, 3), ElementsAre(3, 4, 5, 0, 1, 2));
  EXPECT_THAT(in_blocks({1, 0}, 1), ElementsAre(1, 0));
}

}  // namespace
}  // namespace littoral
