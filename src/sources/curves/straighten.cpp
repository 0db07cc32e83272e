#include "sources/curves/straighten.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "sources/surface/surface_points.h"

namespace littoral {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int most_rounds = 2000;

double cross(const Vec2& a, const Vec2& b) { return a[0] * b[1] - a[1] * b[0]; }

double angle(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Two edges or ends that the unfolded strip passes between, seen in the direction of travel.
struct Portal {
  int left, right;  // vertices
  Vec2 l, r;
};

/// Drops nodes that are not needed: consecutive ones must share a face, and a straight step inside
/// a face is never longer than two.
void simplify(const SurfaceMesh& mesh, SurfacePath& path) {
  for (bool changed = true; changed;) {
    changed = false;
    SurfacePath kept;
    kept.nodes.push_back(path.nodes.front());
    int before = path.faces.front();
    for (std::size_t i = 1; i + 1 < path.nodes.size(); ++i) {
      const SurfacePoint &node = path.nodes[i], &prev = kept.nodes.back(),
                         &next = path.nodes[i + 1];
      const int after = path.faces[i];
      if (before == after) {
        changed = true;
      } else if (node.on == SurfacePoint::On::edge
                     ? on_closed_edge(mesh, prev, node.element)
                     : prev.on == SurfacePoint::On::vertex && prev.element == node.element) {
        before = after;
        changed = true;
      } else if (node.on == SurfacePoint::On::edge
                     ? on_closed_edge(mesh, next, node.element)
                     : next.on == SurfacePoint::On::vertex && next.element == node.element) {
        changed = true;
      } else {
        kept.nodes.push_back(node);
        kept.faces.push_back(before);
        before = after;
      }
    }
    kept.nodes.push_back(path.nodes.back());
    kept.faces.push_back(before);
    path = std::move(kept);
  }
}

class Straightener {
 public:
  Straightener(const SurfaceMesh& mesh, double scale) : mesh_(mesh), scale_(scale) {}

  /// Replaces the crossings between fixed nodes by the shortest ones through the same edges.
  void pull_tight(SurfacePath& path) const {
    std::size_t from = 0;
    for (std::size_t i = 1; i < path.nodes.size(); ++i) {
      if (path.nodes[i].on == SurfacePoint::On::edge && i + 1 < path.nodes.size()) continue;
      if (i > from + 1) pull_strip(path, from, i);
      from = i;
    }
    for (std::size_t i = 1; i + 1 < path.nodes.size(); ++i)
      path.nodes[i] = simplest(mesh_, path.nodes[i]);
  }

  /// Leads the path around the vertices it passes at less than half a turn.
  SurfacePath bypass_vertices(const SurfacePath& path) const {
    SurfacePath detoured;
    detoured.nodes.push_back(path.nodes.front());
    for (std::size_t i = 1; i < path.nodes.size(); ++i) {
      detoured.faces.push_back(path.faces[i - 1]);
      const SurfacePoint& node = path.nodes[i];
      const bool inner = i + 1 < path.nodes.size();
      if (!inner || node.on != SurfacePoint::On::vertex || !bypass(path, i, detoured))
        detoured.nodes.push_back(node);
    }
    return detoured;
  }

 private:
  Vec3 at(int vertex) const { return scale_ * mesh_.point(vertex); }

  /// Coordinates of a point beside the directed line from left to right: along it, and away from
  /// it.
  Vec2 beside(const Vec3& point, int left, int right) const {
    const Vec3 origin = at(left), d = at(right) - origin, p = point - origin;
    const double length = d.norm();
    if (!(length > 0)) return {0, p.norm()};
    const Vec3 u = d / length;
    const double along = p.dot(u);
    return {along, (p - along * u).norm()};
  }

  std::vector<Portal> unfold(const SurfacePath& path, std::size_t from, std::size_t to) const {
    std::vector<Portal> portals;
    const int first = path.nodes[from + 1].element;
    Portal portal{mesh_.edges()(first, 0), mesh_.edges()(first, 1), Vec2::Zero(), Vec2::Zero()};
    portal.r[0] = (at(portal.right) - at(portal.left)).norm();
    portals.push_back(portal);
    Vec2 along(1, 0);  // from left to right; kept where a portal has no length
    for (std::size_t i = from + 1; i + 1 < to; ++i) {
      const auto corners = mesh_.face(path.faces[i]);
      int apex = corners[0];
      for (int c : corners)
        if (c != portal.left && c != portal.right) apex = c;
      const Vec2 offset = beside(at(apex), portal.left, portal.right);
      const Vec2 side = portal.r - portal.l;
      if (side.norm() > 0) along = side.normalized();
      const Vec2 position = portal.l + offset[0] * along + offset[1] * Vec2(-along[1], along[0]);
      const int edge = path.nodes[i + 1].element;
      if (mesh_.edges()(edge, 0) == portal.left || mesh_.edges()(edge, 1) == portal.left) {
        portal.right = apex;
        portal.r = position;
      } else {
        portal.left = apex;
        portal.l = position;
      }
      portals.push_back(portal);
    }
    return portals;
  }

  /// Shortest path between nodes `from` and `to` through the edges between them.
  void pull_strip(SurfacePath& path, std::size_t from, std::size_t to) const {
    const std::vector<Portal> portals = unfold(path, from, to);
    const int m = portals.size();
    const Vec2 start = Vec2(1, -1).cwiseProduct(beside(
        scale_ * mesh_.position(path.nodes[from]), portals.front().left, portals.front().right));
    const Portal& last = portals.back();
    const Vec2 end_offset = beside(scale_ * mesh_.position(path.nodes[to]), last.left, last.right);
    Vec2 along = last.r - last.l;
    along = along.norm() > 0 ? Vec2(along.normalized()) : Vec2(1, 0);
    const Vec2 end = last.l + end_offset[0] * along + end_offset[1] * Vec2(-along[1], along[0]);

    // Corners of the shortest path: (portal, point). Portal 0 is the start, m + 1 the end.
    std::vector<std::pair<int, Vec2>> corners{{0, start}};
    Vec2 apex = start, l = start, r = start;
    int at_l = 0, at_r = 0;
    auto restart = [&](int k, Vec2 corner) {
      corners.emplace_back(k, corner);
      apex = l = r = corner;
      at_l = at_r = k;
      return k;
    };
    for (int k = 1; k <= m + 1; ++k) {
      const Vec2 next_l = k <= m ? portals[k - 1].l : end, next_r = k <= m ? portals[k - 1].r : end;
      const bool open = l == apex || r == apex;
      if (cross(r - apex, next_r - apex) >= 0) {
        if (!open && cross(l - apex, next_r - apex) >= 0) {
          k = restart(at_l, l);
          continue;
        }
        r = next_r;
        at_r = k;
      }
      if (cross(l - apex, next_l - apex) <= 0) {
        if (l != apex && r != apex && cross(r - apex, next_l - apex) <= 0 && at_r < k) {
          k = restart(at_r, r);
          continue;
        }
        l = next_l;
        at_l = k;
      }
    }
    corners.emplace_back(m + 1, end);

    for (std::size_t c = 0; c + 1 < corners.size(); ++c) {
      const Vec2 p = corners[c].second, d = corners[c + 1].second - p;
      for (int k = std::max(1, corners[c].first); k <= std::min(m, corners[c + 1].first); ++k) {
        const Portal& portal = portals[k - 1];
        const double cl = cross(portal.l - p, d), cr = cross(portal.r - p, d);
        double s = 0;
        if (portal.r == p) {
          s = 1;
        } else if (portal.l != p) {
          const Vec2 side = portal.r - portal.l;
          const double length2 = side.squaredNorm();
          if (cl - cr != 0)
            s = cl / (cl - cr);
          else if (length2 > 0)
            s = (p - portal.l).dot(side) / length2;
        }
        s = std::isfinite(s) ? std::clamp(s, 0.0, 1.0) : 0.0;
        const int edge = path.nodes[from + k].element;
        const bool forward = mesh_.edges()(edge, 0) == portal.left;
        path.nodes[from + k] = SurfacePoint::on_edge(edge, forward ? s : 1 - s);
      }
    }
  }

  /// Edge of the face between two of its corners.
  int side_between(int face, int a, int b) const {
    const auto c = mesh_.face(face);
    for (int k = 0; k < 3; ++k) {
      const int p = c[k], q = c[(k + 1) % 3];
      if ((p == a && q == b) || (p == b && q == a)) return mesh_.side_edge(face, k);
    }
    return -1;
  }

  /// Appends the crossings of the narrowest way around vertex node i to `out` and returns true, if
  /// that way turns by less than pi. Dijkstra over the edges at the vertex, with angles for
  /// lengths.
  bool bypass(const SurfacePath& path, std::size_t i, SurfacePath& out) const {
    const int v = path.nodes[i].element, f_in = path.faces[i - 1], f_out = path.faces[i];
    const Vec3 centre = at(v);
    const Vec3 back = scale_ * mesh_.position(path.nodes[i - 1]) - centre;
    const Vec3 ahead = scale_ * mesh_.position(path.nodes[i + 1]) - centre;
    struct Reached {
      double turn;
      int from_edge, through;  // the edge before (-1 at the start) and the face between
      int tip;                 // the edge's other end
    };
    std::map<int, Reached> reached;
    std::set<std::pair<double, int>> queue;
    auto reach = [&](int face, int tip, double turn, int from_edge) {
      const int edge = side_between(face, v, tip);
      const auto it = reached.find(edge);
      if (it != reached.end()) {
        if (it->second.turn <= turn) return;
        queue.erase({it->second.turn, edge});
      }
      reached[edge] = {turn, from_edge, face, tip};
      queue.insert({turn, edge});
    };
    for (int tip : mesh_.face(f_in))
      if (tip != v) reach(f_in, tip, angle(back, at(tip) - centre), -1);
    double best = pi - 1e-9;
    int best_edge = -1;
    while (!queue.empty()) {
      const auto [turn, edge] = *queue.begin();
      if (turn >= best) break;
      queue.erase(queue.begin());
      const int tip = reached[edge].tip;
      const Vec3 spoke = at(tip) - centre;
      for (int face : mesh_.edge_faces(edge)) {
        if (face == f_out && turn + angle(spoke, ahead) < best) {
          best = turn + angle(spoke, ahead);
          best_edge = edge;
        }
        if (!mesh_.has_distinct_corners(face)) continue;
        for (int other : mesh_.face(face))
          if (other != v && other != tip)
            reach(face, other, turn + angle(spoke, at(other) - centre), edge);
      }
    }
    if (best_edge < 0) return false;
    std::vector<int> edges;
    for (int e = best_edge; e >= 0; e = reached[e].from_edge) edges.push_back(e);
    std::reverse(edges.begin(), edges.end());
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const double t = mesh_.edges()(edges[k], 0) == v ? 0 : 1;
      out.nodes.push_back(SurfacePoint::on_edge(edges[k], t));
      out.faces.push_back(k + 1 < edges.size() ? reached[edges[k + 1]].through : f_out);
    }
    out.faces.pop_back();  // the caller adds the face after the last crossing
    return true;
  }

  const SurfaceMesh& mesh_;
  double scale_;
};

}  // namespace

double path_length(const SurfaceMesh& mesh, const SurfacePath& path, double scale) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < path.nodes.size(); ++i)
    length +=
        (scale * mesh.position(path.nodes[i + 1]) - scale * mesh.position(path.nodes[i])).norm();
  return length;
}

void straighten(const SurfaceMesh& mesh, SurfacePath& path, double scale, const Task& task) {
  const Straightener straightener(mesh, scale);
  simplify(mesh, path);
  double length = path_length(mesh, path, scale);
  for (int round = 0; round < most_rounds; ++round) {
    task.checkpoint();
    SurfacePath shorter = straightener.bypass_vertices(path);
    simplify(mesh, shorter);
    straightener.pull_tight(shorter);
    simplify(mesh, shorter);
    const double now = path_length(mesh, shorter, scale);
    if (now < length || (now <= length && shorter.nodes.size() < path.nodes.size()))
      path = std::move(shorter);
    if (!(now < (1 - 1e-12) * length)) break;
    length = now;
  }
}

}  // namespace littoral
