#include "methods/geodesic/tet_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <queue>
#include <utility>

#include "base/index.h"
#include "base/parallel.h"
#include "spatial/closest_on_triangle.h"
#include "spatial/triangle_bvh.h"

namespace littoral {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr std::size_t ways_kept = 4;  // at a vertex, for its neighbours to try
constexpr int bisections = 40;
constexpr double nothing = 1e-9;  // of a way's length: two bends are one
constexpr double at_end = 1e-4;   // of an edge: a least value there is as near as it can be found
constexpr double better = 1 - 1e-12;
constexpr double last_choice = 1 + 1e-10;  // of equal ways, one that may move along an edge

/// Where the last straight part of a way begins: on a face of the source, or at a bend, a point of
/// an edge or, where a = b, a vertex. Before the bend the way may be bent as well. Straightened up
/// to the last vertex that it turns at, or to the source, it begins at `behind`, `before` from the
/// source: moved along the edge, its length changes as that of a straight line from there does,
/// exactly round edges that are parallel.
struct Bend {
  int face = -1;  // of the source; -1: a bend
  Vec3 point = Vec3::Zero(), a = Vec3::Zero(), b = Vec3::Zero(), behind = Vec3::Zero();
  double before = 0;

  bool at_vertex() const { return face < 0 && a == b; }
};

Bend on_face(int face, const Vec3& q) {
  Bend out;
  out.face = face;
  out.point = q;
  return out;
}

/// A way to a vertex.
struct Way {
  int root = -1;
  double length = never, side = 1;
  Bend from{};
};

/// What ways may have in common: a face of the source, or the neighbourhood of a vertex with the
/// way to it.
struct Root {
  int face = -1, vertex = -1;
  Way way{};
};

class Bending {
 public:
  Bending(const TetMesh& mesh, const TetSight& sight, const TetPathSources& sources,
          const SideOf& side, std::vector<Way> seen)
      : mesh_(mesh),
        sight_(sight),
        sources_(sources),
        side_(side),
        reentrant_(reentrant_edges(mesh, sight)),
        ways_(mesh.n_vertices()),
        tried_(mesh.n_vertices()),
        fixed_(mesh.n_vertices(), 0) {
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      if (!(seen[v].length < never)) continue;
      fixed_[v] = 1;
      seen[v].root = root_of(source_roots_, seen[v].from.face, Root{seen[v].from.face, -1, {}});
      ways_[v].push_back(seen[v]);
    }
  }

  /// Ways to the vertices without one, shortest first.
  void complete(const std::vector<int>& component, const Task& task) {
    for (int v = 0; v < mesh_.n_vertices(); ++v)
      if (fixed_[v]) {
        const std::vector<int> next = neighbours(v);
        if (std::any_of(next.begin(), next.end(), [&](int w) { return !fixed_[w]; }))
          open_.emplace(ways_[v].front().length, v);
      }
    const auto wanted =
        std::count_if(component.begin(), component.end(), [](int c) { return c >= 0; });
    double done = 0;
    while (!open_.empty()) {
      const auto [length, v] = open_.top();
      open_.pop();
      if (ways_[v].front().length < better * length) continue;  // queued again since
      task.checkpoint(std::min(1.0, ++done / double(wanted)));
      const std::vector<Way> known = ways_[v];
      for (const int w : neighbours(v)) {
        if (fixed_[w]) continue;
        for (const Way& way : known) try_root(way.root, w);
        if (reentrant_[v].empty())
          step(v, w);
        else
          try_root(vertex_root(v), w);
      }
    }
  }

  const Way* way_to(int v) const { return ways_[v].empty() ? nullptr : &ways_[v].front(); }
  bool is_bent(int v) const { return !fixed_[v]; }

 private:
  using Roots = std::map<int, int>;

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

  int root_of(Roots& roots, int key, Root root) {
    const auto [at, is_new] = roots.try_emplace(key, int_size(roots_));
    if (is_new) roots_.push_back(std::move(root));
    return at->second;
  }
  int vertex_root(int v) {
    const int root = root_of(vertex_roots_, v, Root{-1, v, {}});
    roots_[root].way = ways_[v].front();
    return root;
  }

