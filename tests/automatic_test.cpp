// Complete, then measure: what the default answers for whole and broken curves, points and
// surfaces of several parts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "api/surface/discretization.h"
#include "constants.h"
#include "heat_helpers.h"
#include "littoral/error.h"
#include "methods/winding/shortest_completion.h"
#include "one_call.h"
#include "sources/curves/conform.h"
#include "sources/curves/curve_ends.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::pi;

VecX answer(const SurfaceMesh& mesh, const Sources& sources, Report& report,
            const Automatic& options = {}) {
  return test::surface_distance(mesh, sources, options, report);
}

double size(const Report& report, const std::string& name) {
  for (const auto& [key, value] : report.sizes)
    if (key == name) return value;
  return std::numeric_limits<double>::quiet_NaN();
}

std::string option(const Report& report, const std::string& name) {
  for (const auto& [key, value] : report.options)
    if (key == name) return value;
  return {};
}

/// Signed distance in the plane to a polygon given counterclockwise, positive inside.
double to_polygon(const MatX3& polygon, const Vec3& x) {
  double least = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (Eigen::Index i = 0; i + 1 < polygon.rows(); ++i) {
    const Vec3 a = polygon.row(i), b = polygon.row(i + 1), along = b - a;
    const double t = std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + t * along - x).norm());
    if ((a[1] > x[1]) != (b[1] > x[1]) &&
        x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
      inside = !inside;
  }
  return inside ? least : -least;
}

/// Runs of a closed polyline, some of them left out or reversed.
Sources broken_circle(int segments, int runs, const std::vector<int>& missing,
                      const std::vector<int>& reversed = {}) {
  const MatX3 whole = test::circle(0.5, 0.5, 0, 0.3, segments);
  Sources sources;
  for (int r = 0; r < runs; ++r) {
    if (std::find(missing.begin(), missing.end(), r) != missing.end()) continue;
    const Eigen::Index from = r * segments / runs, to = (r + 1) * segments / runs;
    MatX3 part = whole.middleRows(from, to - from + 1);
    if (std::find(reversed.begin(), reversed.end(), r) != reversed.end())
      part = part.colwise().reverse().eval();
    const Sources run = test::space_curve(part);
    sources.space_curves.insert(sources.space_curves.end(), run.space_curves.begin(),
                                run.space_curves.end());
  }
  return sources;
}

double mean_difference(const VecX& a, const VecX& b) { return (a - b).cwiseAbs().mean(); }

TEST(Automatic, ClosedCurvesGiveExactDistanceAndSidesEverywhere) {
  const SurfaceMesh mesh(test::jittered_grid_soup(30, 30, 0.3));
  const MatX3 polygon = test::circle(0.5, 0.5, 0, 0.3, 40);
  Report report;
  const VecX phi = answer(mesh, test::space_curve(polygon), report);
  for (int v = 0; v < mesh.n_vertices(); ++v)
    EXPECT_NEAR(phi[v], to_polygon(polygon, mesh.point(v)), 1e-9) << v;
  EXPECT_EQ(option(report, "completion"), "none");
  EXPECT_EQ(option(report, "metric"), "exact");
  EXPECT_EQ(size(report, "shortest_completion_length"), 0);
}

