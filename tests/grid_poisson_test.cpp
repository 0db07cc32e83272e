// Poisson equations on grids: the transform, operators, and values held at rows.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "base/index.h"
#include "operators/grid.h"
#include "solve/multigrid/cosine_transform.h"
#include "solve/multigrid/grid_multipliers.h"
#include "solve/multigrid/held_grid.h"
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
       {std::array{5, 4, 7}, std::array{1, 6, 3}, std::array{8, 2, 1}, std::array{33, 20, 48}}) {
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

TEST(CosineLines, AgreeWithTheSumsAndComeBack) {
  constexpr int width = CosineLines<double>::width;
  for (const int n : {1, 2, 3, 6, 9, 16, 22, 31, 40, 96}) {
    const CosineLines<double> lines(n);
    std::vector<double> panel(n * width), room(panel.size());
    for (std::size_t i = 0; i < panel.size(); ++i) panel[i] = std::sin(1.7 * i * i);
    const std::vector<double> values = panel;
    lines.forward(panel.data(), room.data());
    std::vector<int> seen(n, 0);
    for (int at = 0; at < n; ++at) {
      const int frequency = lines.frequencies()[at];
      ++seen[frequency];
      for (int r = 0; r < width; ++r) {
        double sum = 0;
        for (int j = 0; j < n; ++j)
          sum += values[j * width + r] * std::cos(M_PI * frequency * (j + 0.5) / n);
        EXPECT_NEAR(panel[at * width + r], std::sqrt((frequency == 0 ? 1.0 : 2.0) / n) * sum,
                    1e-12);
      }
    }
    EXPECT_EQ(seen, std::vector<int>(n, 1));
    lines.backward(panel.data(), room.data());
    for (std::size_t i = 0; i < panel.size(); ++i) EXPECT_NEAR(panel[i], values[i], 1e-13);
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

TEST(GridOperators, RowsEndWithTheBox) {
  const Grid grid = odd_grid();
  const Vec3 last(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1);
  const Vec3 middle = grid.origin + 0.5 * last.cwiseProduct(grid.spacing);
  for (int a = 0; a < 3; ++a)
    for (const bool high : {false, true}) {
      const double rim = grid.origin[a] + (high ? last[a] * grid.spacing[a] : 0);
      for (const double out : {0.0, 1e-9, 0.5, 1.5}) {
        MatX3 point = middle.transpose();
        point(0, a) = rim + (high ? out : -out) * grid.spacing[a];
        if (out == 0) point(0, a) -= (high ? 1e-12 : -1e-12) * grid.spacing[a];  // for rounding
        EXPECT_EQ(grid_rows(grid, point, VecX::Ones(1)).A.rows(), out == 0) << a << high << out;
      }
    }
}

/// A Poisson equation on a grid, with samples that its solution is held at.
struct HeldSamples {
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

TEST(HeldGrid, IsTheInverseBetweenRows) {
  // Rows in one corner of the grid, so that most lines are left out.
  const Grid grid = test::cube_grid(40, 1);
  const GridRows rows = grid_rows(
      grid, (test::random_points(30, 0.2).rowwise() + Eigen::RowVector3d(0.5, 0.4, -0.6)).eval(),
      VecX::Ones(30));
  VecX v = VecX::Random(rows.A.rows());
  v.array() -= v.mean();
  VecX expected = rows.A.transpose() * v;
  GridPoisson(grid.n, grid.spacing).solve(expected, Task());
  HeldGrid held(grid.n, grid.spacing, rows.A);
  for (int round = 0; round < 2; ++round) {  // what the first leaves behind does not matter
    const VecX across = held.across(v, Task());
    const VecX off = across - rows.A * expected;
    EXPECT_LT((off.array() - off.mean()).matrix().norm(), 1e-5 * across.norm());
    VecX x = VecX::Zero(expected.size());
    held.subtract(x, v, Task());
    EXPECT_LT((x + expected).norm(), 1e-5 * expected.norm());
  }
}

TEST(HeldPoisson, AgreesWithTheSaddlePointSystem) {
  const HeldSamples held{};
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
  const HeldSamples held{};
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
  const HeldSamples held{};
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

}  // namespace
}  // namespace littoral