  Vec3 closest(int face, const Vec3& x) const {
    const auto corner = [&](int k) {
      return Vec3(sources_.points.row(sources_.faces(face, k)).transpose() - x);
    };
    return x + closest_on_triangle(corner(0), corner(1), corner(2)).offset;
  }
  struct Back {
    Vec3 end;
    double length;
    bool taut = true;  // false: it ends where the edge does and would go on
  };
  /// Where a way from x by a bend, moved along its edge, or to a face ends, and its length.
  Back back(const Bend& from, const Vec3& x) const {
    if (from.face >= 0) {
      const Vec3 q = closest(from.face, x);
      return {q, (q - x).norm()};
    }
    Back out{from.a, 0};
    const Vec3 along = from.b - from.a;
    if (const double squared = along.squaredNorm(); squared > 0) {
      // Turned about the edge into one plane, on either side of it.
      const auto at = [&](const Vec3& p) { return (p - from.a).dot(along) / squared; };
      const auto off = [&](const Vec3& p, double u) { return (p - from.a - u * along).norm(); };
      const double u = at(x), v = at(from.behind), away = off(x, u), behind = off(from.behind, v);
      const double z = away + behind > 0 ? (u * behind + v * away) / (away + behind) : u;
      out.taut = z > -at_end && z < 1 + at_end;
      out.end += std::clamp(z, 0.0, 1.0) * along;
    }
    out.length = from.before + (out.end - from.behind).norm() + (x - out.end).norm();
    return out;
  }
  /// A bend at a point of an edge, of a way that comes by `from`.
  Bend bend(const Vec3& at, const Vec3& a, const Vec3& b, const Bend& from) const {
    const Back way = back(from, at);
    if (from.at_vertex()) return {-1, at, a, b, from.a, way.length - (at - from.a).norm()};
    const double last = (at - way.end).norm();
    if (!(last > nothing * way.length))  // it has just turned
      return {-1, at, a, b, from.face >= 0 ? way.end : from.behind, from.before};
    return {-1, at, a, b, at - (way.length - from.before) / last * (at - way.end), from.before};
  }

  double best(int w) const { return ways_[w].empty() ? never : ways_[w].front().length; }
  /// Longer ways are not worth a look.
  double bound(int w) const { return ways_[w].size() < ways_kept ? never : ways_[w].back().length; }

  void keep(int w, Way way) {
    std::vector<Way>& ways = ways_[w];
    const bool improves = way.length < better * best(w);
    const double length = way.length;
    const auto same = [&](const Way& other) { return other.root == way.root; };
    if (const auto old = std::find_if(ways.begin(), ways.end(), same); old != ways.end()) {
      if (old->length <= length) return;
      ways.erase(old);
    }
    const auto at = std::upper_bound(ways.begin(), ways.end(), way, [](const Way& a, const Way& b) {
      return a.length < b.length;
    });
    ways.insert(at, std::move(way));
    if (ways.size() > ways_kept) ways.pop_back();
    if (improves) open_.emplace(length, w);
  }

  /// On along the edge from v to w, where nothing else leads on.
  void step(int v, int w) {
    const double length = ways_[v].front().length + (point(w) - point(v)).norm();
    if (!(length < better * best(w))) return;
    const Way& to_v = ways_[v].front();
    const Vec3 at = point(v);
    keep(w, {vertex_root(v), length, to_v.side, bend(at, at, at, to_v.from)});
  }

  void try_root(int number, int w) {
    // Once for each way to the root's vertex, which may have become shorter since.
    const auto [tried, is_new] = tried_[w].try_emplace(number, roots_[number].way.length);
    if (!is_new && !(roots_[number].way.length < better * tried->second)) return;
    tried->second = roots_[number].way.length;
    const Root root = roots_[number];
    if (root.vertex >= 0) {
      if (auto way = bent(root, w)) {
        way->root = number;
        keep(w, std::move(*way));
      }
      return;
    }
    const Vec3 x = point(w);
    const Vec3 q = closest(root.face, x);
    const double length = (q - x).norm();
    if (!(length < bound(w))) return;
    if (sight_.sees(w, q, walk_)) {
      keep(w, {number, length, side_(root.face, q, x), on_face(root.face, q)});
      return;
    }
    // What is in the way has an edge round which the way may go.
    if (walk_.last < 0) return;
    const std::array<int, 4> last{mesh_.tets(walk_.last, 0), mesh_.tets(walk_.last, 1),
                                  mesh_.tets(walk_.last, 2), mesh_.tets(walk_.last, 3)};
    for (const int r : last)
      if (r != w && fixed_[r] && !reentrant_[r].empty()) try_root(vertex_root(r), w);
  }

