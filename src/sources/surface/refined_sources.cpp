#include "sources/surface/refined_sources.h"

#include <algorithm>

#include "base/index.h"
#include "sources/surface/surface_points.h"
#include "spatial/closest_on_triangle.h"

namespace littoral {

namespace {

/// A point of the input on the refined mesh.
SurfacePoint refined_point(const SurfaceMesh& input, const SurfaceMesh& refined,
                           const std::vector<int>& face_offsets, const SurfacePoint& p) {
  check_element(input, p);
  if (p.on == SurfacePoint::On::vertex) return p;
  if (p.on == SurfacePoint::On::edge) {
    const int a = input.edges()(p.element, 0), b = input.edges()(p.element, 1);
    const int e = refined.find_edge(a, b);
    return SurfacePoint::on_edge(e, refined.edges()(e, 0) == a ? p.b[1] : p.b[0]);
  }
  const int first = face_offsets[p.element], last = face_offsets[p.element + 1];
  if (input.face(p.element).size() == 3)
    return SurfacePoint::in_face(first, p.b[0], p.b[1], p.b[2]);
  const Vec3 x = input.position(p);
  double size = 0;  // squares of lengths leave the range of numbers
  for (const int v : input.face(p.element))
    size = std::max(size, (input.point(v) - x).cwiseAbs().maxCoeff());
  if (!(size > 0)) size = 1;
  double nearest = infinity;
  SurfacePoint out;
  for (int f = first; f < last; ++f) {
    const auto c = refined.face(f);
    const auto seen = [&](int k) { return Vec3((refined.point(c[k]) - x) / size); };
    const TriangleFoot hit = closest_on_triangle(seen(0), seen(1), seen(2));
    if (!(hit.squared < nearest)) continue;
    nearest = hit.squared;
    out = SurfacePoint::in_face(f, hit.barycentric[0], hit.barycentric[1], hit.barycentric[2]);
  }
  return out;
}

}  // namespace

Sources refined_sources(const SurfaceMesh& input, const SurfaceMesh& refined,
                        const std::vector<int>& face_offsets, const Sources& sources) {
  Sources out = sources;
  if (face_offsets.empty()) return out;  // the input has nothing but nodes
  const auto move = [&](SurfacePoint& p) { p = refined_point(input, refined, face_offsets, p); };
  for (Curve& curve : out.curves)
    for (SurfacePoint& p : curve.nodes) move(p);
  for (SurfacePoint& p : out.points) move(p);
  return out;
}

}  // namespace littoral
