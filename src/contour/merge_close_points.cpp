#include <algorithm>
#include <array>
#include <numeric>

#include "base/counted.h"
#include "base/index.h"
#include "base/option_table.h"
#include "contour/rough_surface.h"

namespace littoral {

namespace {

constexpr int dead = -1;
constexpr std::size_t often = 4096;  // steps between checkpoints

// Vertices around one: all, and those at the far end of an edge with one face. Ascending.
struct Ring {
  std::vector<int> all, rim;
};

// Points close to the same node, ascending; several of them.
using Cluster = std::vector<int>;

class Merger {
 public:
  explicit Merger(RoughSurface rough) : r_(std::move(rough)) {}

  void drop_points_without_size(const Task& task);
  void merge(const Task& task);
  PolygonSoup compact(const Task& task);

 private:
  void find_clusters();
  Ring ring(int v) const;
  bool may_merge(int u, int v) const;
  void merge(int u, int v);
  bool merge_one_into(int u);

  RoughSurface r_;
  std::vector<Cluster> clusters_;
  std::vector<int> slot_;                // vertex -> place in faces_, or -1: not in a cluster
  std::vector<std::vector<int>> faces_;  // triangles at a vertex; some of them dead
  std::vector<int> merged_;              // by slot: how many points have become this one
};

// Where a node's value equals the level and all around are larger, a closed surface of no size
// surrounds it.
void Merger::drop_points_without_size(const Task& task) {
  std::vector<int> root(r_.points.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (std::size_t t = 0; t < r_.triangles.size(); ++t) {
    if (t % often == 0) task.checkpoint(0.1);
    for (int k : {1, 2}) {
      const int a = find(r_.triangles[t][0]), b = find(r_.triangles[t][k]);
      root[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<bool> has_size(r_.points.size(), false);
  for (int v = 0; v < int_size(root); ++v) {
    const int first = find(v);
    if (r_.node[v] < 0 || r_.points[v] != r_.points[first]) has_size[first] = true;
  }
  for (auto& t : r_.triangles) {
    if (!has_size[find(t[0])]) t[0] = dead;
  }
}

void Merger::find_clusters() {
  std::vector<int> close;
  for (int v = 0; v < int_size(r_.node); ++v) {
    if (r_.node[v] >= 0) close.push_back(v);
  }
  std::stable_sort(close.begin(), close.end(),
                   [&](int a, int b) { return r_.node[a] < r_.node[b]; });
  slot_.assign(r_.points.size(), -1);
  int slots = 0;
  for (std::size_t i = 0, j = 0; i < close.size(); i = j) {
    for (j = i; j < close.size() && r_.node[close[j]] == r_.node[close[i]];) ++j;
    if (j - i < 2) continue;
    clusters_.emplace_back(close.begin() + i, close.begin() + j);
    for (int v : clusters_.back()) slot_[v] = slots++;
  }
  faces_.resize(slots);
  merged_.assign(slots, 1);
  for (int t = 0; t < int_size(r_.triangles); ++t) {
    if (r_.triangles[t][0] == dead) continue;
    for (int v : r_.triangles[t]) {
      if (slot_[v] >= 0) faces_[slot_[v]].push_back(t);
    }
  }
}

Ring Merger::ring(int v) const {
  std::vector<int> ends;
  for (int t : faces_[slot_[v]]) {
    if (r_.triangles[t][0] == dead) continue;
    for (int w : r_.triangles[t]) {
      if (w != v) ends.push_back(w);
    }
  }
  std::sort(ends.begin(), ends.end());
  Ring ring;
  for (std::size_t i = 0, j = 0; i < ends.size(); i = j) {
    for (j = i; j < ends.size() && ends[j] == ends[i];) ++j;
    ring.all.push_back(ends[i]);
    if (j - i == 1) ring.rim.push_back(ends[i]);
  }
  return ring;
}

bool contains(const std::vector<int>& sorted, int v) {
  return std::binary_search(sorted.begin(), sorted.end(), v);
}

// The link condition: what u and v are both joined to must be what their edge is joined to (Dey,
// Edelsbrunner, Guha and Nekhayev 1999; the rim counts as joined to one more vertex).
bool Merger::may_merge(int u, int v) const {
  const Ring at_u = ring(u), at_v = ring(v);
  const bool edge_on_rim = contains(at_u.rim, v);
  if (!at_u.rim.empty() && !at_v.rim.empty() && !edge_on_rim) return false;
  std::vector<int> common;
  std::set_intersection(at_u.all.begin(), at_u.all.end(), at_v.all.begin(), at_v.all.end(),
                        std::back_inserter(common));
  if (common.size() != (edge_on_rim ? 1u : 2u)) return false;
  for (int a : common) {
    if (contains(at_u.rim, a) && contains(at_v.rim, a)) return false;
  }
  // Both are joined to the two vertices; are they joined to an edge between them, too?
  int with_both = 0;
  for (int w : {u, v}) {
    for (int t : faces_[slot_[w]]) {
      const auto& corners = r_.triangles[t];
      if (corners[0] == dead) continue;
      bool all = common.size() == 2;
      for (int a : common)
        all = all && std::find(corners.begin(), corners.end(), a) != corners.end();
      if (all) ++with_both;
    }
  }
  return with_both < 2;
}

void Merger::merge(int u, int v) {
  const int su = slot_[u], sv = slot_[v];
  const double total = merged_[su] + merged_[sv];
  r_.points[u] = (merged_[su] * r_.points[u] + merged_[sv] * r_.points[v]) / total;
  r_.separated_points[u] =
      (merged_[su] * r_.separated_points[u] + merged_[sv] * r_.separated_points[v]) / total;
  merged_[su] += merged_[sv];
  merged_[sv] = 0;
  for (int t : faces_[sv]) {
    auto& corners = r_.triangles[t];
    if (corners[0] == dead) continue;
    if (std::find(corners.begin(), corners.end(), u) != corners.end()) {
      corners[0] = dead;
    } else {
      std::replace(corners.begin(), corners.end(), v, u);
      faces_[su].push_back(t);
    }
  }
  faces_[sv].clear();
  auto& list = faces_[su];
  list.erase(
      std::remove_if(list.begin(), list.end(), [&](int t) { return r_.triangles[t][0] == dead; }),
      list.end());
}

bool Merger::merge_one_into(int u) {
  for (int v : ring(u).all) {
    if (r_.node[v] != r_.node[u] || !may_merge(u, v)) continue;
    merge(u, v);
    return true;
  }
  return false;
}

void Merger::merge(const Task& task) {
  find_clusters();
  // Merging at one node may free the way at another: go over all of them twice.
  for (int round = 0; round < 2; ++round) {
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
      if (c % 64 == 0) task.checkpoint(0.2 + 0.6 * static_cast<double>(c) / clusters_.size());
      Cluster& cluster = clusters_[c];
      for (int u : cluster) {
        while (merged_[slot_[u]] > 0 && merge_one_into(u)) continue;
      }
      cluster.erase(std::remove_if(cluster.begin(), cluster.end(),
                                   [&](int v) { return merged_[slot_[v]] == 0; }),
                    cluster.end());
    }
  }
  for (const Cluster& cluster : clusters_) {
    if (cluster.size() < 2) continue;
    for (int v : cluster) r_.points[v] = r_.separated_points[v];
  }
}

PolygonSoup Merger::compact(const Task& task) {
  task.checkpoint(0.9);
  std::vector<int> number(r_.points.size(), -1);
  PolygonSoup soup;
  for (const auto& t : r_.triangles) {
    if (t[0] == dead) continue;
    soup.add_face(t);
    for (int v : t) number[v] = 0;
  }
  int used = 0;
  for (int& n : number) {
    if (n == 0) n = used++;
  }
  soup.points.resize(used, 3);
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] >= 0) soup.points.row(number[v]) = r_.points[v].transpose();
  }
  for (int& v : soup.corners) v = number[v];
  return soup;
}

}  // namespace

PolygonSoup merge_close_points(RoughSurface rough, const Task& task) {
  Merger merger(std::move(rough));
  merger.drop_points_without_size(task);
  merger.merge(task);
  return merger.compact(task);
}

void report_boundary(const PolygonSoup& surface, double level, Report& report) {
  // Directed sides, as tail and head; a side whose reverse is missing is a boundary.
  std::vector<std::pair<int, int>> sides;
  sides.reserve(surface.corners.size());
  for (int f = 0; f < surface.n_faces(); ++f) {
    const auto face = surface.face(f);
    for (std::size_t k = 0; k < face.size(); ++k)
      sides.emplace_back(face[k], face[(k + 1) % face.size()]);
  }
  std::sort(sides.begin(), sides.end());
  std::size_t open = 0;
  for (const auto& [a, b] : sides)
    open += !std::binary_search(sides.begin(), sides.end(), std::pair(b, a));
  report.sizes.emplace_back("boundary edges", static_cast<double>(open));
  if (open != 0)
    report.warn("open-surface",
                "the surface at level " + rounded_text(level) +
                    " is open: it meets the boundary of the box or the tets along " +
                    counted(open, "edge", "edges") +
                    "; raise option padding or widen option bounds, or close it there by "
                    "option clip");
}

}  // namespace littoral