  /// The shortest way to w by the root's vertex or the reentrant edges there.
  std::optional<Way> bent(const Root& root, int w) {
    struct Turn {
      double length;
      int along;  // the edge's other end, -1: at the vertex
      Vec3 at, other_end;
    };
    const Vec3 x = point(w), r = point(root.vertex);
    std::vector<Turn> turns;
    int at_vertex = -1;
    const auto length_by = [&](const Vec3& e) {
      return back(root.way.from, e).length + (x - e).norm();
    };
    for (const int s : reentrant_[root.vertex]) {
      const Vec3 d = point(s) - r;
      // Beyond its ends the edge says whether a turn there is one of the edge or of the vertex.
      double at = least_at([&](double u) { return length_by(r + u * d); }, -0.5, 1.5);
      if (at < -at_end || at > 1 + at_end) continue;
      at = std::clamp(at, 0.0, 1.0);
      turns.push_back({length_by(r + at * d), s, r + at * d, r});
      if (at > at_end) continue;
      // Two edges as one, where the turn is at their common end and may move either way.
      if (at_vertex >= 0) turns.back().other_end = point(turns[at_vertex].along);
      at_vertex = int_size(turns) - 1;
    }
    turns.push_back({last_choice * (root.way.length + (x - r).norm()), -1, r, r});
    std::stable_sort(turns.begin(), turns.end(),
                     [](const Turn& a, const Turn& b) { return a.length < b.length; });
    for (const Turn& turn : turns) {
      if (!(turn.length < bound(w))) return {};
      const Back before = back(root.way.from, turn.at);
      if (turn.along >= 0 && !before.taut) continue;
      if (turn.along >= 0 && !sight_.sees(root.vertex, turn.along, turn.at, before.end, walk_))
        continue;
      if (!sight_.sees(w, turn.at, walk_)) continue;
      const Vec3 end = turn.along < 0 ? r : point(turn.along);
      return Way{-1, turn.length, root.way.side, bend(turn.at, turn.other_end, end, root.way.from)};
    }
    return {};
  }

  /// Where a convex function is least between low and high, by golden sections.
  template <class F>
  static double least_at(const F& f, double low, double high) {
    constexpr double golden = 0.6180339887498949;
    double a = high - golden * (high - low), b = low + golden * (high - low), fa = f(a), fb = f(b);
    for (int i = 0; i < bisections; ++i)
      if (fa <= fb) {
        high = b;
        b = std::exchange(a, high - golden * (high - low));
        fb = std::exchange(fa, f(a));
      } else {
        low = a;
        a = std::exchange(b, low + golden * (high - low));
        fa = std::exchange(fb, f(b));
      }
    return fa <= fb ? a : b;
  }

  const TetMesh& mesh_;
  const TetSight& sight_;
  const TetPathSources& sources_;
  const SideOf& side_;
  std::vector<std::vector<int>> reentrant_;
  std::vector<Root> roots_;
  Roots source_roots_, vertex_roots_;
  std::vector<std::vector<Way>> ways_;        // vertices, the shortest first
  std::vector<std::map<int, double>> tried_;  // vertices: root -> length of the way to it
  std::vector<char> fixed_;                   // vertices with a straight way
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>>
      open_;
  TetSight::Walk walk_;
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
  std::vector<Way> seen(n);
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
      if (!all_seen && !sight.sees(static_cast<int>(v), foot.point, walk)) continue;
      const int face = faces_of[component[v]][foot.face];
      seen[v] = {-1, foot.distance, side(face, foot.point, x), on_face(face, foot.point)};
    }
  });
  TetPathResult out{VecX::Constant(n, never), VecX::Ones(n), 0};
  const auto put = [&](int v, const Way& way) {
    out.distance[v] = way.length;
    out.side[v] = way.side;
  };
  bool complete = true;
  for (int v = 0; v < n; ++v) {
    put(v, seen[v]);
    complete = complete &&
               (seen[v].length < never || component[v] < 0 || faces_of.count(component[v]) == 0);
  }
  if (complete) return out;
  Bending bending(mesh, sight, sources, side, std::move(seen));
  bending.complete(component, task.stage(0.5, "ways round the boundary"));
  for (int v = 0; v < n; ++v)
    if (const Way* way = bending.way_to(v); way && bending.is_bent(v)) {
      put(v, *way);
      ++out.bent;
    }
  return out;
}

}  // namespace littoral