TEST(Automatic, ACurveOnOnePageOfABookHasItsSidesOnAll) {
  // Along the diagonal of a square page; the spine and two more pages are on one side of it.
  PolygonSoup soup;
  soup.points.resize(8, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, -0.6, 0.8, 1, -0.6, 0.8, 0, -0.6, -0.8, 1,
      -0.6, -0.8;
  for (const int outer : {2, 4, 6}) {
    test::add_triangle(soup, 0, outer + 1, outer);
    test::add_triangle(soup, 0, 1, outer + 1);
  }
  const SurfaceMesh mesh(soup);
  const double exact[8] = {0,  -std::sqrt(0.5), std::sqrt(0.5), 0, -1, -std::sqrt(2),
                           -1, -std::sqrt(2)};
  for (const bool forward : {true, false}) {
    Sources sources;
    sources.add(Curve::along_vertices(forward ? std::vector{0, 3} : std::vector{3, 0}));
    Report report;
    const VecX phi = answer(mesh, sources, report);
    for (int v = 0; v < 8; ++v) EXPECT_NEAR(phi[v], forward ? exact[v] : -exact[v], 1e-12) << v;
    EXPECT_EQ(size(report, "shortest_completion_length"), 0);
    EXPECT_EQ(option(report, "completion"), "none");
  }
}

TEST(Automatic, ReversedCurvesReverseTheSign) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  const Sources circle = test::space_curve(test::circle(0, 0, 0.3, std::sqrt(1 - 0.09), 60));
  Report report;
  const VecX phi = answer(mesh, circle, report), psi = answer(mesh, circle.reversed(), report);
  EXPECT_LE((phi + psi).cwiseAbs().maxCoeff(), 1e-12);
  for (int v = 0; v < mesh.n_vertices(); ++v)
    EXPECT_TRUE(std::abs(phi[v]) < 0.05 || (phi[v] > 0) == (mesh.point(v).z() > 0.3)) << v;
}

TEST(Automatic, GapsAreCompletedAndMeasuredAcross) {
  const SurfaceMesh mesh(test::jittered_grid_soup(40, 40, 0.3));
  const MatX3 polygon = test::circle(0.5, 0.5, 0, 0.3, 80);
  const Sources broken = broken_circle(80, 20, {3, 9, 10});
  VecX exact(mesh.n_vertices());
  for (int v = 0; v < mesh.n_vertices(); ++v) exact[v] = to_polygon(polygon, mesh.point(v));
  Report plain;
  const double before =
      mean_difference(test::surface_distance(mesh, broken, SignedHeat{}, plain), exact);
  const double missing = 3.0 / 20 * 2 * pi * 0.3;
  Report report;
  EXPECT_LE(mean_difference(answer(mesh, broken, report), exact), 0.5 * before);
  EXPECT_EQ(option(report, "completion"), "heat");
  EXPECT_EQ(size(report, "curve_ends"), 4);
  EXPECT_NEAR(size(report, "heat_completion_length"), missing, 0.3 * missing);
  Report shortest;
  EXPECT_LE(
      mean_difference(answer(mesh, broken, shortest, {.completion = Completion::shortest}), exact),
      before);
  EXPECT_NEAR(size(shortest, "shortest_completion_length"), missing, 0.4 * missing);
}

TEST(Automatic, EndsAreThoseThatCuttingFinds) {
  const SurfaceMesh mesh(test::jittered_grid_soup(12, 12, 0.3));
  Report quiet;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, quiet);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> inside(0.15, 0.85);
  const auto point = [&] { return Vec3(inside(random), inside(random), 0); };
  int told = 0;
  for (int i = 0; i < 60; ++i) {
    Sources sources;
    MatX3 first(3, 3), second(2, 3);
    first << point().transpose(), point().transpose(), point().transpose();
    // From its middle, from its end, from elsewhere, or to the boundary.
    Vec3 from = point();
    if (i % 4 < 2) from = first.row(1 + i % 4);
    const Vec3 to = i % 4 == 3 ? Vec3(0, inside(random), 0) : point();
    second << from.transpose(), to.transpose();
    for (const MatX3& line : {first, second})
      sources.space_curves.push_back(test::space_curve(line).space_curves.front());
    const PlacedSources placed = place_sources(mesh, sources, quiet);
    const ConformingCurves cut = conform(mesh, pieces_with_sides(placed));
    const JumpSurface on(cut.cut.mesh, quiet);
    const ShortestCompletion::Part part =
        shortest_completion(*on.J, cut.times, Complete::none, 1, {}, quiet).parts[0];
    const auto ends = curve_ends(mesh, T, placed);
    if (!ends) continue;
    ++told;
    EXPECT_EQ(ends->of_component[0], part.ends) << i;
    EXPECT_NEAR(ends->length, part.given * on.T.unit, 1e-9) << i;
  }
  EXPECT_GE(told, 50);
}

