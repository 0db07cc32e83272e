// Signed heat on grids: the transform, the calculus, and distances with known answers.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "base/parallel.h"
#include "littoral/error.h"
#include "methods/heat/convolve.h"
#include "methods/heat/signed_heat_grid.h"
#include "solve/multigrid/cosine_transform.h"
#include "solve/multigrid/grid_multipliers.h"
#include "solve/poisson/constrained_poisson.h"
#include "space_helpers.h"

namespace littoral {
namespace {

double node_product(const Grid& grid, int k0, int k1, int k2, int i, int j, int k) {
  return std::cos(M_PI * k0 * (i + 0.5) / grid.n[0]) * std::cos(M_PI * k1 * (j + 0.5) / grid.n[1]) *
         std::cos(M_PI * k2 * (k + 0.5) / grid.n[2]);
}

TEST(CosineTransform, PutsACosineIntoOneCoefficientAndComesBack) {
  for (const std::array<int, 3> n :
       {std::array{5, 4, 7}, std::array{1, 6, 3}, std::array{8, 2, 1}}) {
    const CosineTransform transform(n);
    Grid grid;
    grid.n = n;
    const std::array<int, 3> f{n[0] - 1, n[1] / 2, n[2] / 3};
    VecX v(static_cast<Eigen::Index>(grid.n_nodes()));
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i)
          v[static_cast<Eigen::Index>(grid.node(i, j, k))] =
              node_product(grid, f[0], f[1], f[2], i, j, k);
    VecX c = v;
    transform.forward(c, Task());
    EXPECT_NEAR(c.norm(), v.norm(), 1e-12 * v.norm());
    Eigen::Index largest = 0;
    c.cwiseAbs().maxCoeff(&largest);
    EXPECT_NEAR(std::abs(c[largest]), v.norm(), 1e-12 * v.norm());
    EXPECT_EQ(transform.frequencies(0)[largest % n[0]], f[0]);
    EXPECT_EQ(transform.frequencies(2)[largest / (n[0] * n[1])], f[2]);
    transform.backward(c, Task());
    EXPECT_LT((c - v).norm(), 1e-12 * v.norm());
  }
}

/// L as a matrix: differences along edges, G^T G.
SpMat laplacian(const Grid& grid) {
  Triplets entries;
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) {
        const int a = static_cast<int>(grid.node(i, j, k));
        const std::array<int, 3> at{i, j, k};
        for (int d = 0; d < 3; ++d) {
          const auto s = static_cast<std::size_t>(d);
          if (at[s] + 1 == grid.n[s]) continue;
          const int b = static_cast<int>(grid.node(i + (d == 0), j + (d == 1), k + (d == 2)));
          const double w = 1 / (grid.spacing[d] * grid.spacing[d]);
          entries.emplace_back(a, a, w);
          entries.emplace_back(b, b, w);
          entries.emplace_back(a, b, -w);
          entries.emplace_back(b, a, -w);
        }
      }
  SpMat L(static_cast<Eigen::Index>(grid.n_nodes()), static_cast<Eigen::Index>(grid.n_nodes()));
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

Grid odd_grid() {
  Grid grid;
  grid.n = {7, 5, 6};
  grid.spacing = Vec3(0.3, 0.5, 0.2);
  grid.origin = Vec3(1, 2, 3);
  return grid;
}

TEST(GridPoisson, InvertsTheDifferencesAlongEdgesWithAnySpacing) {
  const Grid grid = odd_grid();
  VecX b = VecX::Random(static_cast<Eigen::Index>(grid.n_nodes()));
  b.array() -= b.mean();
  VecX x = b;
  GridPoisson(grid.n, grid.spacing).solve(x, Task());
  EXPECT_LT((laplacian(grid) * x - b).norm(), 1e-11 * b.norm());
  EXPECT_NEAR(x.mean(), 0, 1e-12);
}

TEST(GridPoisson, SinglePrecisionAgreesToItsDigits) {
  const Grid grid = odd_grid();
  VecX b = VecX::Random(static_cast<Eigen::Index>(grid.n_nodes()));
  b.array() -= b.mean();
  Eigen::VectorXf single = b.cast<float>();
  GridPoisson(grid.n, grid.spacing).solve(b, Task());
  GridPoisson<float>(grid.n, grid.spacing).solve(single, Task());
  EXPECT_LT((single.cast<double>() - b).norm(), 3e-6 * b.norm());
}

TEST(GridOperators, DivergenceOfAConstantFieldIsThatOfALinearFunction) {
  // If Y is the gradient of a linear function, L phi = G^T Y has exactly that function as solution.
  const Grid grid = odd_grid();
  const Vec3 y(0.6, -0.48, 0.64);
  const Directions Y =
      y.transpose().cast<float>().replicate(static_cast<Eigen::Index>(grid.n_nodes()), 1);
  VecX phi = grid_divergence(grid, Y);
  GridPoisson(grid.n, grid.spacing).solve(phi, Task());
  const double at0 = phi[0];
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i)
        EXPECT_NEAR(phi[static_cast<Eigen::Index>(grid.node(i, j, k))] - at0,
                    y.dot(grid.point(i, j, k) - grid.origin), 1e-6);
}

