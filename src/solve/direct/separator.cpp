#include "solve/direct/separator.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "base/index.h"
#include "base/now_and_then.h"

namespace littoral {

namespace {

constexpr double largest_part = 0.65;  // of all
constexpr int uneven = 4, share = 16;  // all in one part: a separator is 4/16 dearer
constexpr int penalty = 2;             // per unit of weight of a part beyond the largest
// Moves without gain after which a pass ends.
constexpr int least_patience = 10, most_patience = 200;

}  // namespace

void Separator::start(const Graph& graph) {
  graph_ = &graph;
  side_.assign(graph.weight.size(), 1);
  weight_ = {};
  for (int w : graph.weight) weight_[1] += w;
  limit_ = static_cast<std::int64_t>(largest_part * static_cast<double>(weight_[1]));
  members_.clear();
  moved_.assign(graph.weight.size(), 0);
  if (pull_.size() < graph.weight.size()) pull_.resize(graph.weight.size());
}

void Separator::refined(const Graph& graph, const std::vector<int>& coarse_of, const Task& task) {
  std::swap(side_, coarse_side_);
  start(graph);
  for (int v = 0; v < graph.size(); ++v) {
    stop_now_and_then(v, task);
    side_[v] = coarse_side_[coarse_of[v]];
  }
  count_sides();
}

void Separator::restore(const std::vector<signed char>& sides) {
  side_ = sides;
  count_sides();
}

void Separator::count_sides() {
  weight_ = {};
  members_.clear();
  for (int v = 0; v < graph_->size(); ++v) {
    weight_[side_[v]] += graph_->weight[v];
    if (side_[v] == 2) members_.push_back(v);
  }
}

std::int64_t Separator::cost() const {
  const std::int64_t all = weight_[0] + weight_[1] + weight_[2];
  const std::int64_t heavy = std::max(weight_[0], weight_[1]);
  return weight_[2] * (share * all + uneven * std::abs(weight_[0] - weight_[1])) +
         share * penalty * all * std::max<std::int64_t>(0, heavy - limit_);
}

/// Finds the pull on a vertex of the separator and makes it a candidate.
void Separator::add(int v) {
  int pull = 0;
  for (int e = graph_->begin[v]; e < graph_->begin[v + 1]; ++e)
    if (side_[graph_->to[e]] == 1 - to_) pull += graph_->weight[graph_->to[e]];
  pull_[v] = pull;
}

void Separator::begin_pass(int to) {
  to_ = to;
  age_ = 0;
  heap_.clear();
  moves_.clear();
  pulled_.clear();
  for (int v : members_) {
    add(v);
    offer(v);
  }
}

void Separator::offer(int v) {
  if (moved_[v]) return;
  heap_.push_back({graph_->weight[v] - pull_[v], age_++, v});
  std::push_heap(heap_.begin(), heap_.end());
}

/// The vertex of the separator that is best moved; candidates that are out of date are dropped.
bool Separator::best(Candidate& out) {
  while (!heap_.empty()) {
    out = heap_.front();
    const int v = out.vertex;
    if (side_[v] == 2 && graph_->weight[v] - pull_[v] == out.gain) return true;
    std::pop_heap(heap_.begin(), heap_.end());
    heap_.pop_back();
  }
  return false;
}

void Separator::move(int v) {
  const Graph& g = *graph_;
  const int from = 1 - to_;
  side_[v] = static_cast<signed char>(to_);
  moved_[v] = 1;
  weight_[2] -= g.weight[v];
  weight_[to_] += g.weight[v];
  for (int e = g.begin[v]; e < g.begin[v + 1]; ++e) {
    const int u = g.to[e], w = g.weight[u];
    if (side_[u] != from) continue;
    side_[u] = 2;
    weight_[from] -= w;
    weight_[2] += w;
    pulled_.push_back(u);
    members_.push_back(u);
    add(u);
    offer(u);
    for (int f = g.begin[u]; f < g.begin[u + 1]; ++f) {
      const int x = g.to[f];
      if (side_[x] != 2) continue;
      pull_[x] -= w;
      offer(x);
    }
  }
  moves_.push_back({v, int_size(pulled_)});
}

/// Takes moves back, the last first, until so many are left.
void Separator::end_pass(std::size_t moves_to_keep) {
  for (const Move& m : moves_) moved_[m.vertex] = 0;
  const int from = 1 - to_;
  while (moves_.size() > moves_to_keep) {
    const int v = moves_.back().vertex;
    moves_.pop_back();
    const std::size_t begin = moves_.empty() ? 0 : moves_.back().pulled_end;
    for (std::size_t k = begin; k < pulled_.size(); ++k) {
      const int u = pulled_[k];
      side_[u] = static_cast<signed char>(from);
      weight_[2] -= graph_->weight[u];
      weight_[from] += graph_->weight[u];
    }
    pulled_.resize(begin);
    side_[v] = 2;
    weight_[to_] -= graph_->weight[v];
    weight_[2] += graph_->weight[v];
    members_.push_back(v);
  }
  std::erase_if(members_, [&](int v) { return side_[v] != 2; });
  std::sort(members_.begin(), members_.end());
  members_.erase(std::unique(members_.begin(), members_.end()), members_.end());
}

void Separator::grow(int seed) {
  start(*graph_);
  begin_pass(0);
  std::size_t best_moves = 0;
  std::int64_t best_cost = 0;
  for (int next = 0; weight_[0] < weight_[1];) {
    Candidate c{};
    if (!best(c)) {  // the seed, and in every further component its first vertex
      if (moves_.empty()) {
        c.vertex = seed;
      } else {
        while (side_[next] != 1) ++next;
        c.vertex = next;
      }
      weight_[1] -= graph_->weight[c.vertex];
      weight_[2] += graph_->weight[c.vertex];
      pulled_.push_back(c.vertex);
    }
    move(c.vertex);
    if (best_moves == 0 || cost() < best_cost) {
      best_moves = moves_.size();
      best_cost = cost();
    }
  }
  end_pass(best_moves);
}

void Separator::improve(int most) {
  int to = weight_[1] < weight_[0];
  for (int pass = 0, idle = 0; pass < most && idle < 2; ++pass, to = 1 - to) {
    const std::int64_t before = cost();
    std::int64_t best_cost = before, best_difference = std::abs(weight_[0] - weight_[1]);
    std::size_t best_moves = 0;
    begin_pass(to);
    const std::size_t patience =
        std::min<std::size_t>(least_patience + members_.size(), most_patience);
    for (Candidate c{}; moves_.size() < best_moves + patience && best(c);) {
      if (weight_[to] + graph_->weight[c.vertex] > limit_) break;
      move(c.vertex);
      const std::int64_t now = cost(), difference = std::abs(weight_[0] - weight_[1]);
      if (now > best_cost || (now == best_cost && difference >= best_difference)) continue;
      best_cost = now;
      best_difference = difference;
      best_moves = moves_.size();
    }
    end_pass(best_moves);
    idle = best_cost < before ? 0 : idle + 1;
  }
}

}  // namespace littoral