TEST(Automatic, EndsThatCuttingMayMergeAreLeftToIt) {
  const SurfaceMesh mesh(test::jittered_grid_soup(12, 12, 0.3));
  Report quiet;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, quiet);
  const auto told = [&](const Vec3& gap) {
    MatX3 first(2, 3), second(2, 3);
    first << 0.3, 0.5, 0, 0.5, 0.52, 0;
    second << (first.row(1) + gap.transpose()), 0.7, 0.4, 0;
    Sources sources;
    for (const MatX3& line : {first, second})
      sources.space_curves.push_back(test::space_curve(line).space_curves.front());
    const auto ends = curve_ends(mesh, T, place_sources(mesh, sources, quiet));
    return ends ? ends->of_component[0] : -1;
  };
  EXPECT_EQ(told(Vec3::Zero()), 2);
  EXPECT_EQ(told(Vec3(0, 1e-10, 0)), -1);
  EXPECT_EQ(told(Vec3(0, 1e-4, 0)), 4);
}

TEST(Automatic, ReversedRunsAreOverruled) {
  const SurfaceMesh mesh(test::jittered_grid_soup(40, 40, 0.3));
  const MatX3 polygon = test::circle(0.5, 0.5, 0, 0.3, 80);
  Report report;
  const VecX phi = answer(mesh, broken_circle(80, 20, {}, {2, 7, 13}), report);
  for (int v = 0; v < mesh.n_vertices(); ++v)
    EXPECT_NEAR(phi[v], to_polygon(polygon, mesh.point(v)), 1e-9) << v;
  EXPECT_NEAR(size(report, "overruled_length"), 3.0 / 20 * 2 * pi * 0.3, 0.01);
}

TEST(Automatic, MuchMissingIsCompletedByHeat) {
  const SurfaceMesh mesh(test::jittered_grid_soup(40, 40, 0.3));
  Report report;
  const VecX phi = answer(mesh, broken_circle(80, 8, {1, 2, 3, 5, 6, 7}), report);
  EXPECT_TRUE(phi.allFinite());
  EXPECT_EQ(option(report, "completion"), "heat");
  EXPECT_GT(size(report, "heat_completion_length"), 0.3);
  EXPECT_THAT(report.warnings, testing::ElementsAre(testing::HasSubstr("option confidence")));
}

TEST(Automatic, ConfidenceIsLowWhereCurvesAreCompleted) {
  const SurfaceMesh mesh(test::jittered_grid_soup(40, 40, 0.3));
  const MatX3 polygon = test::circle(0.5, 0.5, 0, 0.3, 80);
  Report report;
  const Automatic options{.confidence = true};
  const SurfaceAnswer broken =
      test::surface_answer(mesh, broken_circle(80, 8, {3}), options, report);
  ASSERT_EQ(broken.confidence.size(), mesh.n_vertices());
  const double gap = 2 * pi / 8 * 0.3;
  double lowest = 1;
  int far = 0;
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    EXPECT_GE(broken.confidence[v], 0);
    EXPECT_LE(broken.confidence[v], 1);
    const Vec3 x = mesh.point(v) - Vec3(0.5, 0.5, 0);
    const double angle = std::atan2(x.y(), x.x()), middle = 2 * pi * 3.5 / 8;
    const bool in_gap = std::abs(std::remainder(angle - middle, 2 * pi)) < pi / 16;
    if (in_gap) lowest = std::min(lowest, broken.confidence[v]);
    if (std::abs(x.norm() - 0.3) > gap) {
      EXPECT_GE(broken.confidence[v], 0.999) << v;
      ++far;
    }
  }
  EXPECT_LE(lowest, 0.3);
  EXPECT_GT(far, 100);
  const SurfaceAnswer closed =
      test::surface_answer(mesh, test::space_curve(polygon), options, report);
  EXPECT_EQ(closed.confidence, VecX::Ones(mesh.n_vertices()));
  EXPECT_EQ(
      test::surface_answer(mesh, test::space_curve(polygon), Automatic{}, report).confidence.size(),
      0);
}

