// Regularized distance on intrinsic Delaunay triangles of the given surface.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "domain/intrinsic/intrinsic_delaunay.h"
#include "littoral/error.h"
#include "one_call.h"
#include "repair_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// n x n rhombs of two equilateral triangles with sides of length 1, of which the first n_long are
/// cut along their long diagonal, which is not Delaunay, and the others along the short one.
SurfaceMesh rhombs(int n, int n_long) {
  PolygonSoup soup;
  soup.points.resize((n + 1) * (n + 1), 3);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      soup.points.row(i + j * (n + 1)) << i + 0.5 * j, std::sqrt(0.75) * j, 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = i + j * (n + 1), b = a + 1, c = a + n + 1, d = c + 1;
      const bool is_long = i + j * n < n_long;
      test::add_triangle(soup, a, b, is_long ? d : c);
      test::add_triangle(soup, is_long ? a : b, d, c);
    }
  return SurfaceMesh(soup);
}

VecX distance(const SurfaceMesh& mesh, const Sources& sources, const char* triangulation,
              Report& report, const char* method = "belyaev-fayolle") {
  OptionValues options{{"tolerance", "1e-4"}};
  if (*triangulation) options.emplace_back("triangulation", triangulation);
  return test::surface_distance(mesh, sources, AnyMethod::named(method, options), report);
}

Sources at_vertex(int v) {
  Sources sources;
  sources.points.push_back(SurfacePoint::at_vertex(v));
  return sources;
}

bool flipped(const Report& report) {
  for (const auto& [name, value] : report.sizes)
    if (name == "intrinsic_flips") return true;
  return false;
}

TEST(RegularizedTriangles, TheShareOfEdgesThatAreNotDelaunay) {
  Report report;
  const int n = 6, inner = 3 * n * n - 2 * n;
  for (const int n_long : {0, 1, n * n})
    EXPECT_DOUBLE_EQ(share_not_delaunay(intrinsic_triangulation(rhombs(n, n_long), report)),
                     double(n_long) / inner);
  // Right angles across from an edge make half a turn together.
  EXPECT_EQ(share_not_delaunay(intrinsic_triangulation(SurfaceMesh(test::grid_soup(3, 3)), report)),
            0);
}

TEST(RegularizedTriangles, AnswersAreThoseOnDelaunayTriangles) {
  const int n = 12, corner = n * (n + 2);
  for (const char* method : {"belyaev-fayolle", "regularized"}) {
    Report of_short, of_long, of_given;
    const VecX expected = distance(rhombs(n, 0), at_vertex(corner), "", of_short, method);
    EXPECT_FALSE(flipped(of_short));
    const VecX found = distance(rhombs(n, n * n), at_vertex(corner), "", of_long, method);
    EXPECT_EQ(test::size_named(of_long, "intrinsic_flips"), n * n);
    EXPECT_EQ(of_long.status, "converged");
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-3);
    const VecX given = distance(rhombs(n, n * n), at_vertex(corner), "as-is", of_given, method);
    EXPECT_FALSE(flipped(of_given));
    EXPECT_GT((given - expected).cwiseAbs().maxCoeff(), 0.1);
  }
}

TEST(RegularizedTriangles, AFewEdgesThatAreNotDelaunayStay) {
  const int n = 12, inner = 3 * n * n - 2 * n;
  const int few = int(0.075 * inner), many = few + 1;
  for (const int n_long : {few, many}) {
    const SurfaceMesh mesh = rhombs(n, n_long);
    Report usual, other;
    const VecX u = distance(mesh, at_vertex(0), "", usual);
    const bool flips = n_long == many;
    EXPECT_EQ(flipped(usual), flips);
    EXPECT_EQ(u, distance(mesh, at_vertex(0), flips ? "delaunay" : "as-is", other));
  }
}

TEST(RegularizedTriangles, CurvesAlongEdgesThatAreNotDelaunayStayWhole) {
  const int n = 8;
  const SurfaceMesh mesh = rhombs(n, n * n);
  Sources sources;  // the long diagonal of the whole, along those of n rhombs
  Curve curve;
  for (int i = 0; i <= n; ++i) curve.nodes.push_back(SurfacePoint::at_vertex(i * (n + 2)));
  sources.curves.push_back(curve);
  Report report;
  const VecX u = distance(mesh, sources, "delaunay", report);
  EXPECT_EQ(report.status, "converged");
  double flips = 0;  // of the last triangles that were made
  for (const auto& [name, value] : report.sizes)
    if (name == "intrinsic_flips") flips = value;
  EXPECT_EQ(flips, n * n - n);
  // The surface is symmetric about the curve and flat: functions of the distance to the line are
  // linear on triangles beside it.
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double expected = 0.5 * std::abs(i - j);
      EXPECT_NEAR(u[i + j * (n + 1)], expected, 0.15) << i << " " << j;
      EXPECT_NEAR(u[i + j * (n + 1)], u[j + i * (n + 1)], 1e-3);
    }
}

TEST(RegularizedTriangles, WhatNeedsTheGivenTrianglesSaysSo) {
  const SurfaceMesh mesh = rhombs(3, 9);
  const auto solve = [&](const SurfaceMesh& on, OptionValues options) {
    Report report;
    test::surface_distance(on, at_vertex(0), AnyMethod::named("regularized", options), report);
    return flipped(report);
  };
  EXPECT_THROW(solve(mesh, {{"triangulation", "delaunay"}, {"elements", "quadratic"}}),
               UnsupportedError);
  EXPECT_THROW(solve(mesh, {{"triangulation", "delaunay"}, {"regularizer", "max-norm"}}),
               UnsupportedError);
  EXPECT_FALSE(solve(mesh, {{"elements", "quadratic"}}));
  EXPECT_FALSE(solve(mesh, {{"regularizer", "max-norm"}}));
  EXPECT_TRUE(solve(mesh, {{"regularizer", "max-norm"}, {"alpha", "0"}}));  // no energy at all
  PolygonSoup quad;
  quad.points = mesh.points().topRows(6);
  quad.add_face(std::array{0, 1, 5, 4});
  EXPECT_THROW(solve(SurfaceMesh(quad), {{"triangulation", "delaunay"}}), UnsupportedError);
  EXPECT_FALSE(solve(SurfaceMesh(quad), {}));
}

}  // namespace
}  // namespace littoral
