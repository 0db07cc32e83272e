#include "sources/systems/source_parts.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

#include "base/index.h"

namespace littoral {

namespace {

constexpr int max_batches = 16;

struct Neighbours {
  std::vector<int> offset, vertex;
  std::vector<double> length;
};

Neighbours along_edges(const IntrinsicTriangulation& T) {
  std::vector<double> edge_length(T.n_edges(), -1);
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) edge_length[T.side_edge(f, k)] = T.length(f, k);
  Neighbours out;
  out.offset.assign(T.n_vertices + 1, 0);
  for (int e = 0; e < T.n_edges(); ++e)
    for (int side = 0; side < 2 && edge_length[e] >= 0; ++side) ++out.offset[T.edges(e, side) + 1];
  std::partial_sum(out.offset.begin(), out.offset.end(), out.offset.begin());
  out.vertex.resize(out.offset.back());
  out.length.resize(out.offset.back());
  std::vector<int> next(out.offset.begin(), out.offset.end() - 1);
  for (int e = 0; e < T.n_edges(); ++e)
    for (int side = 0; side < 2 && edge_length[e] >= 0; ++side) {
      const int at = next[T.edges(e, side)]++;
      out.vertex[at] = T.edges(e, 1 - side);
      out.length[at] = edge_length[e];
    }
  return out;
}

/// Parts whose regions touch, per part, ascending.
std::vector<std::vector<int>> touching(const IntrinsicTriangulation& T,
                                       const std::vector<PartStart>& starts, int n_parts) {
  std::vector<std::pair<int, int>> pairs;
  const Neighbours around = along_edges(T);
  std::vector<double> distance(T.n_vertices, infinity);
  std::vector<int> owner(T.n_vertices, -1);
  // Ties go to the lower part: the numbers of vertices decide nothing.
  std::priority_queue<std::tuple<double, int, int>, std::vector<std::tuple<double, int, int>>,
                      std::greater<>>
      queue;
  for (const PartStart& s : starts) queue.emplace(s.distance, s.part, s.vertex);
  while (!queue.empty()) {
    const auto [d, part, v] = queue.top();
    queue.pop();
    if (owner[v] >= 0) {
      if (owner[v] != part) pairs.emplace_back(std::min(owner[v], part), std::max(owner[v], part));
      continue;
    }
    owner[v] = part;
    distance[v] = d;
    for (int i = around.offset[v]; i < around.offset[v + 1]; ++i)
      if (owner[around.vertex[i]] != part)
        queue.emplace(d + around.length[i], part, around.vertex[i]);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<std::vector<int>> out(n_parts);
  for (const auto& [a, b] : pairs) {
    out[a].push_back(b);
    out[b].push_back(a);
  }
  return out;
}

}  // namespace

std::vector<int> batches_of_parts(const IntrinsicTriangulation& T,
                                  const std::vector<PartStart>& starts, int n_parts) {
  std::vector<int> batch(n_parts, -1);
  if (n_parts <= 4) {
    std::iota(batch.begin(), batch.end(), 0);
    return batch;
  }
  const auto neighbours = touching(T, starts, n_parts);
  for (int p = 0; p < n_parts; ++p) {
    std::array<int, max_batches> used{};
    auto use = [&](int q, int weight) {
      if (q != p && batch[q] >= 0) used[batch[q]] += weight;
    };
    for (int q : neighbours[p]) {
      use(q, 1000);
      for (int r : neighbours[q]) use(r, 1);
    }
    batch[p] = std::min_element(used.begin(), used.end()) - used.begin();
  }
  return batch;
}

}  // namespace littoral
