// Directions far from the source on meshes of large obtuse cells: what goes wrong there is noticed,
// and a longer diffusion puts it right.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "heat_helpers.h"
#include "methods/geodesic/exact_polyhedral.h"
#include "methods/heat/time_scale.h"
#include "one_call.h"
#include "sources/triangle_sources.h"
#include "subdivided_meshes.h"

namespace littoral {
namespace {

/// A sphere, stretched and sheared so that many of its large triangles are obtuse.
PolygonSoup sheared_ellipsoid() {
  PolygonSoup soup = test::octasphere_soup(3);
  soup.points.col(0) += 6 * soup.points.col(2);
  soup.points.col(2) *= 4;
  return soup;
}

/// Each triangle in 16.
SurfaceMesh refined(const PolygonSoup& soup, std::vector<int>* curve = nullptr) {
  return SurfaceMesh(test::quartered(test::quartered(soup, curve), curve));
}

VecX exact(const SurfaceMesh& mesh, const Sources& sources) {
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  return exact_polyhedral(T, triangle_sources(mesh, T, place_sources(mesh, sources, report)), {},
                          report)
      .distance;
}

/// Mean error over the largest distance.
double mean_error(const VecX& phi, const VecX& truth) {
  return (phi.cwiseAbs() - truth).cwiseAbs().mean() / truth.maxCoeff();
}

bool raised(const Report& report) {
  return std::any_of(report.warnings.begin(), report.warnings.end(),
                     [](const std::string& w) { return w.find("raised") != std::string::npos; });
}

std::string used(const Report& report, const std::string& option) {
  for (const auto& [name, value] : report.options)
    if (name == option) return value;
  return "";
}

constexpr int pole = 4;  // a vertex of the octasphere

TEST(HeatTimeScale, RisesWhereLargeObtuseCellsNeedIt) {
  const SurfaceMesh mesh = refined(sheared_ellipsoid());
  const Sources sources = test::vertex_points({pole});
  const VecX truth = exact(mesh, sources);
  for (const char* method : {"signed-heat", "unsigned-heat"}) {
    SCOPED_TRACE(method);
    Report given, chosen;
    const std::string small = method == std::string("signed-heat") ? "16" : "1";
    const VecX wrong = test::surface_distance(
        mesh, sources, AnyMethod::named(method, {{"time-scale", small}}), given);
    const VecX right = test::surface_distance(mesh, sources, AnyMethod::named(method), chosen);
    EXPECT_GT(mean_error(wrong, truth), 0.2);
    EXPECT_LT(mean_error(right, truth), 0.02);
    EXPECT_GT(misaligned_fraction(given), tolerable_share);
    EXPECT_LT(misaligned_fraction(chosen), tolerable_share);
    EXPECT_FALSE(raised(given));
    EXPECT_FALSE(given.warnings.empty());
    EXPECT_TRUE(raised(chosen));
    EXPECT_GT(std::stod(used(chosen, "time-scale")), std::stod(small));
  }
}

TEST(HeatTimeScale, RisesForCurvesToo) {
  const PolygonSoup coarse = sheared_ellipsoid();
  const VecX from_pole = exact(SurfaceMesh(coarse), test::vertex_points({pole}));
  std::vector<int> loop = test::loop_at(coarse, from_pole, 0.15 * from_pole.maxCoeff());
  const SurfaceMesh mesh = refined(coarse, &loop);
  Sources sources;
  Curve curve;
  for (int v : loop) curve.nodes.push_back(SurfacePoint::at_vertex(v));
  sources.curves.push_back(curve);
  const VecX truth = exact(mesh, sources);
  Report given, chosen;
  const VecX wrong = test::surface_distance(mesh, sources, SignedHeat{.time_scale = 1}, given);
  const VecX right = test::surface_distance(mesh, sources, SignedHeat{}, chosen);
  EXPECT_GT(mean_error(wrong, truth), 0.2);
  EXPECT_LT(mean_error(right, truth), 0.02);
  EXPECT_TRUE(raised(chosen));
}

TEST(HeatTimeScale, StaysWhereCellsAreEven) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  Report report;
  test::surface_distance(mesh, test::vertex_points({pole}), SignedHeat{}, report);
  EXPECT_LT(misaligned_fraction(report), tolerable_share);
  EXPECT_EQ(used(report, "time-scale"), "16");
  EXPECT_TRUE(report.warnings.empty());
}

TEST(HeatTimeScale, ShareOfCellsAgainstTheirDirections) {
  const SurfaceMesh mesh(test::grid_soup(4, 4));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const Calculus C = triangle_operators(T).scalar;
  const VecX x = mesh.points().col(0) / T.unit;
  VecX Y = C.G.apply(x);
  EXPECT_EQ(misaligned_fraction(C, x, Y), 0);
  EXPECT_EQ(misaligned_fraction(C, -x, Y), 1);
  Y.segment<2>(0) *= -1;  // one of 32 equal cells
  EXPECT_NEAR(misaligned_fraction(C, x, Y), 1.0 / 32, 1e-12);
  Y.segment<2>(0).setZero();  // not reached: not counted
  EXPECT_EQ(misaligned_fraction(C, x, Y), 0);
}

TEST(HeatTimeScale, ShareOfCellsWhoseGradientIsNoUnitVector) {
  const SurfaceMesh mesh(test::grid_soup(4, 4));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const Calculus C = triangle_operators(T).scalar;
  const VecX x = mesh.points().col(0) / T.unit;
  const VecX Y = C.G.apply(x);
  const auto share = [&](double slope) {
    Report said;
    report_gradient(C, slope * x, Y, said);
    EXPECT_EQ(said.residuals.back().first, off_unit_area_fraction);
    return said.residuals.back().second;
  };
  EXPECT_EQ(share(1), 0);
  EXPECT_EQ(share(1.2), 0);
  EXPECT_EQ(share(0.7), 1);
  EXPECT_EQ(share(1.3), 1);
  EXPECT_EQ(share(-1), 0);  // the other measure's matter
}

TEST(HeatTimeScale, WarnsWhereTheGradientIsNoUnitVector) {
  // The side of a hexagonal prism, of two triangles a side.
  PolygonSoup side;
  side.points.resize(12, 3);
  for (int i = 0; i < 6; ++i) {
    const double a = std::acos(-1.0) * i / 3;
    side.points.row(i) << std::cos(a), std::sin(a), 0;
    side.points.row(6 + i) << std::cos(a), std::sin(a), 10;
    const int next = (i + 1) % 6;
    test::add_triangle(side, i, next, 6 + next);
    test::add_triangle(side, i, 6 + next, 6 + i);
  }
  const auto warned = [](const Report& report) {
    return std::any_of(report.warnings.begin(), report.warnings.end(), [](const std::string& w) {
      return w.find("off unit length") != std::string::npos;
    });
  };
  const SurfaceMesh needles(side), even(test::octasphere_soup(4));
  const Sources sources = test::vertex_points({0});
  for (const char* method : {"signed-heat", "unsigned-heat"}) {
    SCOPED_TRACE(method);
    Report bad, good;
    const VecX values = test::surface_distance(needles, sources, AnyMethod::named(method), bad);
    EXPECT_GT(mean_error(values, exact(needles, sources)), 0.02);
    EXPECT_TRUE(warned(bad));
    test::surface_distance(even, sources, AnyMethod::named(method), good);
    EXPECT_FALSE(warned(good));
  }
}

TEST(TimeScale, OfCurvesIsLargerOnFinerMeshesUpToFourTimes) {
  SourceSystem curves, points;
  points.only_points = true;
  const auto automatic = [](const SourceSystem& terms, int cells, bool at_nodes) {
    Operators ops;
    ops.scalar.A = VecX::Zero(cells);
    ops.vector.at_nodes = at_nodes;
    return automatic_time_scale(terms, ops);
  };
  EXPECT_EQ(automatic(curves, 50'000, false), 1);
  EXPECT_EQ(automatic(curves, 100'000, false), 2);
  EXPECT_EQ(automatic(curves, 1'000'000, false), 4);
  EXPECT_EQ(automatic(curves, 1'000'000, true), 1);
  EXPECT_EQ(automatic(points, 1'000'000, false), 16);
}

}  // namespace
}  // namespace littoral
