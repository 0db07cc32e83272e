// Variants of surface winding numbers: free boundaries, curves through faces as they are, residual
// functions between shortest paths.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/error.h"
#include "methods/winding/residual.h"
#include "one_call.h"
#include "test_meshes.h"

namespace littoral {
namespace {

Curve through_vertices(const std::vector<int>& vertices) {
  Curve curve;
  for (int v : vertices) curve.nodes.push_back(SurfacePoint::at_vertex(v));
  return curve;
}

constexpr int n = 40;  // of the unit square

/// RMS difference of w from the angle under which the segment x = s, y in [a, b] is seen, up to a
/// constant; on vertices away from the segment.
double error_of_angle(const SurfaceMesh& mesh, const WindingAnswer& answer, double s, double a,
                      double b) {
  const SurfaceMesh& cut = answer.cut.mesh;
  EXPECT_EQ(cut.n_faces(), mesh.n_faces());
  double sum = 0, squares = 0;
  int count = 0;
  for (int f = 0; f < cut.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = cut.point(cut.face(f)[k]);
      if (std::hypot(p.x() - s, p.y() - std::clamp(p.y(), a, b)) < 1e-9) continue;
      const double angle =
          std::remainder(std::atan2(b - p.y(), s - p.x()) - std::atan2(a - p.y(), s - p.x()),
                         2 * std::numbers::pi);
      const double d = answer.numbers.w.u(f, k) - angle / (2 * std::numbers::pi);
      sum += d;
      squares += d * d;
      ++count;
    }
  return std::sqrt(squares / count - sum / count * (sum / count));
}

std::vector<int> upward(int column, int from, int to) {
  std::vector<int> line;
  for (int j = from; j <= to; ++j) line.push_back(j * (n + 1) + column);
  return line;
}

TEST(FreeBoundary, IsNearTheAngleInThePlane) {
  const SurfaceMesh mesh(test::grid_soup(n, n, 1));
  Sources sources;
  sources.curves = {through_vertices(upward(n - 6, 14, 28))};
  const double s = (n - 6.0) / n, a = 14.0 / n, b = 28.0 / n;
  const double natural = error_of_angle(mesh, test::surface_winding(mesh, sources), s, a, b);
  const double free = error_of_angle(
      mesh,
      test::surface_winding(mesh, sources,
                            SurfaceWinding{.boundary_condition = BoundaryCondition::free}),
      s, a, b);
  EXPECT_GT(natural, 0.04);
  EXPECT_LT(free, 0.25 * natural);
}

TEST(FreeBoundary, ChangesNothingForCurvesThatBound) {
  const SurfaceMesh mesh(test::grid_soup(n, n, 1));
  std::vector<int> loop = upward(20, 10, 20);
  for (int i = 19; i >= 10; --i) loop.push_back(20 * (n + 1) + i);
  for (int j = 19; j >= 10; --j) loop.push_back(j * (n + 1) + 10);
  for (int i = 11; i <= 20; ++i) loop.push_back(10 * (n + 1) + i);
  Sources sources;
  // A loop, and a line from boundary to boundary: it bounds relative to it.
  sources.curves = {through_vertices(loop), through_vertices(upward(30, 0, n))};
  for (const BoundaryCondition boundary : {BoundaryCondition::natural, BoundaryCondition::free}) {
    const WindingAnswer answer =
        test::surface_winding(mesh, sources, SurfaceWinding{.boundary_condition = boundary});
    EXPECT_TRUE(answer.nonbounding.empty());
    for (int f = 0; f < mesh.n_faces(); ++f) {
      const int i = f / 2 % n, j = f / 2 / n;
      const int expected = (i >= 10 && i < 20 && j >= 10 && j < 20) - (i >= 30);
      ASSERT_EQ(answer.region[f], expected) << int(boundary) << " " << f;
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(answer.numbers.w.u(f, k), expected, 1e-9);
    }
  }
}

/// A circle of latitude at height z, eastward: north on its left.
Sources latitude(double z, int segments = 100) {
  SpaceCurve curve;
  curve.points.resize(segments + 1, 3);
  for (int i = 0; i <= segments; ++i) {
    const double angle = 2 * std::numbers::pi * (i % segments) / segments, r = std::sqrt(1 - z * z);
    curve.points.row(i) << r * std::cos(angle), r * std::sin(angle), z;
  }
  Sources sources;
  sources.space_curves = {curve};
  return sources;
}

TEST(NonconformingWinding, ConvergesAwayFromTheCurve) {
  for (const int level : {3, 4, 5}) {
    const SurfaceMesh mesh(test::octasphere_soup(level));
    const Sources sources = latitude(0.37);
    const WindingAnswer answer = test::surface_winding(
        mesh, sources, SurfaceWinding{.formulation = Formulation::nonconforming});
    EXPECT_EQ(answer.cut.mesh.n_vertices(), mesh.n_vertices());
    ASSERT_EQ(answer.bounding.size(), 1u);
    const double h = std::numbers::pi / 2 / (1 << level);
    double worst = 0;
    for (int f = 0; f < mesh.n_faces(); ++f)
      for (int k = 0; k < 3; ++k) {
        const double away = mesh.point(mesh.face(f)[k]).z() - 0.37;
        if (std::abs(away) < 0.2) continue;
        worst = std::max(worst, std::abs(answer.numbers.w.u(f, k) - (away > 0)));
        if (std::abs(away) > 2 * h) {
          EXPECT_EQ(answer.region[f], away > 0);
        }
      }
    EXPECT_LT(worst, 0.5 * h) << level;  // first order: gradients on the curve are
    const WindingAnswer back = test::surface_winding(
        mesh, sources.reversed(), SurfaceWinding{.formulation = Formulation::nonconforming});
    int differ = 0;  // halfway cases may be rounded either way
    for (int f = 0; f < mesh.n_faces(); ++f) differ += back.region[f] != -answer.region[f];
    EXPECT_LT(differ, 0.01 * mesh.n_faces());
  }
}

TEST(NonconformingWinding, AlongEdgesBothSidesGetHalf) {
  const SurfaceMesh mesh(test::grid_soup(n, n, 1));
  Sources sources;
  sources.curves = {through_vertices(upward(25, 0, n))};
  const WindingAnswer answer = test::surface_winding(
      mesh, sources, SurfaceWinding{.formulation = Formulation::nonconforming});
  for (int f = 0; f < mesh.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) {
      const double x = mesh.point(mesh.face(f)[k]).x(), away = x - 25.0 / n;
      if (std::abs(away) < 1e-9) {
        EXPECT_NEAR(answer.numbers.w.u(f, k), -0.5, 1e-9);
      }
      if (std::abs(away) > 2.5 / n) {
        EXPECT_NEAR(answer.numbers.w.u(f, k), -(away > 0), 0.02);
      }
    }
}

TEST(NonconformingWinding, SaysWhatItCannot) {
  const SurfaceMesh mesh(test::torus_soup(24, 16));
  Sources sources;
  sources.curves = {through_vertices({0, 1, 17, 16, 0})};
  Report report;
  test::surface_winding(mesh, sources, SurfaceWinding{.formulation = Formulation::nonconforming},
                        report);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].text.find("bound nothing"), std::string::npos);
  EXPECT_THROW(test::surface_winding(mesh, sources,
                                     SurfaceWinding{.formulation = Formulation::nonconforming,
                                                    .labels = Labels::cut}),
               UnsupportedError);
  EXPECT_THROW(test::surface_winding(mesh, sources,
                                     SurfaceWinding{.formulation = Formulation::dual,
                                                    .boundary_condition = BoundaryCondition::free}),
               UnsupportedError);
}

