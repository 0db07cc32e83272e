// Values at sources in space that distance is counted from.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "api/space/sdf.h"
#include "api/space/valued_sources.h"
#include "base/parallel.h"
#include "littoral/littoral.h"
#include "sources/space/parts_of_samples.h"
#include "space_helpers.h"
#include "spatial/closest_on_triangle.h"
#include "spatial/triangulate.h"
#include "spatial/valued_nearest.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

struct Valued {
  PolygonSoup surface;
  std::vector<double> values;

  /// One surface more, all of it of one value.
  void add(const PolygonSoup& other, const Vec3& at, double value) {
    const int first = surface.n_vertices();
    surface.points.conservativeResize(first + other.n_vertices(), 3);
    surface.points.bottomRows(other.n_vertices()) = other.points.rowwise() + at.transpose();
    for (int f = 0; f < other.n_faces(); ++f) {
      std::vector<int> corners;
      for (const int v : other.face(f)) corners.push_back(first + v);
      surface.add_face(corners);
      values.push_back(value);
    }
  }
};

Valued two_boxes(const Vec3& half, const Vec3& a, double at_a, const Vec3& b, double at_b) {
  Valued out;
  out.add(test::box_soup(half), a, at_a);
  out.add(test::box_soup(half), b, at_b);
  return out;
}

PolygonSoup cloud(const MatX3& points) {
  PolygonSoup out;
  out.points = points;
  return out;
}

double largest_error(const Grid& grid, const VecX& values, const auto& exact) {
  double largest = 0;
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i)
        largest = std::max(
            largest, std::abs(values[index(grid.node(i, j, k))] - exact(grid.point(i, j, k))));
  return largest;
}

TEST(ValuedNearest, IsTheLeastAndTheGreatestOverAllSources) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  const MatX3 points = test::random_points(120, 1, 2);
  MatX3i faces(200, 3);
  for (int& v : faces.reshaped()) v = static_cast<int>(random() % 120);
  for (const bool triangles : {true, false}) {
    std::vector<double> values(triangles ? 200 : 120);
    for (double& c : values) c = 0.3 * u(random);
    const ValuedNearest nearest(points, triangles ? faces : MatX3i(0, 3), values);
    const MatX3 places = test::random_points(300, 2, 3);
    for (const auto& row : places.rowwise()) {
      const Vec3 x = row.transpose();
      double least = infinity, greatest = -infinity;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const auto corner = [&](int k) {
          return Vec3(points.row(faces(index(i), k)).transpose() - x);
        };
        const double d =
            triangles ? std::sqrt(closest_on_triangle(corner(0), corner(1), corner(2)).squared)
                      : (points.row(index(i)).transpose() - x).norm();
        least = std::min(least, values[i] + d);
        greatest = std::max(greatest, values[i] - d);
      }
      const ValuedPoint low = nearest.least(x), high = nearest.greatest(x);
      EXPECT_NEAR(low.reach, least, 1e-14);
      EXPECT_NEAR(high.reach, greatest, 1e-14);
      EXPECT_NEAR(low.distance, (low.point - x).norm(), 1e-14);
      EXPECT_EQ(low.reach, values[low.source] + low.distance);
      EXPECT_EQ(high.reach, values[high.source] - high.distance);
    }
    const ValuedPoint far = nearest.least({1e200, 0, 0});
    EXPECT_NEAR(far.reach / 1e200, 1, 1e-12);
  }
}

TEST(SpaceValuesSlow, OneValueOfAllIsAddedByEveryMethod) {
  const PolygonSoup sphere = test::octasphere_soup(1);
  const Grid grid = test::cube_grid(5, 1.6);
  const MatX3 at = test::random_points(20, 1.5);
  for (const MethodInfo& info : Registry<SpaceDomain>::instance().infos()) {
    OptionValues options;
    for (const OptionInfo& option : info.options)  // for those that iterate
      if (option.name == "tolerance") options.emplace_back("tolerance", "0.1");
    const AnyMethod method = AnyMethod::named(info.name, options);
    const Sdf zero = signed_distance(sphere, method);
    const Sdf four = signed_distance(sphere, std::vector<double>{4}, method);
    const VecX expected = (zero.sample(grid).values.array() + 4).matrix();
    EXPECT_EQ(four.sample(grid).values, expected) << info.name;
    if (std::find(info.domains.begin(), info.domains.end(), "set of points") == info.domains.end())
      continue;
    EXPECT_EQ(four.at(at), (zero.at(at).array() + 4).matrix()) << info.name;
    EXPECT_EQ(four(at.row(3)), zero(at.row(3)) + 4) << info.name;
    EXPECT_EQ(four.with_gradients(at).gradients, zero.with_gradients(at).gradients) << info.name;
  }
  const Sdf each = signed_distance(
      sphere, std::vector<double>(static_cast<std::size_t>(sphere.n_faces()), 4), Planar{});
  EXPECT_EQ(each.at(at), (signed_distance(sphere, Planar{}).at(at).array() + 4).matrix());
}

