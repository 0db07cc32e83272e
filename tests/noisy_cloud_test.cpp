// What noisy clouds measure: the triangles between their points, or the points themselves.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "contour/isosurface.h"
#include "methods/implicit/completed_cloud.h"
#include "space_helpers.h"
#include "spatial/grid_values.h"
#include "spatial/point_tree.h"
#include "spatial/triangle_bvh.h"
#include "spatial/triangulate.h"

namespace littoral {
namespace {

TEST(NoisyClouds, MeasureTrianglesWhereNoPointIsClearlyNearer) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  OrientedPoints cloud;
  cloud.points.resize(4000, 3);
  cloud.normals.resize(4000, 3);
  for (int i = 0; i < 4000; ++i) {
    const Vec3 x = Vec3(normal(random), normal(random), normal(random)).normalized();
    cloud.normals.row(i) = x;
    cloud.points.row(i) = x * (1 + 0.1 * normal(random));
  }
  const Grid grid = test::cube_grid(33, 1.5);
  const double spacing = grid.spacing[0];
  Report report;
  auto fitted = std::make_unique<const ToriDistance>(cloud, TorusFit{}, Task(), report);
  const ToriDistance& tori = *fitted;
  // The zero set of the tori, by hand.
  const VecX values = grid_values(grid, {}, [&](const Vec3& x, int&) { return tori.value(x); });
  const PolygonSoup zero = isosurface(grid, values, 0, {}, report);
  const TriangleBvh triangles(zero.points, triangles_of(zero));
  MatX3 normals(cloud.size(), 3);
  for (Eigen::Index i = 0; i < cloud.size(); ++i) normals.row(i) = tori.tori()[i].n;
  const PointTree points(tori.points());
  const double clearly = 4 * cloud_noise(tori.points(), normals, points);
  EXPECT_GT(clearly, 1.5 * spacing);
  const CompletedCloud completed(std::move(fitted), grid, {}, report);
  int of_triangles = 0, of_points = 0, would_be_wrong = 0;  // by the tori
  const double half = 0.5 * spacing;  // that triangles are off the zero set at most
  const MatX3 places = test::random_points(4000, 1.4);
  for (const auto& row : places.rowwise()) {
    const Vec3 x = row;
    const double value = std::abs(completed.value(x)), by_tori = std::abs(tori.value(x));
    const double measured = triangles.closest_point(x).distance;
    const double nearest = std::sqrt(points.nearest(x).squared_distance);
    if (measured < spacing) continue;
    if (nearest > measured - clearly + half) {
      ++of_triangles;
      would_be_wrong += by_tori < measured - half;
      EXPECT_GE(value, measured - half) << row;
    } else if (nearest < measured - clearly - half) {
      ++of_points;
      EXPECT_EQ(value, by_tori) << row;
    }
  }
  EXPECT_GT(of_triangles, 100);
  EXPECT_GT(of_points, 5);
  EXPECT_GT(would_be_wrong, 20);
}

}  // namespace
}  // namespace littoral
