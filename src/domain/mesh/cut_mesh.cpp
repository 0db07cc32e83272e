#include "domain/mesh/cut_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/triangle.h"
#include "domain/mesh/cut_face.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr double same = 1e-9;  // of a side's length

class Cutter {
 public:
  Cutter(const SurfaceMesh& mesh, const std::vector<CutSegment>& segments)
      : mesh_(mesh), segments_(segments), next_vertex_(mesh.n_vertices()) {
    for (int v = 0; v < mesh.n_vertices(); ++v) point_.push_back(SurfacePoint::at_vertex(v));
    gather_edge_points();
  }

  CutMesh run() {
    std::map<int, std::vector<int>> in_face;
    std::vector<char> touched(mesh_.n_faces(), 0);
    path_.resize(segments_.size());
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      const int along = common_side(segments_[i]);
      if (along >= 0)
        path_[i] = path_on_side(segments_[i], along);
      else
        in_face[segments_[i].face].push_back(i);
    }
    for (const auto& [e, points] : on_edge_)
      for (int f : mesh_.edge_faces(e)) touched[f] = 1;
    for (const auto& [f, list] : in_face) touched[f] = 1;
    PolygonSoup soup;
    for (int f = 0; f < mesh_.n_faces(); ++f) {
      if (touched[f]) {
        cut_face(f, in_face[f], soup);
      } else {
        soup.add_face(mesh_.face(f));
        parent_.push_back(f);
      }
    }
    soup.points.resize(point_.size(), 3);
    for (std::size_t v = 0; v < point_.size(); ++v) soup.points.row(v) = mesh_.position(point_[v]);
    return {SurfaceMesh(std::move(soup)), std::move(parent_), std::move(point_), std::move(path_)};
  }

 private:
  /// Where on side k a point of face f lies, measured along the side; none if it does not.
  static bool on_side(const std::array<double, 3>& b, int k) { return b[(k + 2) % 3] == 0; }
  static int common_side(const CutSegment& s) {
    for (int k = 0; k < 3; ++k)
      if (on_side(s.a, k) && on_side(s.b, k)) return k;
    return -1;
  }

  /// The parameter along the edge (tail to head) of a point on side k of face f.
  double edge_parameter(int f, int k, const std::array<double, 3>& b) const {
    const double t = b[(k + 1) % 3] / (b[k] + b[(k + 1) % 3]);
    return mesh_.side_along(f, k) ? t : 1 - t;
  }

  void gather_edge_points() {
    std::map<int, std::vector<double>> found;
    for (const CutSegment& s : segments_)
      for (const auto& b : {s.a, s.b})
        for (int k = 0; k < 3; ++k)
          if (on_side(b, k))
            found[mesh_.side_edge(s.face, k)].push_back(edge_parameter(s.face, k, b));
    for (auto& [e, ts] : found) {
      std::sort(ts.begin(), ts.end());
      std::vector<std::pair<double, int>> list;
      for (double t : ts) {
        if (t < same || t > 1 - same) continue;  // at a vertex
        if (!list.empty() && t - list.back().first < same) continue;
        point_.push_back(SurfacePoint::on_edge(e, t));
        list.emplace_back(t, next_vertex_++);
      }
      if (!list.empty()) on_edge_[e] = std::move(list);
    }
  }

  /// The vertex at a point on side k of face f.
  int vertex_on_side(int f, int k, const std::array<double, 3>& b) const {
    const int e = mesh_.side_edge(f, k);
    const double t = edge_parameter(f, k, b);
    if (t < same) return mesh_.edges()(e, 0);
    if (t > 1 - same) return mesh_.edges()(e, 1);
    const auto& list = on_edge_.at(e);
    const auto nearest = std::min_element(list.begin(), list.end(), [&](auto& x, auto& y) {
      return std::abs(x.first - t) < std::abs(y.first - t);
    });
    return nearest->second;
  }

  std::vector<int> path_on_side(const CutSegment& s, int k) const {
    const int e = mesh_.side_edge(s.face, k);
    std::vector<int> all{mesh_.edges()(e, 0)};
    if (const auto it = on_edge_.find(e); it != on_edge_.end())
      for (const auto& [t, v] : it->second) all.push_back(v);
    all.push_back(mesh_.edges()(e, 1));
    const auto at = [&](const std::array<double, 3>& b) {
      return std::find(all.begin(), all.end(), vertex_on_side(s.face, k, b)) - all.begin();
    };
    const auto from = at(s.a), to = at(s.b);
    std::vector<int> path(all.begin() + std::min(from, to), all.begin() + std::max(from, to) + 1);
    if (from > to) std::reverse(path.begin(), path.end());
    return path;
  }

  void cut_face(int f, const std::vector<int>& segments, PolygonSoup& soup) {
    const auto corners = mesh_.face(f);
    std::array<double, 3> length;
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      length[k] = (mesh_.point(corners[(k + 1) % 3]) - mesh_.point(corners[k])).stableNorm();
      longest = std::max(longest, length[k]);
    }
    // Laid out in the plane at size 1; faces without area as a regular one: only order matters.
    double slack = 2 * longest;
    for (double l : length) slack = std::min(slack, length[0] + length[1] + length[2] - 2 * l);
    if (!(slack > 1e-10 * longest)) length = {1, 1, 1}, longest = 1;
    const TriangleShape shape =
        triangle_shape(length[0] / longest, length[1] / longest, length[2] / longest, false);
    std::array<Vec2, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = {shape.p[k].real(), shape.p[k].imag()};
    FaceTriangulation local(p[0], p[1], p[2]);
    std::vector<int> global{corners[0], corners[1], corners[2]};
    for (int k = 0; k < 3; ++k) {
      const auto it = on_edge_.find(mesh_.side_edge(f, k));
      if (it == on_edge_.end()) continue;
      auto list = it->second;
      if (!mesh_.side_along(f, k)) std::reverse(list.begin(), list.end());
      int last = k;
      for (const auto& [t, v] : list) {
        const double s = mesh_.side_along(f, k) ? t : 1 - t;
        last = local.split_side(last, (k + 1) % 3, (1 - s) * p[k] + s * p[(k + 1) % 3]);
        global.push_back(v);
      }
    }
    const auto place = [&](const std::array<double, 3>& b) {
      for (int k = 0; k < 3; ++k)
        if (on_side(b, k)) {
          const int v = vertex_on_side(f, k, b);
          return static_cast<int>(std::find(global.begin(), global.end(), v) - global.begin());
        }
      return local.insert(b[0] * p[0] + b[1] * p[1] + b[2] * p[2], same);
    };
    std::vector<std::array<int, 2>> ends;
    for (int i : segments) ends.push_back({place(segments_[i].a), place(segments_[i].b)});
    for (std::size_t i = 0; i < ends.size(); ++i) local.connect(ends[i][0], ends[i][1], i);
    for (std::size_t v = global.size(); v < local.points().size(); ++v) {
      point_.push_back(point_in(f, shape, local.points()[v]));
      global.push_back(next_vertex_++);
    }
    for (const auto& t : local.triangles()) {
      const int face[3] = {global[t[0]], global[t[1]], global[t[2]]};
      soup.add_face(face);
      parent_.push_back(f);
    }
    for (std::size_t i = 0; i < ends.size(); ++i)
      for (int v : local.path(i)) path_[segments[i]].push_back(global[v]);
  }

  static SurfacePoint point_in(int f, const TriangleShape& shape, const Vec2& x) {
    const double y2 = shape.p[2].imag(), x1 = shape.p[1].real(), x2 = shape.p[2].real();
    const double c = std::clamp(x.y() / y2, 0.0, 1.0);
    const double b = std::clamp((x.x() - c * x2) / x1, 0.0, 1.0 - c);
    return SurfacePoint::in_face(f, 1 - b - c, b, c);
  }

  const SurfaceMesh& mesh_;
  const std::vector<CutSegment>& segments_;
  std::map<int, std::vector<std::pair<double, int>>> on_edge_;  // parameter, vertex; ascending
  int next_vertex_;
  std::vector<SurfacePoint> point_;
  std::vector<int> parent_;
  std::vector<std::vector<int>> path_;
};

}  // namespace

CutMesh cut_mesh(const SurfaceMesh& mesh, const std::vector<CutSegment>& segments) {
  if (!mesh.is_triangle_mesh())
    throw UnsupportedError("cutting along curves needs a triangle mesh; triangulate it first");
  return Cutter(mesh, segments).run();
}

}  // namespace littoral
