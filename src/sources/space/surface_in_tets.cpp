#include "sources/space/surface_in_tets.h"

#include <Eigen/Geometry>
#include <functional>
#include <set>
#include <utility>

#include "base/index.h"
#include "spatial/triangle_bvh.h"

namespace littoral {

namespace {

using Corners = std::vector<Vec3>;

/// The part of a polygon where a linear function, by its values at the corners, is not negative.
Corners clipped(const Corners& polygon, const std::function<double(const Vec3&)>& height) {
  Corners out;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double ha = height(a), hb = height(b);
    if (ha >= 0) out.push_back(a);
    if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) out.push_back(a + ha / (ha - hb) * (b - a));
  }
  return out;
}

}  // namespace

std::vector<Vec3> part_in_tet(const TetMesh& mesh, int t, const std::array<Vec3, 3>& triangle) {
  Corners polygon(triangle.begin(), triangle.end());
  for (int k = 0; k < 4 && !polygon.empty(); ++k) {
    const auto corner = [&](int i) { return Vec3(mesh.points.row(mesh.tets(t, (k + i) % 4))); };
    const Vec3 at = corner(1), normal = (corner(2) - at).cross(corner(3) - at);
    const double side = normal.dot(corner(0) - at) < 0 ? -1 : 1;
    polygon = clipped(polygon, [&](const Vec3& x) { return side * normal.dot(x - at); });
  }
  return polygon;
}

SurfaceInTets surface_in_tets(const TetMesh& mesh, const TetSight& sight, const MatX3& points,
                              const MatX3i& faces, const MatX3& samples,
                              const std::vector<TetPoint>& places) {
  std::set<std::pair<int, int>> seen;  // face, tet
  std::vector<std::pair<int, int>> open;
  const auto look = [&](int f, int t) {
    if (seen.emplace(f, t).second) open.emplace_back(f, t);
  };
  const TriangleBvh nearest(points, faces);
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].tet >= 0) look(nearest.closest_point(samples.row(i)).face, places[i].tet);
  std::vector<Vec3> corners;
  SurfaceInTets out;
  while (!open.empty()) {
    const auto [f, t] = open.back();
    open.pop_back();
    const Corners p = part_in_tet(
        mesh, t, {points.row(faces(f, 0)), points.row(faces(f, 1)), points.row(faces(f, 2))});
    for (std::size_t k = 1; k + 1 < p.size(); ++k) {
      corners.insert(corners.end(), {p[0], p[k], p[k + 1]});
      out.tet.push_back(t);
    }
    if (p.empty()) continue;
    for (int k = 0; k < 4; ++k)
      for (const int next : sight.tets_of_face(t, k)) look(f, next);
  }
  out.points.resize(index(corners.size()), 3);
  for (int v = 0; v < out.points.rows(); ++v) out.points.row(v) = corners[v];
  out.faces.resize(index(out.tet.size()), 3);
  for (int f = 0; f < out.faces.rows(); ++f) out.faces.row(f) << 3 * f, 3 * f + 1, 3 * f + 2;
  return out;
}

}  // namespace littoral
