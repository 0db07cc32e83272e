// Polygons of any number of corners cut into triangles that lie within them.

#include "spatial/triangulate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

namespace littoral {
namespace {

/// Seen whole from its middle, with corners at random distances from there.
PolygonSoup star(int n, std::mt19937& random) {
  std::uniform_real_distribution<double> radius(0.5, 1);
  PolygonSoup soup;
  soup.points.resize(n, 3);
  std::vector<int> corners;
  for (int v = 0; v < n; ++v) {
    const double angle = 2 * std::numbers::pi * v / n;
    soup.points.row(v) = radius(random) * Vec3(std::cos(angle), std::sin(angle), 0);
    corners.push_back(v);
  }
  soup.add_face(corners);
  return soup;
}

double area_of(const PolygonSoup& soup) {
  Vec3 sum = Vec3::Zero();
  for (int v = 0; v < soup.n_vertices(); ++v) {
    const Vec3 a = soup.points.row(v), b = soup.points.row((v + 1) % soup.n_vertices());
    sum += a.cross(b) / 2;
  }
  return sum.norm();
}

void expect_filled(const PolygonSoup& polygon) {
  const MatX3i triangles = triangles_of(triangulate(polygon));
  ASSERT_EQ(triangles.rows(), polygon.n_vertices() - 2);
  double sum = 0;  // larger than the polygon where they overlap or lie outside
  for (const auto& t : triangles.rowwise()) {
    const Vec3 a = polygon.points.row(t[0]), b = polygon.points.row(t[1]),
               c = polygon.points.row(t[2]);
    sum += (b - a).cross(c - a).norm() / 2;
  }
  EXPECT_NEAR(sum, area_of(polygon), 1e-9);
}

TEST(Triangulate, FillsPolygonsOfAnyNumberOfCorners) {
  std::mt19937 random(5);
  for (const int n : {4, 5, 30, 63, 64, 65, 66, 100, 300, 1000})
    for (int trial = 0; trial < 10; ++trial) expect_filled(star(n, random));
}

TEST(Triangulate, FillsPolygonsOfManyCorners) {
  std::mt19937 random(6);
  expect_filled(star(30000, random));
}

}  // namespace
}  // namespace littoral