TEST(GridOperators, RowsReproduceLinearFunctionsAndSkipPointsOutside) {
  const Grid grid = odd_grid();
  MatX3 points(4, 3);
  points << 1.1, 2.3, 3.1, 1.15, 2.4, 3.15, 2.8, 4, 4, 9, 9, 9;
  const GridRows rows = grid_rows(grid, points, Eigen::Vector4d(1, 3, 2, 1));
  ASSERT_EQ(rows.A.rows(), 2);  // two share a cell, one is outside
  VecX f(static_cast<Eigen::Index>(grid.n_nodes()));
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i)
        f[static_cast<Eigen::Index>(grid.node(i, j, k))] = Vec3(1, -2, 3).dot(grid.point(i, j, k));
  const VecX values = rows.A * f;
  const Vec3 mean = (points.row(0) + 3 * points.row(1)).transpose() / 4;
  EXPECT_NEAR(values[0], Vec3(1, -2, 3).dot(mean), 1e-12);
  EXPECT_NEAR(values[1], Vec3(1, -2, 3).dot(points.row(2).transpose()), 1e-12);
  EXPECT_EQ(rows.weight[0], 4);
}

/// A Poisson equation on a grid, with samples that its solution is held at.
struct HeldGrid {
  Grid grid = odd_grid();
  Eigen::Index n = static_cast<Eigen::Index>(grid.n_nodes());
  GridRows rows = grid_rows(
      grid, (test::random_points(9, 0.5).rowwise() + Eigen::RowVector3d(1.8, 3, 3.5)).eval(),
      VecX::Ones(9));
  Eigen::Index m = rows.A.rows();
  VecX b = balanced(VecX::Random(n));
  GridPoisson<> poisson{grid.n, grid.spacing};

  static VecX balanced(const VecX& b) { return b.array() - b.mean(); }
};

TEST(HeldPoisson, AgreesWithTheSaddlePointSystem) {
  const HeldGrid held{};
  const auto& [grid, n, rows, m, b, poisson] = held;
  const auto solve = [&held](VecX& v) { held.poisson.solve(v, Task()); };
  for (const double soft : {0.0, 0.01}) {
    VecX x0 = b;
    solve(x0);
    Report report;
    const VecX x =
        solve_constrained(solve, x0, {rows.A, VecX::Constant(m, soft), 1e-13}, Task(), report);
    EXPECT_EQ(report.status, "converged");
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + m, n + m);
    K.topLeftCorner(n, n) = laplacian(grid);
    K.bottomLeftCorner(m, n) = rows.A;
    K.topRightCorner(n, m) = Eigen::MatrixXd(rows.A).transpose();
    K.bottomRightCorner(m, m).diagonal().setConstant(-soft);
    VecX rhs = VecX::Zero(n + m);
    rhs.head(n) = b;
    const VecX exact = K.fullPivLu().solve(rhs).head(n);
    EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-9 * exact.cwiseAbs().maxCoeff());
  }
}

TEST(HeldPoisson, StopsBetweenTheLastIterationAndTheCorrection) {
  const HeldGrid held{};
  int solves = 0, stop_at = -1;
  CancelToken token;
  const auto solve = [&](VecX& v) {
    held.poisson.solve(v, Task());
    if (++solves == stop_at) token.cancel();
  };
  VecX x = held.b;
  held.poisson.solve(x, Task());
  const ConstraintRows rows{held.rows.A, VecX::Zero(held.m), 1e-10};
  Report report;
  solve_constrained(solve, x, rows, Task(), report);
  ASSERT_GT(solves, 2);
  stop_at = solves - 1;
  solves = 0;
  EXPECT_THROW(solve_constrained(solve, x, rows, Task(token), report), Cancelled);
  EXPECT_EQ(solves, stop_at);
}

