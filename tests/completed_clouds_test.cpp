// Clouds as they are without a method: completed over holes and measured through noise; and parts
// that grids do not hold.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "api/space/sdf.h"
#include "broken_shapes.h"
#include "report_helpers.h"
#include "space_helpers.h"

namespace littoral {
namespace {

using test::hemisphere;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// What nobody has chosen anything for.
VecX unasked(const PolygonSoup& input, const Grid& grid, Report& report) {
  return grid_distance(input, grid, {}, Task(), report);
}

VecX unasked_at(const PolygonSoup& input, const MatX3& queries, Report& report) {
  return query_distance(input, queries, {}, nullptr, Task(), report);
}

/// Points of the unit sphere at random, those above `top` cut off, with noise.
PolygonSoup sphere_cloud(int n, double top, double noise) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  PolygonSoup cloud;
  cloud.points.resize(n, 3);
  cloud.normals.resize(n, 3);
  for (int i = 0; i < n;) {
    const Vec3 x = Vec3(normal(random), normal(random), normal(random)).normalized();
    if (x[2] > top) continue;
    cloud.normals.row(i) = x;
    cloud.points.row(i++) = x * (1 + noise * normal(random));
  }
  return cloud;
}

/// Mean and largest error around the unit sphere, and the share of nodes with the wrong sign.
std::array<double, 3> errors_around_sphere(const Grid& grid, const VecX& values) {
  double sum = 0, worst = 0, wrong = 0;
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) {
        const double truth = grid.point(i, j, k).norm() - 1;
        const double value = values[static_cast<Eigen::Index>(grid.node(i, j, k))];
        sum += std::abs(value - truth);
        worst = std::max(worst, std::abs(value - truth));
        wrong += (value < 0) != (truth < 0);
      }
  const auto n = static_cast<double>(values.size());
  return {sum / n, worst, wrong / n};
}

TEST(CompletedClouds, AreClosedOverHolesAndMeasuredThroughNoise) {
  const Grid grid = test::cube_grid(13, 1.4);
  for (const auto& [top, noise, mean, largest] :
       {std::array{1.0, 0.0, 1e-3, 0.01}, {0.7, 0.0, 3e-3, 0.04}, {1.0, 0.02, 0.006, 0.04}}) {
    const PolygonSoup cloud = sphere_cloud(1000, top, noise);
    Report report, at_points;
    const auto [on_average, worst, wrong] =
        errors_around_sphere(grid, unasked(cloud, grid, report));
    EXPECT_EQ(report.method, "auto");
    EXPECT_LT(on_average, mean) << top << " " << noise;
    EXPECT_LT(worst, largest) << top << " " << noise;
    EXPECT_LT(wrong, 0.01);
    EXPECT_EQ(test::size_named(report, "completed share of the zero set") > 0.05, top < 1);
    if (noise == 0) continue;
    const VecX there = unasked_at(cloud, MatX3(1.3 * cloud.normals.topRows(20)), at_points);
    EXPECT_LT((there.array() - 0.3).abs().maxCoeff(), largest);
  }
}

TEST(CompletedClouds, PointsThatEncloseNothingAreNamed) {
  const auto named = [](const PolygonSoup& cloud) {
    Report report;
    unasked(cloud, test::cube_grid(13, 1.4), report);
    const bool told = std::any_of(report.warnings.begin(), report.warnings.end(),
                                  [](const auto& w) { return w.code == "points-not-enclosing"; });
    EXPECT_EQ(report.status == "uncertain", told);
    return told;
  };
  EXPECT_FALSE(named(sphere_cloud(1000, 1, 0)));
  PolygonSoup square;  // and nothing below it
  square.points = test::grid_soup(30, 30).points.rowwise() - Eigen::RowVector3d(0.5, 0.5, 0);
  square.normals = MatX3::Zero(square.points.rows(), 3);
  square.normals.col(2).setOnes();
  EXPECT_TRUE(named(square));
}

TEST(CompletedClouds, ThinnerThanTheGridKeepTheirDistance) {
  // Two parallel sheets of points, a tenth of a spacing apart, outward.
  PolygonSoup plate;
  const PolygonSoup sheet = test::grid_soup(40, 40);
  const auto n = sheet.points.rows();
  plate.points.resize(2 * n, 3);
  plate.normals = MatX3::Zero(2 * n, 3);
  plate.points << sheet.points, sheet.points;
  plate.points.topRows(n).col(2).array() += 0.005;
  plate.points.bottomRows(n).col(2).array() -= 0.005;
  plate.normals.topRows(n).col(2).setConstant(1);
  plate.normals.bottomRows(n).col(2).setConstant(-1);
  Report report;
  const Vec3 middle = sheet.points.colwise().mean();
  const VecX there = unasked_at(plate,
                                (MatX3(2, 3) << middle.transpose() + Vec3(0, 0, 0.2).transpose(),
                                 middle.transpose() - Vec3(0, 0, 0.1).transpose())
                                    .finished(),
                                report);
  EXPECT_NEAR(there[0], 0.195, 5e-3);
  EXPECT_NEAR(there[1], 0.095, 5e-3);
}

TEST(CompletedClouds, AreMeasuredThroughTetsToo) {
  const Grid grid = test::cube_grid(12, 1.4);
  Report report;
  const SpaceAnswer of_cloud = tet_distance(sphere_cloud(600, 1, 0), grid, {}, {}, Task(), report);
  EXPECT_LT(errors_around_sphere(grid, of_cloud.at_nodes)[1], 0.02);
}

TEST(ThinParts, AreNamedWithTheResolutionThatHoldsThem) {
  // A plate between two layers of nodes, and thick enough.
  const auto warned = [](const PolygonSoup& input, int nodes, double at) {
    Grid grid = test::cube_grid(nodes, 1.2);
    grid.origin[2] += at;
    Report report;
    unasked(input, grid, report);
    return report;
  };
  const PolygonSoup plate = test::box_soup({0.9, 0.8, 0.02});
  const double h = test::cube_grid(24, 1.2).spacing[2];
  const Report lost = warned(plate, 24, h / 2 - std::fmod(1.2, h) + h);
  EXPECT_THAT(lost.warnings, Contains(HasSubstr("thinner than the grid's spacing")));
  EXPECT_GT(test::size_named(lost, "share of the area at parts thinner than a spacing"), 0.8);
  // 2.4 / 0.04 cells are as thick as the plate.
  const std::string text = lost.warnings.back().text;
  const int resolution = std::stoi(text.substr(text.find("option resolution ") + 18));
  EXPECT_GE(resolution, 61);
  EXPECT_LE(resolution, 90);
  EXPECT_THAT(warned(plate, resolution, 0.013).warnings, IsEmpty());
  // Neither edges and corners, nor sheets, are thin parts.
  for (const PolygonSoup& thick :
       {test::box_soup({0.9, 0.8, 0.7}), hemisphere(4, false), test::octasphere_soup(4)})
    EXPECT_THAT(warned(thick, 24, 0.013).warnings, IsEmpty());
  EXPECT_EQ(test::size_named(warned(test::grid_soup(8, 8), 24, 0.013),
                             "share of the area at parts thinner than a spacing"),
            0);
}

}  // namespace
}  // namespace littoral
