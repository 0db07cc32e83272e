#include "solve/direct/nested_dissection.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "base/index.h"
#include "base/now_and_then.h"
#include "base/parallel_forest.h"
#include "solve/direct/bisection.h"
#include "solve/direct/minimum_degree.h"

namespace littoral {

namespace {

constexpr int largest_leaf = 240;        // vertices that are ordered by minimum degree
constexpr int worth_a_task = 4000;       // vertices of parts that are cut side by side
constexpr int most_generations = 6;      // of these
constexpr double least_progress = 0.95;  // of a part that is worth cutting on

/// A part of the whole graph, whose vertices have the places from `place` on.
struct Part {
  Graph graph;                // left out of leaves
  std::vector<int> vertices;  // in the whole graph
  int place = 0;
};

class Dissection {
 public:
  Dissection(const Graph& whole, const Task& task)
      : whole_(whole),
        task_(task),
        order_(whole.weight.size()),
        position_(whole.weight.size(), -1) {}

  std::vector<int> order() {
    int generations = 0;
    while (generations < most_generations && whole_.size() >> generations > worth_a_task)
      ++generations;
    // A complete binary tree, numbered like a heap, but backwards: parents have larger numbers.
    const int n = (2 << generations) - 1, root = n - 1;
    std::vector<Part> parts(n);
    std::vector<int> parent(n, -1);
    for (int i = 0; i < root; ++i) parent[i] = root - (root - i - 1) / 2;
    parts[root].vertices.resize(order_.size());
    std::iota(parts[root].vertices.begin(), parts[root].vertices.end(), 0);
    parallel_forest(parent, Walk::from_roots, [&](int i) {
      Bisection bisection;
      const Part part = std::move(parts[i]);
      const int child = root - 2 * (root - i) - 1;
      if (child < 0) {
        dissect(part, i == root ? whole_ : part.graph, bisection);
      } else {
        auto halves = cut(part, i == root ? whole_ : part.graph, bisection);
        parts[child] = std::move(halves[0]);
        parts[child - 1] = std::move(halves[1]);
      }
    });
    return std::move(order_);
  }

 private:
  void put(int vertex, int place) {
    order_[place] = vertex;
    position_[vertex] = place;
  }

  void dissect(const Part& part, const Graph& graph, Bisection& bisection) {
    std::vector<Part> left;
    const auto cut_on = [&](const Part& p, const Graph& g) {
      for (Part& half : cut(p, g, bisection))
        if (!half.vertices.empty()) left.push_back(std::move(half));
    };
    cut_on(part, graph);
    while (!left.empty()) {
      const Part next = std::move(left.back());
      left.pop_back();
      cut_on(next, next.graph);
    }
  }

  /// Orders all of a small part, of a larger one the separator; what is left of it.
  std::array<Part, 2> cut(const Part& part, const Graph& graph, Bisection& bisection) {
    stop_if_cancelled(task_);
    const int n = int_size(part.vertices);
    if (n <= largest_leaf) {
      order_leaf(part);
      return {};
    }
    const std::vector<signed char>& side = bisection.cut(graph, task_);
    int count[3] = {0, 0, 0};
    for (int s : side) ++count[s];
    if (std::max(count[0], count[1]) > least_progress * n) {
      order_by_degree(part, graph);
      return {};
    }
    std::array<Part, 2> halves;
    for (int s : {0, 1}) {
      halves[s].vertices.reserve(count[s]);
      halves[s].place = part.place + s * count[0];
    }
    std::vector<int> number(part.vertices.size());
    std::array<std::size_t, 2> ends = {0, 0};  // of edges, those to the separator among them
    for (int v = 0, place = part.place + count[0] + count[1]; v < n; ++v) {
      const int s = side[v];
      if (s == 2) {
        put(part.vertices[v], place++);
      } else {
        number[v] = int_size(halves[s].vertices);
        halves[s].vertices.push_back(part.vertices[v]);
        ends[s] += graph.begin[v + 1] - graph.begin[v];
      }
    }
    for (int s : {0, 1})
      if (count[s] > largest_leaf)
        halves[s].graph = subgraph(graph, side, s, number, count[s], ends[s]);
    return halves;
  }

  /// Of the n vertices on side s, `ends` edges going out from these.
  Graph subgraph(const Graph& graph, const std::vector<signed char>& side, int s,
                 const std::vector<int>& number, int n, std::size_t ends) {
    Graph out;
    out.weight.assign(n, 1);
    out.begin.resize(out.weight.size() + 1);
    out.to.resize(ends);
    int k = 0, to = 0;
    for (int v = 0; v < graph.size(); ++v) {
      stop_now_and_then(v, task_);
      if (side[v] != s) continue;
      for (int e = graph.begin[v]; e < graph.begin[v + 1]; ++e) {
        const int u = graph.to[e];
        out.to[to] = number[u];  // kept if it counts
        to += side[u] == s;
      }
      out.begin[++k] = to;
    }
    out.to.resize(to);
    return out;
  }

  /// Of graphs that no separator cuts: almost everything is joined with everything.
  void order_by_degree(const Part& part, const Graph& graph) {
    std::vector<int> sorted(part.vertices.size());
    std::iota(sorted.begin(), sorted.end(), 0);
    std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) {
      return graph.begin[a + 1] - graph.begin[a] < graph.begin[b + 1] - graph.begin[b];
    });
    for (int k = 0; k < int_size(sorted); ++k) put(part.vertices[sorted[k]], part.place + k);
  }

  /// The boundary of a leaf are the neighbours that have later places.
  void order_leaf(const Part& part) {
    const int n = int_size(part.vertices), end = part.place + n;
    for (int k = 0; k < n; ++k) position_[part.vertices[k]] = part.place + k;
    const auto for_neighbours = [&](int v, const auto& body) {
      for (int e = whole_.begin[v]; e < whole_.begin[v + 1]; ++e) body(position_[whole_.to[e]]);
    };
    std::vector<int> around;
    for (int v : part.vertices)
      for_neighbours(v, [&](int p) {
        if (p >= end) around.push_back(p);
      });
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    MinimumDegree leaf(n, int_size(around));
    for (int k = 0; k < n; ++k)
      for_neighbours(part.vertices[k], [&](int p) {
        const auto it = std::lower_bound(around.begin(), around.end(), p);
        leaf.add_edge(k, p < end ? p - part.place : n + static_cast<int>(it - around.begin()));
      });
    int place = part.place;
    for (int k : leaf.order()) put(part.vertices[k], place++);
  }

  const Graph& whole_;
  const Task& task_;
  std::vector<int> order_;
  std::vector<int> position_;  // in it
};

}  // namespace

std::vector<int> nested_dissection(const Graph& graph, const Task& task) {
  return Dissection(graph, task).order();
}

}  // namespace littoral
