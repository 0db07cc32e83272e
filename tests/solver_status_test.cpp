// What solvers say about where they stopped.

#include <gtest/gtest.h>

#include <array>
#include <vector>

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

/// Whether it would have converged in iteration k, the last, which is always looked at.
bool converged_in(const SplitProblem& problem, AdmmOptions options, int k) {
  options.max_iterations = k;
  AdmmState state;
  return admm(problem, options, state, Task()).converged;
}

/// How often it looks: runs end in the first iteration that is 1, where that counts, or a multiple
/// of `every` and after which it has converged. Asserts that some runs could have ended between.
void expect_looks(const AdmmOptions& options, double AdmmOptions::*limit, double most, double least,
                  bool at_first, int every) {
  const LinearOnDisk disk;
  int between = 0;
  AdmmOptions one = options;
  for (one.*limit = most; one.*limit > least; one.*limit *= 0.8) {
    int expected = at_first ? 1 : every, first = 1;
    while (!converged_in(disk.problem, one, expected))
      ASSERT_LT(expected += expected == 1 ? every - 1 : every, 200);
    while (!converged_in(disk.problem, one, first)) ++first;
    AdmmState state;
    const AdmmResult result = admm(disk.problem, one, state, Task());
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.iterations, expected) << one.*limit;
    between += first < expected;
  }
  EXPECT_GT(between, 3);
}

TEST(Admm, ResidualsAreLookedAtInTheFirstIterationAndEveryFifth) {
  AdmmOptions options;
  options.rho = 100;  // short steps
  options.relative = 0;
  options.penalty_changes = 0;
  expect_looks(options, &AdmmOptions::absolute, 100, 0.05, true, 5);
}

TEST(Admm, AGapIsLookedAtEveryTwentiethIteration) {
  AdmmOptions options;
  options.rho = 100;
  options.relative = 0;
  options.absolute = -1;  // never met
  options.penalty_changes = 0;
  expect_looks(options, &AdmmOptions::gap, 0.5, 1e-3, false, 20);
}

TEST(Admm, CellsGetPenaltiesAnewAfterThirtyIterationsOrHalfOfAll) {
  LinearOnDisk disk;
  int iterations = 0;
  std::vector<int> after;
  const auto solve = disk.problem.solve;
  disk.problem.solve = [&](const VecX& b, double rho) {
    ++iterations;
    return solve(b, rho);
  };
  disk.problem.solve_cells = [&](const VecX& rho, const SpRows&) -> SplitProblem::Solve {
    after.push_back(iterations);
    return [&, one = rho[0]](const VecX& b) {
      ++iterations;
      return solve(b, one);
    };
  };
  AdmmOptions options;
  options.absolute = -1;  // never met
  options.relative = 0;
  options.max_iterations = 250;
  AdmmState state;
  EXPECT_EQ(admm(disk.problem, options, state, Task()).iterations, 250);
  EXPECT_EQ(after, (std::vector<int>{10, 30, 60, 90, 135, 205}));
  // With a start nearby also before the first.
  iterations = 0;
  after.clear();
  disk.problem.near_gradient = disk.problem.near_multipliers = Eigen::Vector2d(0.6, 0.8);
  state = {};
  admm(disk.problem, options, state, Task());
  EXPECT_EQ(after, (std::vector<int>{0, 10, 30, 60, 90, 135, 205}));
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
