#include "methods/geodesic/tet_paths.h"

#include <algorithm>
#include <map>
#include <queue>
#include <set>
#include <utility>

#include "base/index.h"
#include "base/parallel.h"
#include "methods/geodesic/tet_paths_taut.h"
#include "spatial/closest_on_triangle.h"
#include "spatial/triangle_bvh.h"

namespace littoral {

namespace {

constexpr std::size_t ways_kept = 2;  // at a vertex, for its neighbours to try
constexpr double better = 1 - 1e-12;

/// A way to a vertex.
struct Way {
  double side = 1;
  WayInTets in{};

  double length() const { return in.length; }
  /// Where it turns; ways with the same one are pulled to the same length.
  std::vector<int> key() const {
    std::vector<int> out{in.turns.empty() ? in.face : -1};
    for (const EdgeTurn& turn : in.turns) {
      out.push_back(std::min(turn.a, turn.b));
      out.push_back(std::max(turn.a, turn.b));
    }
    return out;
  }
};

/// Ways out of sight: from a vertex on to its neighbours, and pulled taut there.
class Bending {
 public:
  Bending(const TetMesh& mesh, const TetSight& sight, const SideOf& side, const SourceFoot& foot,
          std::vector<Way> seen)
      : mesh_(mesh),
        sight_(sight),
        side_(side),
        reentrant_(reentrant_edges(mesh, sight)),
        taut_(mesh, sight, reentrant_, foot),
        ways_(mesh.n_vertices()),
        tried_(mesh.n_vertices()),
        fixed_(mesh.n_vertices(), 0) {
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      if (!(seen[v].length() < infinity)) continue;
      fixed_[v] = 1;
      ways_[v].push_back(std::move(seen[v]));
    }
  }

  /// Ways to the vertices without one, shortest first.
  void complete(const std::vector<int>& component, const Task& task) {
    for (int v = 0; v < mesh_.n_vertices(); ++v)
      if (fixed_[v]) {
        const std::vector<int> next = neighbours(v);
        if (std::any_of(next.begin(), next.end(), [&](int w) { return !fixed_[w]; }))
          open_.emplace(best(v), v);
      }
    const auto wanted =
        std::count_if(component.begin(), component.end(), [](int c) { return c >= 0; });
    double done = 0;
    while (!open_.empty()) {
      const auto [length, v] = open_.top();
      open_.pop();
      if (best(v) < better * length) continue;  // queued again since
      task.checkpoint(std::min(1.0, ++done / double(wanted)));
      const std::vector<Way> known = ways_[v];
      for (const int w : neighbours(v))
        for (const Way& way : known)
          if (!fixed_[w]) go_on(way, v, w);
    }
  }

  const Way* way_to(int v) const { return ways_[v].empty() ? nullptr : &ways_[v].front(); }
  bool is_bent(int v) const { return !fixed_[v]; }

 private:
  Vec3 point(int v) const { return mesh_.points.row(v); }

