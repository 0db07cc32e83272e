// What solvers say about where they stopped.

#include <gtest/gtest.h>

#include <array>

#include "api/report_json.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/error.h"
#include "solve/optimization/pdhg.h"
#include "sources/surface/p2_sources.h"

namespace littoral {
namespace {

/// max b . u over the unit disk, in steps that are not exact.
struct LinearOnDisk {
  BallQuadraticEnergy ball{2, 0, 0, VecX()};
  SplitProblem problem;

  LinearOnDisk() {
    problem.b = Eigen::Vector2d(3, 1);
    problem.A = VecX::Ones(1);
    problem.G.resize(2, 2);
    problem.G.setIdentity();
    problem.solve = [](const VecX& b, double rho) { return VecX(b / rho); };
    problem.energy = &ball;
  }
};

TEST(Admm, ConvergedSaysWhetherTheGapIsBelowTheOneAskedFor) {
  const LinearOnDisk disk;
  AdmmOptions options;
  options.relative = options.absolute = 0;
  options.gap = 1e-3;
  bool reached = false;
  for (options.max_iterations = 1; options.max_iterations < 60; ++options.max_iterations) {
    AdmmState state;
    const AdmmResult result = admm(disk.problem, options, state, Task());
    EXPECT_EQ(result.converged, result.gap <= options.gap) << options.max_iterations;
    reached = reached || result.converged;
  }
  EXPECT_TRUE(reached);
}

TEST(Admm, SmallResidualsDoNotHideALargeGap) {
  const LinearOnDisk disk;
  AdmmOptions options;
  options.rho = 100;  // short steps
  options.relative = 1;
  options.absolute = 10;  // met at once
  AdmmState state;
  const AdmmResult early = admm(disk.problem, options, state, Task());
  EXPECT_TRUE(early.converged);
  EXPECT_GT(early.gap, 1e-3);
  options.certified = 1e-3;
  state = {};
  const AdmmResult later = admm(disk.problem, options, state, Task());
  EXPECT_TRUE(later.converged);
  EXPECT_LE(later.gap, 1e-3);
  options.max_iterations = early.iterations;
  state = {};
  EXPECT_FALSE(admm(disk.problem, options, state, Task()).converged);
}

TEST(Pdhg, ResidualsOfFewIterationsAreReported) {
  const LinearOnDisk disk;
  AdmmOptions options;
  options.relative = 1e-12;
  for (options.max_iterations = 1; options.max_iterations < 12; ++options.max_iterations) {
    const AdmmResult result = pdhg(disk.problem, VecX::Ones(2), VecX::Zero(2), options, Task());
    EXPECT_FALSE(result.converged);
    EXPECT_GT(std::max(result.primal, result.dual), 0) << options.max_iterations;
  }
}

TEST(P2Sources, RepeatedPointsCountOnce) {
  PolygonSoup soup;
  soup.points.resize(4, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  soup.add_face(std::array{0, 1, 2});
  soup.add_face(std::array{0, 2, 3});
  const SurfaceMesh mesh(std::move(soup));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  PlacedSources sources;
  sources.points = {SurfacePoint::in_face(0, 0.2, 0.3, 0.5), SurfacePoint::at_vertex(0),
                    SurfacePoint::in_face(0, 0.2, 0.3, 0.5),
                    SurfacePoint::in_face(0, 0.3, 0.2, 0.5), SurfacePoint::at_vertex(0)};
  EXPECT_EQ(p2_sources(mesh, T, sources, 0).size(), 3u);
  sources.points.push_back(SurfacePoint::in_face(0, 0.2 + 1e-12, 0.3 - 1e-12, 0.5));
  EXPECT_EQ(p2_sources(mesh, T, sources, 0).size(), 3u);
}

TEST(P2Sources, SpacingHasALowerBound) {
  PolygonSoup soup;
  soup.points.resize(3, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  soup.add_face(std::array{0, 1, 2});
  const SurfaceMesh mesh(std::move(soup));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  Sources curve;
  curve.add(Curve::along_vertices({0, 1}));
  const PlacedSources placed = place_sources(mesh, curve, report);
  EXPECT_THROW(p2_sources(mesh, T, placed, 1e-9), InputError);
  EXPECT_GT(p2_sources(mesh, T, placed, 0.01).size(), 50u);
}

TEST(ReportJson, KeepsTheLargestOfResidualsNamedTwice) {
  Report report;
  report.residuals = {{"poisson", 1e-3}, {"poisson", 1e-9}, {"constraints", 2.5}};
  const std::string text = report_json(report);
  EXPECT_NE(text.find("\"poisson\": 0.001"), std::string::npos) << text;
  EXPECT_EQ(text.find("1e-09"), std::string::npos);
}

}  // namespace
}  // namespace littoral