TEST(ResidualPaths, CloseGapsTheShortWay) {
  Report report;
  const SurfaceMesh mesh(test::grid_soup(n, n, 1));
  const JumpCalculus J = jump_calculus(intrinsic_triangulation(mesh, report));
  VecX curve = VecX::Zero(J.n_edges);
  const auto add = [&](const std::vector<int>& line) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const int e = mesh.find_edge(line[i], line[i + 1]);
      curve[e] += mesh.edges()(e, 0) == line[i] ? 1 : -1;
    }
  };
  add(upward(20, 0, 10));  // begins on the boundary
  add(upward(20, 13, 20));
  add(upward(20, 24, 30));  // ends 4 edges from the next, which runs the other way
  std::vector<int> down = upward(24, 20, 30);
  std::reverse(down.begin(), down.end());
  add(down);
  const std::vector<char> path = completing_paths(J, curve, {});
  double length = 0;
  for (int e = 0; e < J.n_edges; ++e) length += path[e] * J.length[e];
  for (const auto& gap : {upward(20, 10, 13), upward(20, 20, 24)})
    for (std::size_t i = 0; i + 1 < gap.size(); ++i)
      EXPECT_TRUE(path[mesh.find_edge(gap[i], gap[i + 1])]);
  // Those gaps, 4 edges between the upper ends, and nothing for the end farther from any start
  // than from the boundary but the way there.
  const double edge = J.length[mesh.find_edge(0, 1)];
  EXPECT_NEAR(length, (3 + 4 + 4 + 16) * edge, 1e-9);
}

TEST(ResidualPaths, AnyEdgeClosesTheGapOfItsSize) {
  // Round a face of a closed surface, one side is missing. That is the shortest way, whichever side
  // it is: edges and nodes count from 0.
  Report report;
  const SurfaceMesh mesh(test::octasphere_soup(0));
  const JumpCalculus J = jump_calculus(intrinsic_triangulation(mesh, report));
  for (const int times : {1, 2})
    for (int f = 0; f < J.n_faces; ++f)
      for (int k = 0; k < 3; ++k) {
        VecX curve = VecX::Zero(J.n_edges);
        for (const int side : {(k + 1) % 3, (k + 2) % 3})
          curve[J.edge(f, side)] = times * J.along(f, side);
        const std::vector<char> path = completing_paths(J, curve, {});
        for (int e = 0; e < J.n_edges; ++e) EXPECT_EQ(path[e], e == J.edge(f, k)) << f << " " << k;
      }
}

TEST(ResidualPaths, FindTheSameNonboundingLoops) {
  constexpr int nu = 24, nv = 16;
  const SurfaceMesh mesh(test::torus_soup(nu, nv));
  std::vector<int> tube, patch;
  for (int j = 0; j + 3 <= nv; ++j) tube.push_back(3 * nv + j);
  for (int i = 8; i < 14; ++i) patch.push_back(i * nv + 2);
  for (int j = 2; j < 9; ++j) patch.push_back(14 * nv + j);
  for (int i = 14; i > 9; --i) patch.push_back(i * nv + 9);
  Sources sources;
  sources.curves = {through_vertices(tube), through_vertices(patch)};
  const WindingAnswer whole = test::surface_winding(mesh, sources);
  const WindingAnswer reduced =
      test::surface_winding(mesh, sources, SurfaceWinding{.residual = Residual::paths});
  EXPECT_EQ(reduced.numbers.bounding, whole.numbers.bounding);
  EXPECT_EQ(reduced.region, whole.region);
  EXPECT_GE(reduced.numbers.objective, whole.numbers.objective - 1e-12);
  ASSERT_EQ(reduced.nonbounding.size(), 1u);
  EXPECT_EQ(reduced.nonbounding[0].rows(), static_cast<Eigen::Index>(tube.size()));
}

}  // namespace
}  // namespace littoral
