#include "api/surface/surface_advice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "api/space/frame.h"
#include "api/space/space_input.h"
#include "api/space/surface_difference.h"
#include "base/index.h"
#include "base/option_table.h"
#include "base/parallel.h"
#include "spatial/triangle_bvh.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

constexpr int most_balls = 60;
constexpr double shrinks = 0.999;     // of the radius: less is the same ball
constexpr double needle_angle = 5;    // [degrees]
constexpr double own_surface = 1e-9;  // of the largest ball: a point as near as that is x itself

double signed_volume(const MatX3& points, const MatX3i& faces, const Vec3& origin) {
  double six_volumes = 0;
  for (const auto& face : faces.rowwise()) {
    const Vec3 a = points.row(face[0]).transpose() - origin,
               b = points.row(face[1]).transpose() - origin,
               c = points.row(face[2]).transpose() - origin;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6;
}

/// 0 where the ball shrinks to nothing.
double ball_diameter(const TriangleBvh& surface, const Vec3& x, const Vec3& inward, double most) {
  double radius = most;
  for (int i = 0; i < most_balls; ++i) {
    const Vec3 centre = x + radius * inward;
    const NearestPoint near = surface.closest_point(centre);
    if (near.distance >= shrinks * radius) return 2 * radius;
    const Vec3 chord = near.point - x;
    const double along = chord.dot(inward), length2 = chord.squaredNorm();
    if (!(along > 0) || !(length2 > own_surface * own_surface * most * most)) return 0;
    radius = std::min(length2 / (2 * along), shrinks * radius);
  }
  return 2 * radius;
}

}  // namespace

std::vector<double> inner_ball_diameters(const PolygonSoup& triangles, int samples) {
  const MatX3i faces = triangles_of(triangles);
  const double unit =
      Frame(bounding_box(triangles)).unit;  // squares of lengths could overflow or vanish
  const MatX3 points = triangles.points / unit;
  const TriangleBvh surface(points, faces);
  const MatX3 at = spread_over(triangles, samples) / unit;
  const Vec3 low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const double most = (high - low).norm() / 2;
  const double inside = signed_volume(points, faces, (low + high) / 2) < 0 ? 1 : -1;
  std::vector<double> found(std::size_t(at.rows()), 0);
  parallel_for(found.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const NearestPoint here = surface.closest_point(at.row(index(i)));
      const Vec3 a = points.row(faces(here.face, 0)), b = points.row(faces(here.face, 1)),
                 c = points.row(faces(here.face, 2));
      const Vec3 normal = (b - a).cross(c - a).stableNormalized();
      found[i] = ball_diameter(surface, here.point, inside * normal, most);
    }
  });
  std::erase_if(found, [](double diameter) { return !(diameter > 0); });
  std::sort(found.begin(), found.end());
  for (double& diameter : found) diameter *= unit;
  return found;
}

std::string guess_unit(double longest_side) {
  if (!(longest_side > 0)) return "none";
  if (longest_side < 0.02) return "metres, of a small object";
  if (longest_side < 5) return "metres, or scaled to about 1";
  if (longest_side < 5000) return "millimetres";
  return "unclear";
}

std::string recommendation_for(const SurfaceTraits& traits) {
  if (!traits.has_faces)
    return traits.has_normals
               ? "sdf, query: auto, or tori for values at points; points have normals. distance: "
                 "auto runs on the cloud"
               : "sdf, query: auto with option estimate-normals; points have no normals. "
                 "distance: auto "
                 "runs on the cloud";
  std::vector<std::string> reasons;
  if (traits.boundary_loops > 0)
    reasons.push_back(number_text(traits.boundary_loops) + " boundary loops");
  if (traits.nonmanifold_edges > 0)
    reasons.push_back(number_text(traits.nonmanifold_edges) + " nonmanifold edges");
  if (traits.turned > 0) reasons.push_back(number_text(traits.turned) + " triangles turned");
  if (traits.crossing > 0) reasons.push_back(number_text(traits.crossing) + " triangles crossing");
  if (!traits.orientable) reasons.emplace_back("not orientable");
  std::string text =
      traits.watertight
          ? "sdf, query: auto, which is exact here; the surface is watertight"
          : "sdf, query: auto, which completes and orients it; read the warnings. repair makes it "
            "watertight (" +
                (reasons.empty() ? std::string("not watertight") : listed(reasons)) + ")";
  text += ". distance: auto";
  if (traits.only_triangles && traits.smallest_angle < needle_angle)
    text += ", or signed-heat with option intrinsic-delaunay; the smallest angle is " +
            rounded_text(traits.smallest_angle) + " degrees";
  if (!traits.only_triangles)
    text += "; quadratic and regularized need triangles (option triangulate)";
  if (traits.nonmanifold_edges > 0) text += ". winding: the dual one of option formulation";
  return text;
}

}  // namespace littoral