TEST(SpaceValues, ClosedSurfacesCountUpOutsideAndDownInside) {
  const Vec3 half(0.6, 0.4, 0.6), a(-1.2, 0.2, 0.1), b(1.1, -0.1, 0.3);
  Valued boxes = two_boxes(half, a, 0.3, b, -0.2);
  const auto exact = [&](const Vec3& x) {
    const double to_a = test::box_distance(x - a, half), to_b = test::box_distance(x - b, half);
    return to_a > 0 && to_b > 0 ? std::min(0.3 + to_a, -0.2 + to_b)
                                : std::max(0.3 - std::abs(to_a), -0.2 - std::abs(to_b));
  };
  const Grid grid = test::cube_grid(12, 2.2);
  for (const char* method : {"auto", "winding", "closest-point"}) {
    const Sdf sdf = signed_distance(boxes.surface, boxes.values, AnyMethod::named(method));
    EXPECT_LT(largest_error(grid, sdf.sample(grid).values, exact), 1e-12) << method;
    const MatX3 places = test::random_points(200, 2.5);
    for (const auto& row : places.rowwise()) {
      const Vec3 x = row.transpose();
      EXPECT_NEAR(sdf(x), exact(x), 1e-12);
      const Vec3 step = 1e-6 * sdf.gradient(x);
      EXPECT_NEAR((sdf(x + step) - sdf(x - step)) / 2e-6, 1, 1e-3);
    }
    EXPECT_THAT(sdf.report().warnings, Not(Contains(HasSubstr("shadowed"))));
  }
  // Lengths are in the unit of the input, wherever and however large it is.
  boxes.surface.points = (1e3 * boxes.surface.points).rowwise() + Eigen::RowVector3d(7, 0, 0);
  for (double& c : boxes.values) c *= 1e3;
  const Sdf large = signed_distance(boxes.surface, boxes.values);
  EXPECT_NEAR(large({7, 0, 0}), 1e3 * exact(Vec3::Zero()), 1e-9);
}

TEST(SpaceValues, ConcentricSpheresAreLevelSetsOfOneDistance) {
  const auto shells_of = [](int level) {
    Valued shells;
    const PolygonSoup sphere = test::octasphere_soup(level);
    PolygonSoup outer = sphere;
    outer.points *= 2;
    shells.add(sphere, Vec3::Zero(), 0);
    shells.add(outer, Vec3::Zero(), 1);
    return shells;
  };
  const Valued fine = shells_of(5), coarse = shells_of(3);
  const Sdf sdf = signed_distance(fine.surface, fine.values);
  const MatX3 places = test::random_points(200, 2);
  for (const auto& row : places.rowwise()) EXPECT_NEAR(sdf(row.transpose()), row.norm() - 1, 5e-3);
  const Grid grid = test::cube_grid(24, 2.6);
  for (const char* constraint : {"none", "zero-set", "soft"}) {
    const Sdf heat = signed_distance(coarse.surface, coarse.values,
                                     AnyMethod::named("signed-heat", {{"constraint", constraint}}));
    const auto radius = [](const Vec3& x) { return x.norm() - 1; };
    EXPECT_LT(test::mean_error(grid, heat.sample(grid).values, radius), 0.05) << constraint;
  }
}

TEST(SpaceValues, PointsWithoutNormalsAreBallsUnited) {
  const MatX3 centres = test::random_points(30, 1, 7);
  std::vector<double> values;
  for (int i = 0; i < 30; ++i) values.push_back(-0.05 - 0.01 * (i % 7));
  const auto exact = [&](const Vec3& x) {
    double least = infinity;
    for (int i = 0; i < 30; ++i)
      least = std::min(least, values[i] + (centres.row(i).transpose() - x).norm());
    return least;
  };
  const Grid grid = test::cube_grid(9, 1.3);
  for (const char* method : {"auto", "winding", "closest-point"}) {
    const Sdf balls = signed_distance(cloud(centres), values, AnyMethod::named(method));
    EXPECT_LT(largest_error(grid, balls.sample(grid).values, exact), 1e-13) << method;
    EXPECT_NEAR(balls({0.1, 0.2, 0.3}), exact({0.1, 0.2, 0.3}), 1e-14);
  }
  EXPECT_THROW(signed_distance(cloud(centres)), InputError);
  EXPECT_THROW(signed_distance(cloud(centres), values, SpaceSignedHeat{}).sample(grid), InputError);
  // One value alone, and one ball alone, whose box is that of the ball.
  const Sdf same = signed_distance(cloud(centres), std::vector<double>{-0.1});
  EXPECT_NEAR(same(centres.row(4)), -0.1, 1e-14);
  const Sdf one = signed_distance(cloud(MatX3::Constant(1, 3, 5)), std::vector<double>{-2});
  EXPECT_NEAR((one.bounds().row(1) - Eigen::RowVector3d::Constant(7)).norm(), 0, 1e-12);
  const Mesh ball = offset(one, Grid::around(one, {.resolution = 24}), {0.5}).front();
  const MatX3 off = ball.soup().points.rowwise() - Eigen::RowVector3d::Constant(5);
  EXPECT_LT((off.rowwise().norm().array() - 2.5).abs().maxCoeff(), 1e-3);
}

