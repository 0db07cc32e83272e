#include "api/space/left_out.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "api/space/input_queries.h"

namespace littoral {

namespace {

/// Parts of a side so that none is longer than `length`, 16 at most.
int parts_of_side(const std::array<Vec3, 3>& t, double length) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, (t[(k + 1) % 3] - t[k]).norm());
  return static_cast<int>(std::clamp(std::ceil(longest / length), 1.0, 16.0));
}

/// The middles of the n^2 parts of a triangle whose sides are divided in n.
void set_middles(const std::array<Vec3, 3>& t, int n, Eigen::Ref<MatX3> out) {
  Eigen::Index at = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j)
      for (int turned = 0; turned < (i + j + 1 < n ? 2 : 1); ++turned) {
        const double u = (i + (1 + turned) / 3.0) / n, v = (j + (1 + turned) / 3.0) / n;
        out.row(at++) = (t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0])).transpose();
      }
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
  const auto corners = [&](int f) {
    const auto c = triangles.face(f);
    return std::array<Vec3, 3>{triangles.points.row(c[0]), triangles.points.row(c[1]),
                               triangles.points.row(c[2])};
  };
  std::vector<Eigen::Index> begin{0};  // the places of each triangle
  for (int f = 0; f < triangles.n_faces(); ++f) {
    const int n = parts_of_side(corners(f), side);
    begin.push_back(begin.back() + n * n);
  }
  MatX3 points(begin.back(), 3);
  for (int f = 0; f < triangles.n_faces(); ++f) {
    const std::array<Vec3, 3> t = corners(f);
    set_middles(t, parts_of_side(t, side), points.middleRows(begin[f], begin[f + 1] - begin[f]));
  }
  const VecX to_surface = NearestOnInput(surface).at(points, task).distances;
  PolygonSoup out;
  out.points = triangles.points;
  for (int f = 0; f < triangles.n_faces(); ++f) {
    bool is_out = false;
    for (Eigen::Index at = begin[f]; at < begin[f + 1] && !is_out; ++at)
      is_out = to_surface[at] > far && !is_inside(distance, points.row(at));
    if (is_out) out.add_face(triangles.face(f));
  }
  return out;
}

}  // namespace littoral
