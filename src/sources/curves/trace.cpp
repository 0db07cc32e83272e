#include "sources/curves/trace.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <string>
#include <unordered_map>

#include "littoral/error.h"
#include "sources/curves/straighten.h"

namespace littoral {

namespace {

/// Shortest path over the vertices and `per_edge` evenly spaced points of every edge, all nodes of
/// a face being joined by straight lines. Nodes come into being when they are reached.
class Search {
 public:
  Search(const SurfaceMesh& mesh, double scale, SurfacePoint from, SurfacePoint to)
      : mesh_(mesh),
        scale_(scale),
        from_(from),
        to_(to),
        target_(place(to)),
        per_edge_(mesh.n_faces() > 200000 ? 1 : 3) {
    for (int f : faces_at(mesh, to)) last_face_.emplace(f, 0);
  }

  SurfacePath run(const Task& task) {
    open_faces(source, from_, 0);
    for (std::int64_t popped = 0; !queue_.empty(); ++popped) {
      if (popped % 1024 == 0) task.checkpoint();
      const Entry entry = queue_.top();
      queue_.pop();
      if (entry.key == goal) return path();
      const double distance = reached_.at(entry.key).distance;
      if (entry.distance > distance) continue;  // a shorter way was found since
      open_faces(entry.key, node(entry.key), distance);
    }
    return {};
  }

 private:
  using Key = std::int64_t;  // vertex v: v; point j of edge e: vertices + e * per_edge + j
  static constexpr Key source = -1, goal = -2;
  struct Reached {
    double distance;
    Key before;
    int face;  // on the way from `before`
  };
  struct Entry {
    double estimate, distance;
    Key key;
    bool operator<(const Entry& other) const {  // the queue's top is the largest
      if (estimate != other.estimate) return estimate > other.estimate;
      return key > other.key;
    }
  };

  Vec3 place(const SurfacePoint& p) const { return scale_ * mesh_.position(p); }

  SurfacePoint node(Key key) const {
    if (key == source) return from_;
    if (key == goal) return to_;
    if (key < mesh_.n_vertices()) return SurfacePoint::at_vertex(key);
    const Key k = key - mesh_.n_vertices();
    return SurfacePoint::on_edge(k / per_edge_,
                                 static_cast<double>(k % per_edge_ + 1) / (per_edge_ + 1));
  }

  void reach(Key key, const Vec3& position, const Vec3& from, double distance, Key before,
             int face) {
    distance += (position - from).norm();
    const auto [it, added] = reached_.try_emplace(key, Reached{distance, before, face});
    if (!added) {
      if (!(distance < it->second.distance)) return;
      it->second = {distance, before, face};
    }
    queue_.push({distance + (target_ - position).norm(), distance, key});
  }

  void open_faces(Key key, const SurfacePoint& p, double distance) {
    const Vec3 position = place(p);
    for (int f : faces_at(mesh_, p)) {
      if (last_face_.count(f)) reach(goal, target_, position, distance, key, f);
      const auto corners = mesh_.face(f);
      for (int k = 0; k < 3; ++k) {
        const int v = corners[k];
        if (v != key) reach(v, scale_ * mesh_.point(v), position, distance, key, f);
        if (v == corners[(k + 1) % 3]) continue;  // an edge without length
        const Key first = mesh_.n_vertices() + Key{mesh_.side_edge(f, k)} * per_edge_;
        for (int j = 0; j < per_edge_; ++j)
          if (first + j != key)
            reach(first + j, place(node(first + j)), position, distance, key, f);
      }
    }
  }

  SurfacePath path() const {
    SurfacePath path;
    for (Key key = goal; key != source;) {
      const Reached& r = reached_.at(key);
      path.nodes.push_back(node(key));
      path.faces.push_back(r.face);
      key = r.before;
    }
    path.nodes.push_back(from_);
    std::reverse(path.nodes.begin(), path.nodes.end());
    std::reverse(path.faces.begin(), path.faces.end());
    return path;
  }

  const SurfaceMesh& mesh_;
  double scale_;
  SurfacePoint from_, to_;
  Vec3 target_;
  int per_edge_;
  std::unordered_map<int, char> last_face_;  // faces that contain the target
  std::unordered_map<Key, Reached> reached_;
  std::priority_queue<Entry> queue_;
};

}  // namespace

Tracer::Tracer(const SurfaceMesh& mesh) : mesh_(mesh) {
  if (!mesh.is_triangle_mesh())
    throw UnsupportedError(
        "tracing curves needs a triangle mesh; this mesh has faces with more corners (triangulate "
        "it "
        "first)");
  scale_ = std::clamp(1 / mesh.scale(), std::ldexp(1.0, -1000), std::ldexp(1.0, 1000));
}

int Tracer::component(const SurfacePoint& p) const {
  const int v = p.on == SurfacePoint::On::vertex ? p.element
                : p.on == SurfacePoint::On::edge ? mesh_.edges()(p.element, 0)
                                                 : mesh_.face(p.element)[0];
  return mesh_.vertex_component()[v];
}

std::vector<SurfacePoint> Tracer::trace(const SurfacePoint& from, const SurfacePoint& to,
                                        const Task& task) const {
  const SurfacePoint a = simplest(mesh_, from), b = simplest(mesh_, to);
  if (share_face(mesh_, a, b)) return {a, b};
  const int in_a = component(a), in_b = component(b);
  if (in_a != in_b)
    throw InputError("no path over the mesh joins " + element_name(a) + " (component " +
                         std::to_string(in_a) + ") and " + element_name(b) + " (component " +
                         std::to_string(in_b) + ")",
                     "no-path");
  SurfacePath path = Search(mesh_, scale_, a, b).run(task);
  straighten(mesh_, path, scale_, task);
  return path.nodes;
}

std::vector<SurfacePoint> trace(const SurfaceMesh& mesh, const SurfacePoint& from,
                                const SurfacePoint& to, const Task& task) {
  return Tracer(mesh).trace(from, to, task);
}

}  // namespace littoral
