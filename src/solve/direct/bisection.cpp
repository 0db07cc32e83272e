#include "solve/direct/bisection.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/index.h"
#include "base/now_and_then.h"

namespace littoral {

namespace {

// Vertices of the graph that is cut by growing, within these limits 1/8 of all.
constexpr int smallest_graph = 40, largest_graph = 100;
constexpr double least_reduction = 0.95;  // by a contraction
constexpr int passes_of_a_part = 4, passes_of_a_level = 8;

int seeds_for(int n) { return n > 20000 ? 8 : n > 2000 ? 4 : 2; }

int first_unmatched(const Graph& g, int v, const std::vector<int>& match) {
  for (int e = g.begin[v]; e < g.begin[v + 1]; ++e)
    if (match[g.to[e]] < 0) return g.to[e];
  return -1;
}

/// The other end of the edge that is heaviest beside that end, among those not matched yet and not
/// too heavy; -1: there is none.
int heaviest_unmatched(const Graph& g, int v, const std::vector<int>& match, int most) {
  int best = -1;
  std::int64_t best_edge = 0, best_weight = 1;
  const int room = most - g.weight[v];
  for (int e = g.begin[v]; e < g.begin[v + 1]; ++e) {
    const int u = g.to[e];
    if (match[u] >= 0 || g.weight[u] > room) continue;
    if (g.edge_weight[e] * best_weight <= best_edge * g.weight[u]) continue;
    best = u;
    best_edge = g.edge_weight[e];
    best_weight = g.weight[u];
  }
  return best;
}

/// The vertex that a breadth-first search reaches last.
int farthest(const Graph& g, int from) {
  std::vector<int> queue{from};
  std::vector<char> seen(g.weight.size(), 0);
  seen[from] = 1;
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (int e = g.begin[queue[k]]; e < g.begin[queue[k] + 1]; ++e)
      if (!std::exchange(seen[g.to[e]], 1)) queue.push_back(g.to[e]);
  return queue.back();
}

}  // namespace

void Bisection::match(const Graph& g, int most, const Task& task) {
  const int n = g.size();
  match_.assign(g.weight.size(), -1);
  int alone = 0;
  for (int v = 0; v < n; ++v) {
    stop_now_and_then(v, task);
    if (match_[v] >= 0) continue;
    const int u = g.edge_weight.empty() ? first_unmatched(g, v, match_)
                                        : heaviest_unmatched(g, v, match_, most);
    if (u < 0) {
      ++alone;
    } else {
      match_[v] = u;
      match_[u] = v;
    }
  }
  if (alone > n / 10) match_by_neighbour(g, most);
  for (int v = 0; v < n; ++v)
    if (match_[v] < 0) match_[v] = v;
}

/// Joins vertices that are left with each other where they share a neighbour, as the tips of stars
/// do, or have none.
void Bisection::match_by_neighbour(const Graph& g, int most) {
  std::vector<int> waiting(g.weight.size(), -1);
  int isolated = -1;
  for (int v = 0; v < g.size(); ++v) {
    if (match_[v] >= 0) continue;
    int& other = g.begin[v] == g.begin[v + 1] ? isolated : waiting[g.to[g.begin[v]]];
    if (other < 0 || g.weight[other] + g.weight[v] > most) {
      other = v;
    } else {
      match_[v] = other;
      match_[other] = v;
      other = -1;
    }
  }
}

void Bisection::contract(const Graph& g, Level& level, const Task& task) {
  const int n = g.size();
  level.coarse_of.resize(g.weight.size());
  int n_coarse = 0;
  for (int v = 0; v < n; ++v)
    level.coarse_of[v] = match_[v] < v ? level.coarse_of[match_[v]] : n_coarse++;
  Graph& c = level.graph;
  c.begin.assign(1, 0);
  c.weight.clear();
  if (c.to.size() < std::size_t(g.begin[n])) {
    c.to.resize(g.begin[n]);
    c.edge_weight.resize(g.begin[n]);
  }
  c.weight.reserve(n_coarse);
  c.begin.reserve(n_coarse + 1);
  place_.assign(n_coarse, -1);
  const int* const edge_weight = g.edge_weight.empty() ? nullptr : g.edge_weight.data();
  int end = 0;
  for (int v = 0; v < n; ++v) {
    stop_now_and_then(v, task);
    if (match_[v] < v) continue;
    const int self = c.size(), row = end;
    const auto add_row = [&](int from) {
      for (int e = g.begin[from]; e < g.begin[from + 1]; ++e) {
        const int to = level.coarse_of[g.to[e]], w = edge_weight ? edge_weight[e] : 1;
        if (to == self) continue;
        int& at = place_[to];
        if (at >= row) {
          c.edge_weight[at] += w;
          continue;
        }
        at = end;
        c.to[end] = to;
        c.edge_weight[end++] = w;
      }
    };
    add_row(v);
    if (match_[v] != v) add_row(match_[v]);
    c.weight.push_back(match_[v] == v ? g.weight[v] : g.weight[v] + g.weight[match_[v]]);
    c.begin.push_back(end);
  }
}

void Bisection::cut_by_growing(const Graph& g, int seeds) {
  separator_.start(g);
  std::vector<signed char> best;
  std::int64_t best_cost = 0;
  int seed = farthest(g, 0);
  for (int k = 0; k < seeds; ++k) {
    separator_.grow(seed);
    separator_.improve(passes_of_a_part);
    if (best.empty() || separator_.cost() < best_cost) {
      best_cost = separator_.cost();
      best = separator_.sides();
    }
    seed = k == 0 ? farthest(g, seed) : static_cast<int>(std::int64_t{k} * g.size() / seeds);
  }
  separator_.restore(best);
}

const std::vector<signed char>& Bisection::cut(const Graph& graph, const Task& task) {
  const int smallest = std::clamp(graph.size() / 8, smallest_graph, largest_graph);
  std::int64_t all = 0;
  for (int w : graph.weight) all += w;
  const int most = static_cast<int>(std::max<std::int64_t>(2, all * 3 / 2 / smallest));
  std::vector<const Graph*> graphs{&graph};
  while (graphs.back()->size() > smallest) {
    const Graph& g = *graphs.back();
    if (levels_.size() < graphs.size()) levels_.emplace_back();
    Level& next = levels_[graphs.size() - 1];
    match(g, most, task);
    contract(g, next, task);
    if (next.graph.size() > least_reduction * g.size()) break;
    graphs.push_back(&next.graph);
  }
  cut_by_growing(*graphs.back(), seeds_for(graph.size()));
  while (graphs.size() > 1) {
    graphs.pop_back();
    separator_.refined(*graphs.back(), levels_[graphs.size() - 1].coarse_of, task);
    separator_.improve(passes_of_a_level);
  }
  return separator_.sides();
}

}  // namespace littoral