  std::vector<int> neighbours(int v) const {
    std::vector<int> out;
    for (const int t : sight_.tets_at(v))
      for (int k = 0; k < 4; ++k)
        if (mesh_.tets(t, k) != v) out.push_back(mesh_.tets(t, k));
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  double best(int w) const { return ways_[w].empty() ? infinity : ways_[w].front().length(); }
  /// Longer ways are not worth a look.
  double bound(int w) const {
    return ways_[w].size() < ways_kept ? infinity : ways_[w].back().length();
  }

  /// From v on to its neighbour w.
  void go_on(const Way& to_v, int v, int w) {
    // The length of ways that turn at the same edges is a convex function of their end.
    const Vec3 last =
        to_v.in.turns.empty() ? to_v.in.start : place_of(mesh_.points, to_v.in.turns.back());
    const Vec3 direction = (point(v) - last).normalized();
    if (to_v.length() + direction.dot(point(w) - point(v)) > bound(w)) return;
    const std::vector<int> key = to_v.key();
    if (tried_[w].count(key) > 0) return;
    Way way = to_v;
    way.in.turns.push_back({v, v});
    taut_.pull(way.in, w);
    const auto& turns = way.in.turns;
    const auto is_v = [&](const EdgeTurn& turn) { return turn.a == v && turn.b == v; };
    if (std::none_of(turns.begin(), turns.end(), is_v)) tried_[w].insert(key);
    way.side = side_(way.in.face, way.in.start,
                     turns.empty() ? point(w) : place_of(mesh_.points, turns.front()));
    keep(w, std::move(way));
  }

  void keep(int w, Way way) {
    std::vector<Way>& ways = ways_[w];
    const bool improves = way.length() < better * best(w);
    const double length = way.length();
    const auto same = [&, key = way.key()](const Way& other) { return other.key() == key; };
    if (const auto old = std::find_if(ways.begin(), ways.end(), same); old != ways.end()) {
      if (old->length() <= length) return;
      ways.erase(old);
    }
    const auto at = std::upper_bound(ways.begin(), ways.end(), way, [](const Way& a, const Way& b) {
      return a.length() < b.length();
    });
    ways.insert(at, std::move(way));
    if (ways.size() > ways_kept) ways.pop_back();
    if (improves) open_.emplace(length, w);
  }

  const TetMesh& mesh_;
  const TetSight& sight_;
  const SideOf& side_;
  std::vector<std::vector<int>> reentrant_;
  TautInTets taut_;
  std::vector<std::vector<Way>> ways_;             // vertices, the shortest first
  std::vector<std::set<std::vector<int>>> tried_;  // vertices: keys of ways to neighbours
  std::vector<char> fixed_;                        // vertices with a straight way
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>>
      open_;
};

}  // namespace

TetPathResult tet_paths(const TetMesh& mesh, const TetSight& sight,
                        const std::vector<int>& component, const TetPathSources& sources,
                        bool all_seen, const SideOf& side, Task task) {
  const int n = mesh.n_vertices();
  std::map<int, std::vector<int>> faces_of;  // component -> faces
  for (std::size_t f = 0; f < sources.component.size(); ++f)
    if (sources.component[f] >= 0) faces_of[sources.component[f]].push_back(static_cast<int>(f));
  std::map<int, TriangleBvh> nearest;
  for (const auto& [c, faces] : faces_of)
    nearest.try_emplace(c, sources.points, MatX3i(sources.faces(faces, Eigen::all)));
  std::vector<Way> seen(n, Way{1, {-1, -1, Vec3::Zero(), {}, infinity}});
  const auto source_vertex = [&](int face) {
    const auto f = sources.faces.row(face);
    return sources.of_mesh && f[0] == f[1] && f[0] == f[2] ? f[0] : -1;
  };
  const Task straight = task.stage(0.5, "straight ways");
  parallel_for(n, 1024, [&](std::size_t begin, std::size_t end) {
    straight.checkpoint(double(begin) / n);
    TetSight::Walk walk;
    int last = -1, part = -1;
    for (std::size_t v = begin; v < end; ++v) {
      const auto at = nearest.find(component[v]);
      if (component[v] < 0 || at == nearest.end()) continue;
      const Vec3 x = mesh.points.row(v);
      const NearestPoint foot = at->second.closest_point(x, part == component[v] ? last : -1);
      last = foot.face;
      part = component[v];
      const int face = faces_of.at(component[v])[foot.face];
      const int from = source_vertex(face);
      if (!all_seen && !sight.sees(static_cast<int>(v), foot.point, walk, {from, -1})) continue;
      seen[v] = {side(face, foot.point, x), {face, from, foot.point, {}, foot.distance}};
    }
  });
  // Of sources in one place, on the sides of a cut, the nearest may have been another.
  for (std::size_t f = 0; f < sources.component.size(); ++f)
    if (const int v = source_vertex(static_cast<int>(f)); v >= 0 && sources.component[f] >= 0)
      seen[v] = {1, {static_cast<int>(f), v, mesh.points.row(v), {}, 0}};
  TetPathResult out{VecX::Constant(n, infinity), VecX::Ones(n), 0};
  const auto put = [&](int v, const Way& way) {
    out.distance[v] = way.length();
    out.side[v] = way.side;
  };
  bool complete = true;
  for (int v = 0; v < n; ++v) {
    put(v, seen[v]);
    complete = complete && (seen[v].length() < infinity || component[v] < 0 ||
                            faces_of.count(component[v]) == 0);
  }
  if (complete) return out;
  const SourceFoot foot = [&](int face, const Vec3& x, bool of_all) -> std::pair<int, Vec3> {
    if (of_all) {
      const int c = sources.component[face];
      const NearestPoint found = nearest.at(c).closest_point(x, -1);
      return {faces_of[c][found.face], found.point};
    }
    const auto corner = [&](int k) {
      return Vec3(sources.points.row(sources.faces(face, k)).transpose() - x);
    };
    return {face, x + closest_on_triangle(corner(0), corner(1), corner(2)).offset};
  };
  Bending bending(mesh, sight, side, foot, std::move(seen));
  bending.complete(component, task.stage(0.5, "ways round the boundary"));
  for (int v = 0; v < n; ++v)
    if (const Way* way = bending.way_to(v); way && bending.is_bent(v)) {
      put(v, *way);
      ++out.bent;
    }
  return out;
}

}  // namespace littoral
