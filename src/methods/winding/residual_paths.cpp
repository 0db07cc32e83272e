#include <array>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

#include "base/index.h"
#include "methods/winding/residual.h"

namespace littoral {

namespace {

using Reached = std::pair<double, int>;  // distance, node
using NearestFirst = std::priority_queue<Reached, std::vector<Reached>, std::greater<>>;

/// Nodes and edges as a graph: at[i] lists (edge, other end).
struct EdgeGraph {
  std::vector<std::vector<std::pair<int, int>>> at;
  std::vector<std::array<int, 2>> ends;  // tail, head
  std::vector<char> on_boundary;         // nodes

  explicit EdgeGraph(const JumpCalculus& J)
      : at(J.n_nodes), ends(J.n_edges, {-1, -1}), on_boundary(J.n_nodes, 0) {
    for (int f = 0; f < J.n_faces; ++f)
      for (int k = 0; k < 3; ++k) {
        const int e = J.edge(f, k);
        const int i = J.node(f, k), j = J.node(f, (k + 1) % 3);
        if (!J.interior(e)) on_boundary[i] = on_boundary[j] = 1;
        if (ends[e][0] >= 0) continue;
        ends[e] = J.along(f, k) > 0 ? std::array{i, j} : std::array{j, i};
        at[i].emplace_back(e, j);
        at[j].emplace_back(e, i);
      }
  }
};

/// Dijkstra's search from one node to the nearest that is wanted; remembers what it touched so that
/// the next search starts clean.
class PathSearch {
 public:
  PathSearch(const JumpCalculus& J, const EdgeGraph& graph)
      : J_(J), graph_(graph), distance_(J.n_nodes, infinity), via_(J.n_nodes, -1) {}

  /// The node found and how far it is; node -1: none. `path` gets its edges.
  template <class Wanted>
  Reached nearest(int start, const Wanted& wanted, std::vector<int>& path) {
    NearestFirst front;
    reach(start, 0, -1, front);
    Reached found{infinity, -1};
    while (!front.empty()) {
      const auto [d, i] = front.top();
      front.pop();
      if (d > distance_[i]) continue;
      if (wanted(i)) {
        found = {d, i};
        break;
      }
      for (const auto& [e, j] : graph_.at[i])
        if (d + J_.length[e] < distance_[j]) reach(j, d + J_.length[e], e, front);
    }
    path.clear();
    for (int i = found.second; i >= 0 && via_[i] >= 0;) {
      path.push_back(via_[i]);
      const auto [tail, head] = graph_.ends[via_[i]];
      i = tail == i ? head : tail;
    }
    for (int i : touched_) {
      distance_[i] = infinity;
      via_[i] = -1;
    }
    touched_.clear();
    return found;
  }

 private:
  void reach(int i, double d, int via, NearestFirst& front) {
    if (distance_[i] == infinity) touched_.push_back(i);
    distance_[i] = d;
    via_[i] = via;
    front.emplace(d, i);
  }

  const JumpCalculus& J_;
  const EdgeGraph& graph_;
  std::vector<double> distance_;
  std::vector<int> via_, touched_;
};

/// gamma integrated over every part; parts are what edges with `cut` separate. Faces are visited in
/// the order of their distance, in faces, from the cut edges.
MatX3 integrate_parts(const JumpCalculus& J, const VecX& gamma, const std::vector<char>& cut,
                      std::vector<int>& part) {
  MatX3 v = integrate_locally(J, gamma);
  std::vector<int> rank(J.n_faces, -1), queue;
  for (int f = 0; f < J.n_faces; ++f)
    if (cut[J.edge(f, 0)] || cut[J.edge(f, 1)] || cut[J.edge(f, 2)]) {
      rank[f] = 0;
      queue.push_back(f);
    }
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int f = queue[i], g = J.across(f, k).face;
      if (g < 0 || rank[g] >= 0) continue;
      rank[g] = rank[f] + 1;
      queue.push_back(g);
    }
  part.assign(J.n_faces, -1);
  NearestFirst front;
  for (int root = 0; root < J.n_faces; ++root) {
    if (part[root] >= 0) continue;
    part[root] = root;
    front.emplace(rank[root], root);
    while (!front.empty()) {
      const int f = front.top().second;
      front.pop();
      for (int k = 0; k < 3; ++k) {
        const JumpCalculus::Side at = J.across(f, k);
        if (at.face < 0 || cut[J.edge(f, k)] || part[at.face] >= 0) continue;
        part[at.face] = root;
        const int corner = J.corner_across(f, k, at);
        v.row(at.face).array() += v(f, k) - v(at.face, corner);
        front.emplace(rank[at.face], at.face);
      }
    }
  }
  return v;
}

}  // namespace

std::vector<char> completing_paths(const JumpCalculus& J, const VecX& curve, const Task& task) {
  const EdgeGraph graph(J);
  std::vector<int> surplus(J.n_nodes, 0);
  for (int e = 0; e < J.n_edges; ++e) {
    const int times = static_cast<int>(std::lround(curve[e]));
    if (times == 0) continue;
    surplus[graph.ends[e][1]] += times;
    surplus[graph.ends[e][0]] -= times;
  }
  for (int i = 0; i < J.n_nodes; ++i)
    if (graph.on_boundary[i]) surplus[i] = 0;
  // Nearest pairs first: an end whose start is taken meanwhile looks again.
  PathSearch search(J, graph);
  std::vector<int> path;
  const auto wanted = [&](int i) { return surplus[i] < 0 || graph.on_boundary[i]; };
  NearestFirst ends;
  const auto look = [&](int i) {
    task.checkpoint();
    const Reached found = search.nearest(i, wanted, path);
    if (found.second >= 0) ends.emplace(found.first, i);
  };
  for (int i = 0; i < J.n_nodes; ++i)
    if (surplus[i] > 0) look(i);
  std::vector<char> on_path(J.n_edges, 0);
  while (!ends.empty()) {
    const auto [expected, i] = ends.top();
    ends.pop();
    const auto [d, j] = search.nearest(i, wanted, path);
    if (j < 0) continue;
    if (d > expected) {
      ends.emplace(d, i);
      continue;
    }
    for (int e : path) on_path[e] = 1;
    if (surplus[j] < 0) ++surplus[j];
    if (--surplus[i] > 0) look(i);
  }
  return on_path;
}

ResidualFunction integrate_between_paths(const JumpCalculus& J, const VecX& gamma,
                                         const VecX& curve, const VecX& weight,
                                         const std::vector<char>& take, const Task& task,
                                         Report& report) {
  std::vector<char> cut = completing_paths(J, curve, task);
  for (int e = 0; e < J.n_edges; ++e) cut[e] = cut[e] || curve[e] != 0;
  std::vector<int> part;
  const MatX3 v = integrate_parts(J, gamma, cut, part);
  return integrate_jumps(J, v, weight, {}, {}, take, part, {}, task, report);
}

}  // namespace littoral
