#include "spatial/covered_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "brute_force.h"
#include "spatial/triangulate.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using CornersOfAll = std::vector<std::array<Vec3, 3>>;

const std::array<Vec3, 3> spread{Vec3(0.1, 0.2, 0.3), Vec3(0.8, 0.4, -0.2), Vec3(0.5, -0.7, 0.9)};

Vec3 along_spread(double t) { return spread[0] + t * (spread[1] - spread[0]); }

int n_uncovered(const CornersOfAll& corners) {
  const std::vector<bool> covered = covered_triangles(corners);
  return static_cast<int>(std::count(covered.begin(), covered.end(), false));
}

TEST(CoveredTriangles, OfCopiesTheFirstStays) {
  const auto& [a, b, c] = spread;
  const Vec3 zero(0, 1, 0), other_zero(-0.0, 1, 0);
  EXPECT_EQ(covered_triangles({{a, b, c}, {b, c, a}, {a, c, b}, {a, b, zero}, {b, other_zero, a}}),
            (std::vector<bool>{false, true, true, false, true}));
  // On one plane, within one another: not copies.
  EXPECT_EQ(n_uncovered({{a, b, c}, {a, b, (a + c) / 2}}), 2);
}

TEST(CoveredTriangles, WithoutAreaTheyAreCoveredBySidesAndCorners) {
  const auto& [a, b, c] = spread;
  EXPECT_EQ(covered_triangles(
                {{a, a, b},                                                  // a side of the last
                 {along_spread(0.3), along_spread(0.5), along_spread(0.1)},  // within that side
                 {along_spread(0.3), along_spread(0.5), along_spread(1.0001)},  // reaches beyond it
                 {c, c, c},  // a corner of the last
                 {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()},
                 {a, b, c}}),
            (std::vector<bool>{true, true, false, true, false, false}));
}

TEST(CoveredTriangles, TheLongestOfManyOnOneLineStays) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  CornersOfAll corners, points(500, {spread[0], spread[0], spread[0]});
  for (int i = 0; i < 2000; ++i)
    corners.push_back({along_spread(u(random)), along_spread(u(random)), along_spread(u(random))});
  EXPECT_LT(n_uncovered(corners), 40);  // none of these is within another one
  EXPECT_EQ(n_uncovered(points), 1);
  corners.push_back({spread[0], spread[2], spread[1]});
  EXPECT_EQ(n_uncovered(corners), 1);
}

TEST(CoveredTriangles, NoPointIsLost) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> digit(-2, 2);
  std::uniform_real_distribution<double> u(0, 1);
  for (int round = 0; round < 30; ++round) {
    // CornersOfAll of a coarse lattice, a third of the triangles with corners between these.
    const int n = 120;
    MatX3 points(3 * n, 3);
    CornersOfAll corners(n);
    for (int f = 0; f < n; ++f) {
      for (Vec3& p : corners[f]) p = Vec3(digit(random), digit(random), digit(random) / 2) * 0.7;
      if (f % 3 == 0) corners[f][2] = corners[f][0] + u(random) * (corners[f][1] - corners[f][0]);
      for (int k = 0; k < 3; ++k) points.row(3 * f + k) = corners[f][k];
    }
    const std::vector<bool> covered = covered_triangles(corners);
    MatX3i left(std::count(covered.begin(), covered.end(), false), 3);
    for (int f = 0, row = 0; f < n; ++f)
      if (!covered[f]) left.row(row++) << 3 * f, 3 * f + 1, 3 * f + 2;
    EXPECT_LT(left.rows(), n);
    for (int f = 0; f < n; ++f)
      for (int i = 0; i < 10; ++i) {
        const double s = u(random), t = u(random) * (1 - s);
        const Vec3 x = corners[f][0] + s * (corners[f][1] - corners[f][0]) +
                       t * (corners[f][2] - corners[f][0]);
        if (covered[f]) {
          EXPECT_LE(closest_point_brute_force(points, left, x).distance, 4e-15);
        }
      }
  }
}

TEST(CoveredTriangles, OfAMeshAllStay) {
  const PolygonSoup torus = test::torus_soup(60, 30, 0.7, 0.3);
  CornersOfAll corners;
  const MatX3i faces = triangles_of(triangulate(torus));
  for (int f = 0; f < faces.rows(); ++f)
    corners.push_back({torus.points.row(faces(f, 0)), torus.points.row(faces(f, 1)),
                       torus.points.row(faces(f, 2))});
  EXPECT_EQ(n_uncovered(corners), static_cast<int>(corners.size()));
}

}  // namespace
}  // namespace littoral
