// Distances beside sources in space: to discs of samples, and to what of a surface lies in tets.
#include "sources/space/space_distances.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "test_meshes.h"

namespace littoral {
namespace {

TEST(NearestSource, SamplesWithoutTrianglesAreDiscsOfTheirArea) {
  OrientedPoints samples;
  samples.points.resize(2, 3);
  samples.points << 1, 2, 3, 5, 2, 3;
  samples.normals.resize(2, 3);
  samples.normals << 0, 0, 1, 0.6, 0, 0.8;
  samples.areas = Vec2(std::numbers::pi * 0.25, std::numbers::pi * 1.44);
  const NearestSource nearest(PolygonSoup(), samples);
  const auto expect = [&](const Vec3& x, const Vec3& q) {
    EXPECT_LT((nearest(x) - q).norm(), 1e-12) << x.transpose();
  };
  expect({1.2, 2.3, 4}, {1.2, 2.3, 3});  // above the first
  expect({1.2, 2.3, 1}, {1.2, 2.3, 3});  // below
  expect({1, 4, 3}, {1, 2.5, 3});        // beside it
  expect({0, 2, 2}, {0.5, 2, 3});
  expect({5 + 0.6, 2, 3 + 0.8}, {5, 2, 3});  // above the second
  expect({5, 8, 3}, {5, 3.2, 3});
  expect({5 + 0.8 * 3, 2, 3 - 0.6 * 3}, {5 + 0.8 * 1.2, 2, 3 - 0.6 * 1.2});
  // The nearest disc, not that of the nearest centre.
  expect({2.9, 2, 3.6}, {5 - 0.8 * 1.2, 2, 3 + 0.6 * 1.2});
}

/// What the plane x + z = 1.9 has in the unit cube lies between (0.9, y, 1) and (1, y, 0.9).
double to_the_part_in_the_cube(const Vec3& x) {
  const Eigen::Vector2d a(0.9, 1), b(1, 0.9), p(x[0], x[2]);
  const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0., 1.);
  return (p - a - s * (b - a)).norm();
}

TEST(DistancesAround, AreToWhatOfTheSurfaceLiesInTheTets) {
  const int n = 4;
  const TetMesh mesh = test::tet_box(n);
  const TetLocator locator(mesh);
  PolygonSoup plane;  // far beyond the cube
  plane.points.resize(4, 3);
  plane.points << -3, -3, 4.9, 4, -3, -2.1, 4, 5, -2.1, -3, 5, 4.9;
  plane.add_face(std::array{0, 1, 2});
  plane.add_face(std::array{0, 2, 3});
  OrientedPoints samples;
  std::vector<TetPoint> places;
  const int m = 12;
  samples.points.resize(m * m + 1, 3);
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      const double s = (i + 0.5) / m;
      samples.points.row(i * m + j) << 0.9 + 0.1 * s, (j + 0.5) / m, 1 - 0.1 * s;
    }
  samples.points.row(m * m) << 2, 0.5, -0.1;  // outside
  samples.normals = Vec3(1, 0, 1).normalized().transpose().replicate(m * m + 1, 1);
  samples.areas = VecX::Constant(m * m + 1, 0.1 * std::sqrt(2.0) / (m * m));
  for (int i = 0; i <= m * m; ++i) places.push_back(locator.locate(samples.points.row(i)));
  ASSERT_LT(places.back().tet, 0);
  std::vector<Eigen::Vector4d> corners;
  for (int k = 0; k < 4; ++k) corners.push_back(Eigen::Vector4d::Unit(k));
  std::size_t count[2];
  for (const Around around : {Around::alone, Around::with_neighbours}) {
    const auto at = distances_around(
        mesh, locator, plane, samples, places, corners,
        [&](int tet, int k) { return mesh.tets(tet, k); }, around);
    std::vector<char> wanted(static_cast<std::size_t>(mesh.n_vertices()), 0);
    std::vector<char> held = wanted;
    for (const TetPoint& place : places)
      if (place.tet >= 0)
        for (const int v : mesh.tets.row(place.tet)) held[v] = 1;
    for (int t = 0; t < mesh.n_tets(); ++t) {
      const auto v = mesh.tets.row(t);
      const bool touches = held[v[0]] || held[v[1]] || held[v[2]] || held[v[3]];
      for (const int w : v) wanted[w] |= touches;
    }
    if (around == Around::alone) wanted = held;
    int outside = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const Vec3 x = mesh.points.row(v);
      ASSERT_EQ(at.count(v), static_cast<std::size_t>(wanted[v])) << x.transpose();
      if (!wanted[v]) continue;
      EXPECT_NEAR(at.at(v).distance, to_the_part_in_the_cube(x), 1e-9) << x.transpose();
      outside += std::abs(1.9 - x[0] - x[2]) / std::sqrt(2.0) < to_the_part_in_the_cube(x) - 1e-3;
      EXPECT_EQ(mesh.tets(at.at(v).tet, 0) == v, at.at(v).b[0] == 1);
    }
    EXPECT_GE(outside, 5);
    count[around == Around::with_neighbours] = at.size();
  }
  EXPECT_LT(count[0], count[1]);
}

}  // namespace
}  // namespace littoral