TEST(SpaceValues, OrientedPointsHaveTheirNormalsSides) {
  PolygonSoup planes;  // two of nine points each, across x
  planes.points.resize(18, 3);
  std::vector<double> values;
  for (int i = 0; i < 18; ++i) {
    planes.points.row(i) << 2 * (i / 9), i % 3 - 1, i / 3 % 3 - 1;
    values.push_back(i < 9 ? 0.5 : 0.7);
  }
  planes.normals = MatX3::Zero(18, 3);
  planes.normals.col(0).setOnes();
  const Sdf sdf = signed_distance(planes, values, ClosestPoint{});
  EXPECT_NEAR(sdf({0.5, 0, 0}), 1.0, 1e-14);  // above the first
  EXPECT_NEAR(sdf({1.5, 0, 0}), 0.2, 1e-14);  // below the second: 0.7 - 0.5
  EXPECT_NEAR(sdf({-1, 0, 0}), -0.5, 1e-14);
}

TEST(SpaceValues, HeatHoldsSheetsAtTheirValuesOnGridsAndLattices) {
  Valued sheets;
  sheets.add(test::square_at(0.3, 8), Vec3::Zero(), 1.3);
  sheets.add(test::square_at(0.7, 8), Vec3::Zero(), 1.7);
  Grid box;
  box.n = {17, 17, 17};
  box.origin.setZero();
  box.spacing.setConstant(1.0 / 16);
  for (const char* constraint : {"none", "zero-set", "soft"}) {
    const SpaceRequest heat{AnyMethod::named("signed-heat", {{"constraint", constraint}}), false,
                            false, sheets.values};
    Report report;
    const VecX on_grid = grid_distance(sheets.surface, box, heat, Task(), report);
    const SpaceAnswer lattice = tet_distance(sheets.surface, box, {}, heat, Task(), report);
    const auto exact = [](const Vec3& x) { return 1 + x[0]; };
    EXPECT_LT(largest_error(box, on_grid, exact), 0.06) << constraint;
    EXPECT_LT(test::mean_error(box, on_grid, exact), 0.02) << constraint;
    EXPECT_LT(test::mean_error(box, lattice.at_nodes, exact), 0.02) << constraint;
  }
}

TEST(SpaceValues, ThroughTetsTheDefaultCountsAtTheirVerticesToo) {
  const Vec3 half(0.3, 0.25, 0.35), a(-0.6, 0, 0.1), b(0.55, 0.1, 0);
  const Valued boxes = two_boxes(half, a, 0.1, b, -0.1);
  const SpaceRequest request{{}, false, false, boxes.values};
  Report report;
  const Grid grid = test::cube_grid(17, 1.3);
  const SpaceAnswer answer = tet_distance(boxes.surface, grid, {}, request, Task(), report);
  const auto exact = [&](const Vec3& x) {
    const double to_a = test::box_distance(x - a, half), to_b = test::box_distance(x - b, half);
    return to_a > 0 && to_b > 0 ? std::min(0.1 + to_a, -0.1 + to_b)
                                : std::max(0.1 - std::abs(to_a), -0.1 - std::abs(to_b));
  };
  EXPECT_LT(largest_error(grid, answer.at_nodes, exact), 1e-12);
  ASSERT_GT(answer.tets.values.size(), 100);
  for (Eigen::Index v = 0; v < answer.tets.values.size(); ++v)
    EXPECT_NEAR(answer.tets.values[v], exact(answer.tets.mesh.points.row(v)), 1e-12);
}

TEST(SpaceValues, WhatIsShadowedIsToldOf) {
  const Vec3 half = Vec3::Constant(0.5);
  const Vec3 a(-1, 0, 0), b(1, 0, 0);  // 1 apart
  const auto warnings = [&](double value, const AnyMethod& method) {
    const Valued boxes = two_boxes(half, a, 0, b, value);
    Report report;
    grid_distance(boxes.surface, test::cube_grid(9, 2), {method, false, false, boxes.values},
                  Task(), report);
    return std::vector<std::string>(report.warnings.begin(), report.warnings.end());
  };
  for (const char* method : {"auto", "signed-heat"}) {
    EXPECT_THAT(warnings(1.25, AnyMethod::named(method)),
                Contains(HasSubstr("the source of value 1.25 has a value 0.25 above")));
    EXPECT_THAT(warnings(0.9, AnyMethod::named(method)), Not(Contains(HasSubstr("shadowed"))));
  }
  MatX3 points(2, 3);
  points << 0, 0, 0, 1, 0, 0;
  EXPECT_THAT(signed_distance(cloud(points), std::vector<double>{-2, -0.5}).report().warnings,
              Contains(HasSubstr("value -0.5")));
}

