// The default on clouds and voxels, as exact as what they sample, and on patches that touch.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "domain/mesh/flattened_voxels.h"
#include "domain_shapes.h"
#include "heat_helpers.h"
#include "one_call.h"

namespace littoral {
namespace {

constexpr double half_turn = 3.14159265358979;

class AutomaticDomains : public testing::TestWithParam<test::Domain> {
 protected:
  AutomaticDomains() : sphere(test::sphere(GetParam(), 24)), n(sphere.soup.n_vertices()) {}

  SurfaceAnswer ask(const Sources& sources, const AnyMethod& method, Report& report) const {
    return test::surface_answer(SurfaceMesh(sphere.soup), sources, method, report,
                                sphere.face_normals.rows() ? &sphere.face_normals : nullptr);
  }
  /// Of a place as seen from the middle.
  Vec3 direction(int v) const { return sphere.soup.points.row(v).normalized(); }

  /// The circle of latitude at z = 0.3 from 0 to `part` of the way round, on the unit sphere.
  static Sources circle(double part) {
    constexpr int segments = 60;
    MatX3 points(segments + 1, 3);
    const double r = std::sqrt(1 - 0.09);
    for (int i = 0; i <= segments; ++i) {
      const double a = 2 * half_turn * part * i / segments;
      points.row(i) << r * std::cos(a), r * std::sin(a), 0.3;
    }
    if (part == 1) points.row(segments) = points.row(0);
    return test::space_curve(points);
  }
  double error_of_circle(const VecX& phi, int& wrong) const {
    double sum = 0;
    wrong = 0;
    for (int v = 0; v < n; ++v) {
      const double exact = std::asin(direction(v).z()) - std::asin(0.3);
      sum += std::abs(phi[v] - exact) / n;
      if (std::abs(exact) > 0.1) wrong += phi[v] * exact < 0;
    }
    return sum / half_turn;
  }

  test::Shape sphere;
  int n;
};

TEST_P(AutomaticDomains, PointsGiveGreatCircles) {
  Sources pole;
  pole.points = {SurfacePoint::at_vertex(17)};
  Report report;
  const SurfaceAnswer answer = ask(pole, Automatic{}, report);
  double sum = 0;
  for (int v = 0; v < n; ++v)
    sum += std::abs(answer.values[v] -
                    std::acos(std::clamp(direction(v).dot(direction(17)), -1.0, 1.0)));
  EXPECT_LT(sum / n, 0.0025 * half_turn);
  EXPECT_EQ(answer.values[17], 0);
}

TEST_P(AutomaticDomains, ClosedCurvesHaveTwoSides) {
  Report report;
  int wrong = 0;
  EXPECT_LT(error_of_circle(ask(circle(1), Automatic{}, report).values, wrong), 0.003);
  EXPECT_EQ(wrong, 0);
}

TEST_P(AutomaticDomains, BrokenCurvesAreCompleted) {
  Report report;
  int wrong = 0, by_heat_wrong = 0;
  const SurfaceAnswer answer = ask(circle(0.85), Automatic{.confidence = true}, report);
  const double error = error_of_circle(answer.values, wrong);
  const double by_heat =
      error_of_circle(ask(circle(0.85), SignedHeat{}, report).values, by_heat_wrong);
  EXPECT_LT(error, 0.006);
  EXPECT_LT(error, 0.75 * by_heat);
  EXPECT_LE(wrong, by_heat_wrong);
  ASSERT_EQ(answer.confidence.size(), n);
  EXPECT_LT(answer.confidence.minCoeff(), 0.5);
  EXPECT_GT(answer.confidence.mean(), 0.9);
}

INSTANTIATE_TEST_SUITE_P(Sphere, AutomaticDomains,
                         testing::Values(test::Domain::points, test::Domain::voxels),
                         testing::PrintToStringParamName());

TEST(FlattenedVoxels, OfATiltedPlaneLieInAPlane) {
  const Vec3 up = Vec3(0.3, 0.2, 1).normalized();
  test::Shape slab =
      test::digitized(40, 1, [&](const Vec3& x) { return x.dot(up) < 0.3 && x.norm() < 18; });
  const SurfaceMesh steps(slab.soup);
  const SurfaceMesh flat(flattened_voxels(steps, slab.face_normals));
  double before = 0, after = 0;
  for (int v = 0; v < steps.n_vertices(); ++v) {
    const Vec3 x = steps.point(v);
    if (x.norm() > 8 || x.dot(up) < -1) continue;
    before = std::max(before, std::abs(x.dot(up) - 0.3));
    after = std::max(after, std::abs(flat.point(v).dot(up) - 0.3));
  }
  EXPECT_GT(before, 0.4);
  EXPECT_LT(after, 0.15);
}

TEST(AutomaticPatches, HangingOnByVerticesAreOnTheirSide) {
  constexpr int n = 4, patches = 3;  // squares in a row, each at the last corner of the one before
  PolygonSoup soup = test::grid_soup(n, n);
  const PolygonSoup square = soup;
  for (int k = 1; k < patches; ++k) {
    const int first = soup.n_vertices();
    MatX3 points(first + square.n_vertices() - 1, 3);
    points << soup.points, square.points.bottomRows(square.n_vertices() - 1).rowwise() +
                               k * Eigen::RowVector3d(1, 1, 0);
    soup.points = points;
    const auto number = [&](int v) { return v == 0 ? first - 1 : first + v - 1; };
    for (int f = 0; f < square.n_faces(); ++f)
      test::add_triangle(soup, number(square.face(f)[0]), number(square.face(f)[1]),
                         number(square.face(f)[2]));
  }
  const SurfaceMesh mesh(soup);
  ASSERT_EQ(mesh.n_components(), 1);
  Sources across;  // the first square in two, its last corner on the left
  across.add(Curve::along_vertices({14, 13, 12, 11, 10}));
  Sources reversed;
  reversed.add(Curve::along_vertices({10, 11, 12, 13, 14}));
  for (const double left : {1.0, -1.0}) {
    Report report;
    const VecX d = test::surface_distance(mesh, left > 0 ? reversed : across, Automatic{}, report);
    ASSERT_GT(std::abs(d[24]), 0.4);
    for (int v = 25; v < mesh.n_vertices(); ++v) {
      EXPECT_GT(d[v] * d[24], 0) << v;
      EXPECT_NEAR(
          std::abs(d[v]),
          0.5 + (mesh.point(v) - mesh.point(v < 49 ? 24 : 48)).norm() + (v < 49 ? 0 : std::sqrt(2)),
          1e-6)
          << v;
    }
  }
}

}  // namespace
}  // namespace littoral
