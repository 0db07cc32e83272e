// Signed heat near broken curves closes them as signed heat on the whole mesh does.

#include "api/surface/heat_near_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "constants.h"
#include "heat_helpers.h"
#include "one_call.h"
#include "sources/curves/completed_curves.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::pi;

/// Runs of a circle in the plane, the missing ones left out; clockwise if `outside` is positive.
Sources runs_of_circle(double radius, int segments, int runs, const std::vector<int>& missing,
                       bool outside = false) {
  const MatX3 whole = test::circle(0.5, 0.5, 0, radius, segments);
  Sources sources;
  for (int r = 0; r < runs; ++r) {
    if (std::find(missing.begin(), missing.end(), r) != missing.end()) continue;
    const Eigen::Index from = r * segments / runs, to = (r + 1) * segments / runs;
    MatX3 part = whole.middleRows(from, to - from + 1);
    if (outside) part = part.colwise().reverse().eval();
    sources.space_curves.push_back(test::space_curve(part).space_curves.front());
  }
  return sources;
}

struct Case {
  Case(const SurfaceMesh& surface, const Sources& sources)
      : mesh(surface),
        T(intrinsic_triangulation(mesh, quiet)),
        placed(place_sources(mesh, sources, quiet)),
        near(signed_heat_near(mesh, T, placed, {})) {}

  const SurfaceMesh& mesh;
  Report quiet;
  IntrinsicTriangulation T;
  PlacedSources placed;
  std::optional<VecX> near;
};

/// The circle is closed along itself: signs are those of its inside.
void expect_inside_of_circle(const Case& c) {
  ASSERT_TRUE(c.near);
  for (int v = 0; v < c.mesh.n_vertices(); ++v) {
    const double d = 0.3 - (c.mesh.point(v) - Vec3(0.5, 0.5, 0)).norm();
    EXPECT_TRUE(std::abs(d) <= 0.002 || ((*c.near)[v] > 0) == (d > 0)) << v << " at " << d;
  }
}

/// Signs are those of signed heat on the whole mesh.
void expect_sides_of_whole(const SurfaceMesh& mesh, const Sources& sources) {
  const Case c(mesh, sources);
  ASSERT_TRUE(c.near);
  Report report;
  const VecX whole = test::surface_distance(mesh, sources, SignedHeat{}, report);
  for (int v = 0; v < mesh.n_vertices(); ++v)
    EXPECT_TRUE(std::abs(whole[v]) <= 0.002 || ((*c.near)[v] > 0) == (whole[v] > 0)) << v;
}

double completed_length(const Case& c) {
  double length = 0;
  for (const CurvePiece& piece : completed_curves(c.mesh, c.placed, *c.near).pieces)
    if (!piece.is_signed) length += piece.length;
  return length;
}

TEST(HeatNearCurves, CircleWithGapsIsClosedAlongItself) {
  const SurfaceMesh mesh(test::jittered_grid_soup(120, 120, 0.3));
  const Case c(mesh, runs_of_circle(0.3, 160, 40, {3, 9, 14, 30}));
  expect_inside_of_circle(c);
  const double missing = 4.0 / 40 * 2 * pi * 0.3;
  EXPECT_NEAR(completed_length(c), missing, 0.1 * missing);
}

TEST(HeatNearCurves, WidensUntilTheZeroSetLiesWellInside) {
  // A ring: the nearest ends are those of the other circle, which the gaps are wider than.
  const SurfaceMesh mesh(test::jittered_grid_soup(200, 200, 0.3));
  Sources sources = runs_of_circle(0.2, 160, 40, {3, 4});
  const Sources inner = runs_of_circle(0.185, 160, 40, {3, 4}, true);
  sources.space_curves.insert(sources.space_curves.end(), inner.space_curves.begin(),
                              inner.space_curves.end());
  expect_sides_of_whole(mesh, sources);
}

TEST(HeatNearCurves, CurvesThatCloseFarAwayNeedTheWholeMesh) {
  const SurfaceMesh sphere(test::octasphere_soup(5));
  const MatX3 circle = test::circle(0, 0, 0.3, std::sqrt(1 - 0.09), 60);
  EXPECT_FALSE(Case(sphere, test::space_curve(circle.topRows(20))).near) << "a third of it";
  const SurfaceMesh plane(test::jittered_grid_soup(120, 120, 0.3));
  EXPECT_FALSE(Case(plane, runs_of_circle(0.3, 160, 2, {1})).near) << "half of it";
  MatX3 line(2, 3);
  line << 0.45, 0.5, 0, 0.55, 0.5, 0;
  EXPECT_FALSE(Case(plane, test::space_curve(line)).near) << "to the boundary";
}

TEST(HeatNearCurves, OtherComponentsHaveNoValue) {
  PolygonSoup soup = test::jittered_grid_soup(120, 120, 0.3);
  const int n = soup.n_vertices();
  soup.points.conservativeResize(n + 3, 3);
  soup.points.bottomRows(3) << 2, 0, 0, 3, 0, 0, 2, 1, 0;
  soup.add_face(std::vector{n, n + 1, n + 2});
  const SurfaceMesh mesh(std::move(soup));
  const Case c(mesh, runs_of_circle(0.3, 160, 40, {3}));
  ASSERT_TRUE(c.near);
  EXPECT_TRUE(c.near->head(n).allFinite());
  for (int v = n; v < n + 3; ++v) EXPECT_EQ((*c.near)[v], infinity);
}

TEST(HeatNearCurves, EndsNearlyAtOnePlace) {
  const SurfaceMesh mesh(test::jittered_grid_soup(120, 120, 0.3));
  Sources sources = runs_of_circle(0.3, 160, 40, {3, 9, 14, 30});
  double shift = 0;
  for (SpaceCurve& curve : sources.space_curves)
    curve.points.rowwise() += Eigen::RowVector3d(shift += 1e-12, 0, 0);
  expect_inside_of_circle(Case(mesh, sources));
}

TEST(HeatNearCurves, FacesBesideAnEdgeOfThree) {
  // A strip stands on the plane along a row of its vertices, across the circle.
  PolygonSoup soup = test::jittered_grid_soup(120, 120, 0.3);
  const int first = soup.n_vertices(), on = 60 * 121;
  soup.points.conservativeResize(first + 121, 3);
  for (int i = 0; i <= 120; ++i)
    soup.points.row(first + i) = soup.points.row(on + i) + Eigen::RowVector3d(0, 0, 0.01);
  for (int i = 0; i < 120; ++i) {
    test::add_triangle(soup, on + i, on + i + 1, first + i + 1);
    test::add_triangle(soup, on + i, first + i + 1, first + i);
  }
  const SurfaceMesh mesh(std::move(soup));
  const Sources sources = runs_of_circle(0.3, 160, 40, {3, 9, 14, 30});
  expect_sides_of_whole(mesh, sources);
}

}  // namespace
}  // namespace littoral
