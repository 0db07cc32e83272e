// Signed distance of quadratic order to curves, whole and broken.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "heat_helpers.h"
#include "littoral/error.h"
#include "one_call.h"
#include "test_meshes.h"

namespace littoral {
namespace {

SurfaceAnswer solve(const SurfaceMesh& mesh, const Sources& sources, Report& report,
                    int subdivide = 1) {
  const Quadratic method{.tolerance = 1e-6, .is_signed = true, .subdivide = subdivide};
  return test::surface_answer(mesh, sources, method, report);
}

using TrueDistance = std::function<double(const Vec3&)>;

/// Root mean square and largest error at the vertices.
std::pair<double, double> errors(const SurfaceMesh& mesh, const VecX& d,
                                 const TrueDistance& exact) {
  double sum = 0, largest = 0;
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const double e = std::abs(d[v] - exact(mesh.point(v)));
    sum += e * e;
    largest = std::max(largest, e);
  }
  return {std::sqrt(sum / mesh.n_vertices()), largest};
}

TEST(SignedQuadratic, StraightCurvesAcrossFlatDomainsAreExact) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const SurfaceMesh mesh(test::jittered_grid_soup(6, 5, 0.24, seed));
    const double x = 0.31 + 0.07 * seed;
    const auto sources = test::space_curve((MatX3(2, 3) << x, 0, 0, x, 1, 0).finished());
    Report report;
    const SurfaceAnswer result = solve(mesh, sources, report, 3);
    const VecX& shown = result.shown->scalars.at("distance");
    for (int v = 0; v < result.shown->n_vertices(); ++v)  // travelling upwards, left is positive
      EXPECT_NEAR(shown[v], x - result.shown->points(v, 0), 1e-4) << "seed " << seed << " " << v;
    EXPECT_EQ(report.status, "converged");
  }
}

TEST(SignedQuadratic, ABrokenLineIsCompletedAndExactBesideItsParts) {
  const SurfaceMesh mesh(test::grid_soup(12, 12, 1));
  Sources sources;
  for (const auto& [from, to] : {std::pair(0.0, 0.3), std::pair(0.7, 1.0)})
    sources.space_curves.push_back(
        {(MatX3(2, 3) << 0.54, from, 0, 0.54, to, 0).finished(), true, "test"});
  Report report;
  const VecX d = solve(mesh, sources, report).values;
  const auto [rms, largest] = errors(mesh, d, [](const Vec3& p) { return 0.54 - p[0]; });
  EXPECT_LT(rms, 0.01);
  EXPECT_LT(largest, 0.03);
}

TEST(SignedQuadratic, CirclesConverge) {
  const auto sources = test::space_curve(test::circle(0.5, 0.5, 0, 0.27, 200));
  const TrueDistance exact = [](const Vec3& p) {
    return 0.27 - std::hypot(p[0] - 0.5, p[1] - 0.5);
  };
  double last = 0;
  for (int n : {6, 12}) {
    const SurfaceMesh mesh(test::jittered_grid_soup(n, n, 0.2, 2));
    Report report;
    const VecX d = solve(mesh, sources, report).values;
    const double rms = errors(mesh, d, exact).first;
    for (int v = 0; v < mesh.n_vertices(); ++v)
      if (std::abs(exact(mesh.point(v))) > 0.005) {
        EXPECT_EQ(d[v] > 0, exact(mesh.point(v)) > 0) << v;
      }
    if (last > 0) {
      EXPECT_LT(rms, 0.5 * last);
    }
    last = rms;
  }
  EXPECT_LT(last, 5e-3);
}

TEST(SignedQuadratic, BrokenCirclesKeepInsideAndOutside) {
  const SurfaceMesh mesh(test::jittered_grid_soup(12, 12, 0.2, 2));
  const MatX3 circle = test::circle(0.5, 0.5, 0, 0.27, 100);
  Report report;
  const VecX d = solve(mesh, test::space_curve(circle.topRows(88)), report).values;
  const TrueDistance exact = [](const Vec3& p) {
    return 0.27 - std::hypot(p[0] - 0.5, p[1] - 0.5);
  };
  EXPECT_LT(errors(mesh, d, exact).first, 1.6e-2);
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (std::abs(exact(mesh.point(v))) > 0.04) {
      EXPECT_EQ(d[v] > 0, exact(mesh.point(v)) > 0) << v;
    }
}

TEST(SignedQuadratic, ACapOfTheSphere) {
  const SurfaceMesh mesh(test::octasphere_soup(3));
  const auto sources = test::space_curve(test::circle(0, 0, 0.6, 0.8, 100));
  Report report;
  const VecX d = solve(mesh, sources, report).values;
  const TrueDistance exact = [](const Vec3& p) {  // colatitudes
    return std::acos(0.6) - std::acos(std::clamp(p[2] / p.norm(), -1.0, 1.0));
  };
  EXPECT_LT(errors(mesh, d, exact).first, 0.015);
  const VecX flipped = solve(mesh, sources.reversed(), report).values;
  EXPECT_LT((d + flipped).cwiseAbs().maxCoeff(), 2e-3);
}

TEST(SignedQuadratic, SharpeningIsTheSameThing) {
  const SurfaceMesh mesh(test::jittered_grid_soup(8, 8, 0.2, 2));
  const auto sources = test::space_curve(test::circle(0.5, 0.5, 0, 0.27, 80));
  Report report;
  const SignedHeat sharp{.sharpen = Sharpening::quadratic};
  const VecX d = test::surface_answer(mesh, sources, sharp, report).values;
  EXPECT_LT((d - solve(mesh, sources, report).values).cwiseAbs().maxCoeff(), 1e-3);
  PolygonSoup cloud;
  cloud.points = mesh.points();
  EXPECT_THROW(test::surface_answer(SurfaceMesh(cloud), test::vertex_points({0}), sharp, report),
               UnsupportedError);
}

TEST(SignedQuadratic, UnsignedSourcesStayPositive) {
  const SurfaceMesh mesh(test::octasphere_soup(2));
  Report report;
  const VecX d = solve(mesh, test::vertex_points({3}), report).values;
  EXPECT_GE(d.minCoeff(), 0);
  EXPECT_NEAR(d.maxCoeff(), std::acos(-1.0), 0.2);
}

}  // namespace
}  // namespace littoral
