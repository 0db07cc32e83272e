#include "api/space/surface_difference.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "api/space/frame.h"
#include "api/space/input_queries.h"
#include "api/space/space_input.h"
#include "base/index.h"
#include "littoral/error.h"
#include "spatial/triangulate.h"

namespace littoral {

// The i-th lies where the area summed up reaches (i + 1/2) / n of the whole, and within its
// triangle by the R2 sequence (Roberts 2018).
MatX3 spread_over(const PolygonSoup& surface, int n) {
  const PolygonSoup triangles = triangulate(surface);
  std::vector<double> sum(1, 0.0);
  const auto corner = [&](int f, int k) -> Vec3 {
    return triangles.points.row(triangles.face(f)[k]);
  };
  const double unit =
      Frame(bounding_box(triangles)).unit;  // areas in squared lengths could overflow or vanish
  for (int f = 0; f < triangles.n_faces(); ++f) {
    const Vec3 u = (corner(f, 1) - corner(f, 0)) / unit, v = (corner(f, 2) - corner(f, 0)) / unit;
    sum.push_back(sum.back() + u.cross(v).norm() / 2);
  }
  if (!(sum.back() > 0)) throw InputError("the surface has no area", "empty-input");
  constexpr double first_step = 0.7548776662466927, second_step = 0.5698402909980532;
  MatX3 points(n, 3);
  int f = 0;
  for (int i = 0; i < n; ++i) {
    const double reached = (i + 0.5) / n * sum.back();
    while (f + 1 < triangles.n_faces() && sum[std::size_t(f) + 1] <= reached) ++f;
    double u = std::fmod(0.5 + first_step * (i + 1), 1),
           v = std::fmod(0.5 + second_step * (i + 1), 1);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    points.row(i) = (1 - u - v) * corner(f, 0) + u * corner(f, 1) + v * corner(f, 2);
  }
  return points;
}

OneSidedDistance one_sided_distance(const PolygonSoup& from, const PolygonSoup& to, int samples,
                                    Task task) {
  const NearestOnInput nearest(to), own(from);  // the second complains about bad input
  OneSidedDistance out;
  out.at_vertices = nearest.at(from.points, task.stage(0.5, "distance at vertices")).distances;
  VecX distances = out.at_vertices;
  if (from.n_faces() > 0)
    distances = nearest.at(spread_over(from, samples), task.stage(0.5, "distance")).distances;
  const auto n = static_cast<double>(distances.size());
  out.mean = distances.sum() / n;
  out.rms = distances.stableNorm() / std::sqrt(n);
  std::sort(distances.begin(), distances.end());
  const auto quantile = [&](double share) { return distances[index(std::floor(share * (n - 1)))]; };
  out.median = quantile(0.5);
  out.p95 = quantile(0.95);
  out.p99 = quantile(0.99);
  out.largest = std::max(distances[distances.size() - 1], out.at_vertices.maxCoeff());
  return out;
}

}  // namespace littoral
