// What solvers say about where they stopped.

#include <gtest/gtest.h>

#include <array>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "solve/optimization/pdhg.h"
#include "sources/p2_sources.h"

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
}

}  // namespace
}  // namespace littoral