TEST(Automatic, SourcesWithoutSidesDoNotMoveTheSides) {
  const SurfaceMesh mesh(test::jittered_grid_soup(40, 40, 0.3));
  const Sources arc = broken_circle(80, 8, {6, 7});
  Sources all = arc;
  all.points.push_back(SurfacePoint::at_vertex(45));
  MatX3 segment(2, 3);
  segment << 0.7, 0.1, 0, 0.95, 0.4, 0;
  const Sources line = test::space_curve(segment, false);
  all.space_curves.insert(all.space_curves.end(), line.space_curves.begin(),
                          line.space_curves.end());
  Report report;
  const VecX alone = answer(mesh, arc, report), beside = answer(mesh, all, report);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    EXPECT_LE(std::abs(beside[v]), std::abs(alone[v]) + 1e-12) << v;
    if (std::abs(beside[v]) > 1e-12) {
      EXPECT_EQ(beside[v] > 0, alone[v] > 0) << v;
    }
  }
}

TEST(Automatic, EachComponentIsCompletedByItself) {
  PolygonSoup two = test::jittered_grid_soup(20, 20, 0.3);
  const PolygonSoup other = test::jittered_grid_soup(20, 20, 0.2, 3);
  const int n = two.n_vertices();
  const MatX3 before = two.points;
  two.points.resize(2 * n, 3);
  two.points << before, (other.points * 1e-3).rowwise() + Eigen::RowVector3d(5, 0, 0);
  for (int f = 0; f < other.n_faces(); ++f) {
    std::vector<int> corners;
    for (const int v : other.face(f)) corners.push_back(v + n);
    two.add_face(corners);
  }
  const SurfaceMesh mesh(two), first(test::jittered_grid_soup(20, 20, 0.3));
  const MatX3 whole = test::circle(0.5, 0.5, 0, 0.3, 40);
  Sources both = test::space_curve(whole);
  const MatX3 half = ((whole.topRows(12)) * 1e-3).rowwise() + Eigen::RowVector3d(5, 0, 0);
  const Sources arc = test::space_curve(half);
  both.space_curves.insert(both.space_curves.end(), arc.space_curves.begin(),
                           arc.space_curves.end());
  Report report;
  const VecX phi = answer(mesh, both, report);
  for (int v = 0; v < n; ++v) EXPECT_NEAR(phi[v], to_polygon(whole, mesh.point(v)), 1e-9) << v;
  EXPECT_TRUE(phi.tail(n).allFinite());
  EXPECT_LE(phi.tail(n).cwiseAbs().maxCoeff(), 2e-3);
  EXPECT_GT(phi.tail(n).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(Automatic, ComponentsOfFacesWithoutAreaDoNotDisturbOthers) {
  const PolygonSoup grid = test::jittered_grid_soup(20, 20, 0.3);
  const int n = grid.n_vertices();
  PolygonSoup soup;
  soup.points.resize(n + 2, 3);
  soup.points << Eigen::RowVector3d(3, 0, 0), Eigen::RowVector3d(3, 1, 0), grid.points;
  soup.add_face(std::vector<int>{0, 0, 1});
  for (int f = 0; f < grid.n_faces(); ++f) {
    std::vector<int> corners;
    for (const int v : grid.face(f)) corners.push_back(v + 2);
    soup.add_face(corners);
  }
  Report report, alone;
  const Sources broken = broken_circle(80, 20, {3});
  const VecX phi = answer(SurfaceMesh(soup), broken, report);
  const VecX expected = answer(SurfaceMesh(grid), broken, alone);
  EXPECT_LE((phi.tail(n) - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(phi[0], std::numeric_limits<double>::infinity());
}

TEST(Automatic, CurvesThatBoundNothingHaveNoOutsideButADistance) {
  // A meridian of a torus: whatever completes it, distance to the curve itself is 0.
  const SurfaceMesh mesh(test::torus_soup(48, 24));
  const Sources loop =
      test::space_curve(test::circle(0, 0, 0.4, 1, 96));  // the circle on top, once round the hole
  Report report;
  const VecX phi = answer(mesh, loop, report);
  EXPECT_TRUE(phi.allFinite());
  for (int v = 0; v < mesh.n_vertices(); ++v)
    EXPECT_TRUE(mesh.point(v).z() < 0.4 - 1e-9 || std::abs(phi[v]) <= 2e-3) << v;
}

TEST(Automatic, PointsAndUnsignedCurvesAreExact) {
  const SurfaceMesh mesh(test::jittered_grid_soup(24, 24, 0.3));
  Sources point;
  point.points.push_back(SurfacePoint::in_face(300, 0.2, 0.3, 0.5));
  const Vec3 x = mesh.position(point.points[0]);
  Report report;
  const VecX d = answer(mesh, point, report);
  for (int v = 0; v < mesh.n_vertices(); ++v) EXPECT_NEAR(d[v], (mesh.point(v) - x).norm(), 1e-9);
  const MatX3 polygon = test::circle(0.5, 0.5, 0, 0.3, 40);
  const VecX u = answer(mesh, test::space_curve(polygon, false), report);
  for (int v = 0; v < mesh.n_vertices(); ++v)
    EXPECT_NEAR(u[v], std::abs(to_polygon(polygon, mesh.point(v))), 1e-9);
}

TEST(Automatic, ManyTrianglesAreMeasuredToTheToleranceOfTheReport) {
  const SurfaceMesh few(test::octasphere_soup(6)), many(test::octasphere_soup(7));
  ASSERT_LT(few.n_faces(), 100'000);
  ASSERT_GT(many.n_faces(), 100'000);
  for (const SurfaceMesh* mesh : {&few, &many}) {
    Automatic exactly;
    exactly.tolerance = 0;
    Report report, exact_report;
    const VecX d = answer(*mesh, test::vertex_points({5}), report),
               exact = answer(*mesh, test::vertex_points({5}), exact_report, exactly);
    const double tolerance = std::stod(option(report, "tolerance"));
    EXPECT_EQ(tolerance, mesh == &few ? 0 : 1e-5);
    EXPECT_LE(((d - exact).array().abs() - tolerance * exact.array()).maxCoeff(), 1e-12);
    EXPECT_EQ(d == exact, mesh == &few);
  }
}

TEST(Automatic, OptionsThatCannotBeMetAreRefused) {
  const SurfaceMesh mesh(test::jittered_grid_soup(12, 12, 0.2));
  Report report;
  EXPECT_THROW(answer(mesh, broken_circle(40, 8, {2}), report, {.completion = Completion::none}),
               InputError);
  EXPECT_THROW(answer(mesh, broken_circle(40, 8, {2}), report,
                      {.completion = Completion::shortest, .metric = Metric::heat}),
               UnsupportedError);
}

TEST(Automatic, MetricsAgreeUpToTheirAccuracy) {
  const SurfaceMesh mesh(test::jittered_grid_soup(30, 30, 0.3));
  const Sources circle = test::space_curve(test::circle(0.5, 0.5, 0, 0.3, 40));
  Report report;
  const VecX exact = answer(mesh, circle, report);
  EXPECT_LE(mean_difference(answer(mesh, circle, report, {.metric = Metric::fast_marching}), exact),
            0.003);
  EXPECT_LE(mean_difference(answer(mesh, circle, report, {.metric = Metric::heat}), exact), 0.01);
}

TEST(Automatic, OptionsOfOtherMethodsNameThese) {
  const SurfaceMesh mesh(test::jittered_grid_soup(12, 12, 0.2));
  const Sources circle = test::space_curve(test::circle(0.5, 0.5, 0, 0.3, 40));
  Report report;
  try {
    test::surface_distance(mesh, circle, AnyMethod::named("", {{"constraint", "none"}}), report);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("signed-heat"));
  }
  const AnyMethod metric = AnyMethod::named("", {{"metric", "fast-marching"}});
  test::surface_distance(mesh, circle, metric, report);
  EXPECT_EQ(report.method, "auto");
}

}  // namespace
}  // namespace littoral