TEST(SpaceValues, WhatCannotBeHadIsRefused) {
  const Valued boxes = two_boxes(Vec3::Constant(0.5), {-1, 0, 0}, 0, {1, 0, 0}, 0.2);
  const Grid grid = test::cube_grid(6, 2);
  for (const MethodInfo& info : Registry<SpaceDomain>::instance().infos()) {
    if (info.different_values) continue;
    const auto sample = [&] {
      signed_distance(boxes.surface, boxes.values, AnyMethod::named(info.name)).sample(grid);
    };
    EXPECT_THROW(sample(), UnsupportedError) << info.name;
  }
  Report unheard;
  const auto refused = [&](const SpaceDomain& domain) {
    return test::message_of([&] {
      solve_from_values(AnyMethod::named("tori"), domain,
                        {boxes.surface, false, false, boxes.values}, Task(), unheard);
    });
  };
  EXPECT_THAT(refused({grid, {}}), HasSubstr("on a grid these take them: auto, signed-heat, "
                                             "winding, closest-point"));
  EXPECT_THAT(refused({}), ::testing::EndsWith("these take them: auto, winding, closest-point"));
  SpaceSignedHeat levels, sharp;
  levels.constraint = SpaceConstraint::level_sets;
  sharp.sharpen = true;
  EXPECT_THROW(signed_distance(boxes.surface, boxes.values, levels).sample(grid), InputError);
  EXPECT_THROW(signed_distance(boxes.surface, boxes.values, sharp).sample(grid), UnsupportedError);
  // What completes an input has no value.
  Valued open = boxes;
  open.surface.face_offsets.pop_back();
  open.surface.corners.resize(open.surface.corners.size() - 4);
  open.values.pop_back();
  EXPECT_THAT(test::message_of([&] { signed_distance(open.surface, open.values); }),
              HasSubstr("surfaces with holes of different values cannot be completed"));
  EXPECT_NO_THROW(signed_distance(open.surface, open.values, WindingSign{}));
  PolygonSoup oriented = test::octasphere_soup(2);
  oriented.normals = oriented.points;
  oriented.face_offsets = {0};
  oriented.corners.clear();
  std::vector<double> values(static_cast<std::size_t>(oriented.n_vertices()), 0);
  values[3] = 0.1;
  EXPECT_THROW(signed_distance(oriented, values), UnsupportedError);
  EXPECT_THAT(test::message_of([&] {
                signed_distance(boxes.surface, std::vector<double>{1, 2, 3});
              }),
              HasSubstr("3 values for 12 faces"));
  EXPECT_THROW(signed_distance(boxes.surface, std::vector<double>{infinity}), InputError);
  EXPECT_THROW(
      signed_distance(cloud(1e-20 * test::random_points(2, 1)), std::vector<double>{1e300, 0}),
      InputError);
  Report report;
  EXPECT_THROW(tet_distance(cloud(test::random_points(5, 1)), grid, {}, {{}, false, false, {-0.1}},
                            Task(), report),
               UnsupportedError);
}

TEST(SpaceValues, TheSameForAnyNumberOfThreads) {
  const Valued boxes = two_boxes(Vec3::Constant(0.5), {-1, 0, 0}, 0, {1, 0, 0}, 0.2);
  const Grid grid = test::cube_grid(12, 2);
  set_thread_count(1);
  const VecX one = signed_distance(boxes.surface, boxes.values).sample(grid).values;
  set_thread_count(5);
  const VecX five = signed_distance(boxes.surface, boxes.values).sample(grid).values;
  set_thread_count(0);
  EXPECT_EQ(one, five);
}

TEST(Parts, FacesThatTouchAreOne) {
  Valued boxes = two_boxes(Vec3::Constant(0.5), {-1, 0, 0}, 0, {0, 1, 0}, 0);  // share an edge
  EXPECT_EQ(parts_of_faces(boxes.surface), std::vector<int>(12, 0));
  boxes = two_boxes(Vec3::Constant(0.5), {-1, 0, 0}, 0, {0.1, 1, 0}, 0);
  const std::vector<int> part = parts_of_faces(boxes.surface);
  EXPECT_EQ(std::count(part.begin(), part.begin() + 6, 0), 6);
  EXPECT_EQ(std::count(part.begin() + 6, part.end(), 1), 6);
}

}  // namespace
}  // namespace littoral