TEST(HeldPoisson, OneValueAlongEachGroupAgreesWithTheSaddlePointSystem) {
  // Unknowns x, multipliers and a constant for each group: A x - B c = 0.
  const HeldGrid held{};
  const auto& [grid, n, rows, m, b, poisson] = held;
  ASSERT_GE(m, 4);
  std::vector<int> group(static_cast<std::size_t>(m));
  for (Eigen::Index r = 0; r < m; ++r) group[r] = r % 2;
  const auto solve = [&held](VecX& v) { held.poisson.solve(v, Task()); };
  VecX x = b;
  solve(x);
  Report report;
  x = solve_constrained(solve, x, {rows.A, VecX::Zero(m), 1e-13, group}, Task(), report);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + m + 2, n + m + 2);
  K.topLeftCorner(n, n) = laplacian(grid);
  K.block(n, 0, m, n) = rows.A;
  K.block(0, n, n, m) = Eigen::MatrixXd(rows.A).transpose();
  for (Eigen::Index r = 0; r < m; ++r) K(n + r, n + m + r % 2) = K(n + m + r % 2, n + r) = -1;
  VecX rhs = VecX::Zero(n + m + 2);
  rhs.head(n) = b;
  VecX exact = VecX(K.fullPivLu().solve(rhs)).head(n);  // up to a constant
  exact.array() += x[0] - exact[0];
  EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-9 * exact.cwiseAbs().maxCoeff());
}

TEST(HeldPoisson, BlocksOfCellsSaveMostIterationsAndChangeNothing) {
  const Grid grid = test::cube_grid(33, 1.2);
  const OrientedPoints sphere = test::sphere_samples(5);
  const GridRows rows = grid_rows(grid, sphere.points, sphere.areas);
  const double softness = grid.spacing.prod() * 0.02;
  const ConstraintRows held{rows.A, softness * rows.weight.cwiseInverse(), 1e-8};
  const GridPoisson<> poisson{grid.n, grid.spacing};
  const auto solve = [&poisson](VecX& v) { poisson.solve(v, Task()); };
  VecX x = VecX::Random(index(grid.n_nodes()));
  x.array() -= x.mean();
  solve(x);
  const GridMultipliers blocks(grid.n, grid.spacing, rows.A, rows.weight, held.softness);
  Report plain, report;
  const VecX expected = solve_constrained(solve, x, held, Task(), plain);
  const VecX found = solve_constrained(solve, x, held, Task(), report,
                                       [&](const VecX& r) { return blocks(r, Task()); });
  EXPECT_EQ(report.status, "converged");
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 10 * held.tolerance);
  EXPECT_LT(report.iterations[0].second, plain.iterations[0].second / 2);
}

TEST(Convolution, FarDirectionIsThatOfTheNearestSampleAndNeverUnderflows) {
  OrientedPoints two;
  two.points.resize(2, 3);
  two.points << 0, 0, 0, 1, 0, 0;
  two.normals.resize(2, 3);
  two.normals << 0, 0, 1, 0, 1, 0;
  two.areas = Eigen::Vector2d(1, 1);
  const Convolution X(two, 0.01);
  const Flow far = X(Vec3(-1e5, 0, 3));
  EXPECT_LT((far.direction - Vec3(0, 0, 1)).norm(), 1e-6);
  EXPECT_NEAR(far.distance, std::hypot(1e5, 3), 1e-6);
  // Halfway, both weigh the same.
  EXPECT_LT((X(Vec3(0.5, 0, 0)).direction - Vec3(0, 1, 1).normalized()).norm(), 1e-5);
}

TEST(Convolution, EqualsTheSumOfKernels) {
  const OrientedPoints sphere = test::sphere_samples(2);
  const double root_t = 0.2;
  const Convolution X(sphere, root_t);
  const MatX3 queries = test::random_points(50, 1.5);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    Vec3 sum = Vec3::Zero();
    for (Eigen::Index s = 0; s < sphere.size(); ++s) {
      const double r = (queries.row(i) - sphere.points.row(s)).norm();
      sum += sphere.areas[s] * std::exp(-r / root_t) / r * sphere.normals.row(s).transpose();
    }
    EXPECT_LT((X(queries.row(i)).direction - sum.normalized()).norm(), 2e-5);
  }
}

TEST(SampleDirections, InterpolationStaysCloseToEvaluationEverywhere) {
  const Grid grid = test::cube_grid(41, 2);
  const Convolution X(test::sphere_samples(4), 0.1);
  Report report;
  const Directions Y = sample_directions(
      grid,
      [&](const Vec3& x, double& d) {
        const Flow flow = X(x);
        d = flow.distance;
        return flow.direction;
      },
      Task(), report);
  double worst = 0;
  for (int k = 0; k < 41; k += 3)
    for (int j = 0; j < 41; j += 3)
      for (int i = 0; i < 41; i += 3) {
        const Vec3 x = grid.point(i, j, k);
        if (x.norm() < 0.2) continue;  // the medial axis of the sphere
        const Vec3 y = Y.row(static_cast<Eigen::Index>(grid.node(i, j, k))).cast<double>();
        worst = std::max(worst, (y - X(x).direction).norm());
      }
  EXPECT_LT(worst, 0.03);
  EXPECT_LT(report.sizes.back().second, 0.5 * static_cast<double>(grid.n_nodes()));
}

