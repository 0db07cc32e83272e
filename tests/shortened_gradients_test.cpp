// Gradients that are a little too long in a few cells, shortened around them.

#include "solve/optimization/shortened_gradients.h"

#include <gtest/gtest.h>

#include "regularized_helpers.h"
#include "solve/optimization/admm.h"
#include "test_meshes.h"

namespace littoral {
namespace {

constexpr int side = 24;  // squares

/// u = x on a unit square, and one node in the middle too high by a tenth of a side.
struct Raised {
  SplitProblem problem;
  SpRows D;
  VecX x, u;
  MatX3 points;
  int node = 12 * (side + 1) + 12;

  Raised() {
    const SurfaceMesh mesh(test::grid_soup(side, side));
    Report report;
    const test::Problem p = test::problem(mesh, test::vertex_points({0}), report);
    points = mesh.points();
    problem.A = p.ops->scalar.A;
    problem.G = p.ops->scalar.G.matrix();
    D = problem.divergence();
    x = points.col(0) / p.ops->unit;
    u = x;
    u[node] += 0.1 / side / p.ops->unit;
  }

  std::optional<VecX> shortened(const VecX& from, const std::vector<char>& fixed) const {
    return with_shortened_gradients({problem.G, D, problem.A, 2}, from, problem.G * from, fixed,
                                    1.005, {});
  }
  double longest(const VecX& of) const {
    const VecX g = problem.G * of;
    double most = 0;
    for (Eigen::Index c = 0; c < problem.A.size(); ++c)
      most = std::max(most, g.segment<2>(2 * c).norm());
    return most;
  }
};

TEST(ShortenedGradients, AreWithinTheLimitAndOnlyNeighboursMove) {
  const Raised raised;
  ASSERT_GT(raised.longest(raised.u), 1.05);
  const auto u = raised.shortened(raised.u, std::vector<char>(raised.u.size(), 0));
  ASSERT_TRUE(u);
  EXPECT_LE(raised.longest(*u), 1.005);
  const double step = raised.u[raised.node] - raised.x[raised.node];
  for (Eigen::Index v = 0; v < u->size(); ++v) {
    EXPECT_LE(std::abs((*u)[v] - raised.x[v]), step) << v;
    const double away = (raised.points.row(v) - raised.points.row(raised.node)).norm() * side;
    if (away > 9) {
      EXPECT_EQ((*u)[v], raised.u[v]) << v;
    }
  }
}

TEST(ShortenedGradients, HeldUnknownsStay) {
  const Raised raised;
  std::vector<char> fixed(raised.u.size(), 0);
  fixed[raised.node] = 1;
  const auto u = raised.shortened(raised.u, fixed);
  ASSERT_TRUE(u);
  EXPECT_EQ((*u)[raised.node], raised.u[raised.node]);
  // Gradients around have next to no room, so that the step is spread over them.
  EXPECT_LE(raised.longest(*u), 1.03);
  // If everything is held nothing helps.
  EXPECT_FALSE(raised.shortened(raised.u, std::vector<char>(raised.u.size(), 1)));
}

TEST(ShortenedGradients, NothingIsDoneWhereNoneOrMostAreTooLong) {
  const Raised raised;
  const std::vector<char> fixed(raised.u.size(), 0);
  EXPECT_FALSE(raised.shortened(raised.x, fixed));
  EXPECT_FALSE(raised.shortened(2 * raised.u, fixed));
}

TEST(ShortenedGradients, TheGapOfADistanceClosesSooner) {
  const SurfaceMesh mesh(test::torus_soup(40, 24));
  Regularized options = test::with_alpha(0.02);
  options.gap = 0.002;
  const test::Solved solved = test::solve(mesh, test::vertex_points({7, 300}), options);
  EXPECT_LE(test::residual(solved.report, "duality gap"), options.gap);
  for (const auto& [loop, count] : solved.report.iterations)
    EXPECT_TRUE(loop != "admm" || count <= 100) << count;  // 60 were seen, and 220 without
}

}  // namespace
}  // namespace littoral
