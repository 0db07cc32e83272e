#include "api/space/left_out.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "api/space/input_queries.h"

namespace littoral {

namespace {

/// The middles of parts of a triangle that are no longer than `side`, 256 of them at most.
MatX3 spread_in(const Vec3& a, const Vec3& b, const Vec3& c, double side) {
  const double longest =
      std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
  const int n = static_cast<int>(std::clamp(std::ceil(longest / side), 1.0, 16.0));
  MatX3 out(n * n, 3);
  Eigen::Index at = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j)
      for (int turned = 0; turned < (i + j + 1 < n ? 2 : 1); ++turned) {
        const double u = (i + (1 + turned) / 3.0) / n, v = (j + (1 + turned) / 3.0) / n;
        out.row(at++) = (a + u * (b - a) + v * (c - a)).transpose();
      }
  return out;
}

}  // namespace

bool is_inside(const Volume& distance, const Vec3& x) {
  const Vec3 at = (x - distance.grid.origin).cwiseQuotient(distance.grid.spacing);
  const Vec3 last =
      Eigen::Map<const Eigen::Vector3i>(distance.grid.n.data()).cast<double>().array() - 1;
  return interpolate(distance, at.cwiseMax(0).cwiseMin(last)) < 0;
}

PolygonSoup left_out(const PolygonSoup& triangles, const PolygonSoup& surface,
                     const Volume& distance, double far, Task task) {
  const double side = 2 * distance.grid.spacing.maxCoeff();
  std::vector<MatX3> spread;
  Eigen::Index n = 0;
  for (int f = 0; f < triangles.n_faces(); ++f) {
    const auto corner = [&](int k) { return Vec3(triangles.points.row(triangles.face(f)[k])); };
    n += spread.emplace_back(spread_in(corner(0), corner(1), corner(2), side)).rows();
  }
  MatX3 points(n, 3);
  Eigen::Index at = 0;
  for (const MatX3& each : spread) {
    points.middleRows(at, each.rows()) = each;
    at += each.rows();
  }
  const VecX to_surface = NearestOnInput(surface).at(points, task).distances;
  PolygonSoup out;
  out.points = triangles.points;
  at = 0;
  for (int f = 0; f < triangles.n_faces(); ++f) {
    const Eigen::Index end = at + spread[f].rows();
    bool is_out = false;
    for (; at < end; ++at)
      is_out = is_out || (to_surface[at] > far && !is_inside(distance, points.row(at)));
    if (is_out) out.add_face(triangles.face(f));
  }
  return out;
}

}  // namespace littoral