TEST(SignedHeatGridSlow, SphereErrorFallsWithTheSpacing) {
  // Observed order over two halvings, samples refined along with the grid.
  const auto error = [](int n, int level, SpaceConstraint constraint) {
    const Grid grid = test::cube_grid(n, 2);
    SpaceSignedHeat options;
    options.constraint = constraint;
    Report report;
    const VecX phi = signed_heat_grid(grid, test::sphere_samples(level), options, Task(), report);
    return test::mean_error(grid, phi, [](const Vec3& x) { return x.norm() - 1; });
  };
  for (const auto constraint :
       {SpaceConstraint::none, SpaceConstraint::zero_set, SpaceConstraint::soft}) {
    const double coarse = error(17, 3, constraint), fine = error(65, 5, constraint);
    EXPECT_GT(std::log2(coarse / fine) / 2, 1.2);
    EXPECT_LT(fine, 1e-3);
  }
}

TEST(SignedHeatGrid, SameBitsForAnyNumberOfThreads) {
  const Grid grid = test::cube_grid(23, 1.7);
  const OrientedPoints sphere = test::sphere_samples(3);
  Report report;
  set_thread_count(1);
  const VecX one = signed_heat_grid(grid, sphere, {}, Task(), report);
  set_thread_count(5);
  const VecX five = signed_heat_grid(grid, sphere, {}, Task(), report);
  set_thread_count(0);
  EXPECT_TRUE(one == five);
}

TEST(SignedHeatGrid, SoftConstraintLiesBetweenNoneAndZeroSet) {
  // Two parallel planes of one orientation cannot both be zero: the constraint forces them.
  OrientedPoints planes;
  planes.points.resize(2 * 15 * 15, 3);
  for (int i = 0; i < planes.points.rows(); ++i)
    planes.points.row(i) << -0.7 + 0.1 * (i % 15), -0.7 + 0.1 * (i / 15 % 15),
        (i < 225 ? -0.25 : 0.25);
  planes.normals = Eigen::RowVector3d(0, 0, 1).replicate(planes.points.rows(), 1);
  planes.areas = VecX::Constant(planes.points.rows(), 0.01);
  const Grid grid = test::cube_grid(21, 1);
  std::vector<int> sheets(450, 0);
  std::fill(sheets.begin() + 225, sheets.end(), 1);
  const auto spread = [&](SpaceConstraint constraint, double soft) {
    SpaceSignedHeat options;
    options.constraint = constraint;
    options.soft = soft;
    Report report;
    const bool levels = constraint == SpaceConstraint::level_sets;
    const VecX phi = signed_heat_grid(grid, planes, options, Task(), report,
                                      levels ? sheets : std::vector<int>());
    const GridRows rows = grid_rows(grid, planes.points, planes.areas, sheets);
    const VecX at = rows.A * phi;
    if (levels) {  // each at one value, zero between them
      for (const int sheet : {0, 1})
        for (Eigen::Index r = 0; r < at.size(); ++r)
          if (rows.part[r] == sheet) {
            EXPECT_NEAR(at[r], at[at.size() - 1] * (sheet == 0 ? -1 : 1), 0.005);
          }
    }
    return at.maxCoeff() - at.minCoeff();
  };
  const double none = spread(SpaceConstraint::none, 1), held = spread(SpaceConstraint::zero_set, 1);
  const double weak = spread(SpaceConstraint::soft, 0.1);
  const double strong = spread(SpaceConstraint::soft, 100);
  EXPECT_NEAR(none, 0.5, 0.1);
  EXPECT_NEAR(spread(SpaceConstraint::level_sets, 0), 0.5, 0.05);
  EXPECT_LT(held, 0.05);
  EXPECT_LT(strong, weak);
  EXPECT_LT(weak, none);
}

TEST(SignedHeatGrid, StopsWhenAsked) {
  const CancelToken token;
  token.cancel();
  Report report;
  EXPECT_THROW(
      signed_heat_grid(test::cube_grid(17, 2), test::sphere_samples(2), {}, Task(token), report),
      Cancelled);
}

}  // namespace
}  // namespace littoral
