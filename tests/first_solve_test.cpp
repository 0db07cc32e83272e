// What the first solve of a mesh is made of: small fronts, factors made with their constraints, and
// the queue of fast marching.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/falling_keys.h"
#include "base/index.h"
#include "operators/triangles.h"
#include "solve/direct/supernode_kernels.h"
#include "solve/poisson/poisson.h"
#include "test_meshes.h"

namespace littoral {
namespace {

template <class Scalar>
void expect_factors(int n, int below) {
  using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  const int height = n + below;
  const Dense R = Dense::Random(height, height);
  const Dense F = R * R.adjoint() + Dense::Identity(height, height);
  Dense block = F.leftCols(n), C = F.bottomRightCorner(below, below);
  const Dense above =
      Dense::Constant(below, below, Scalar(7)).template triangularView<Eigen::StrictlyUpper>();
  C = Dense(C.template triangularView<Eigen::Lower>()) + above;
  ASSERT_TRUE(dense::factor_small(n, height, block.data(), C.data()));
  const Dense L = block.topRows(n).template triangularView<Eigen::Lower>();
  const Dense A = block.bottomRows(below);
  const double size = F.cwiseAbs().maxCoeff();
  EXPECT_LE((L * L.adjoint() - F.topLeftCorner(n, n)).cwiseAbs().maxCoeff(), 1e-13 * size);
  const Dense lower = Dense(-A * A.adjoint()).template triangularView<Eigen::Lower>();
  if (below > 0) {
    EXPECT_LE((A * L.adjoint() - F.bottomLeftCorner(below, n)).cwiseAbs().maxCoeff(), 1e-13 * size);
    EXPECT_LE((C - lower - above).cwiseAbs().maxCoeff(), 1e-13 * size);  // nothing above it
    for (int i = 0; i < below; ++i) EXPECT_EQ(std::imag(C(i, i)), 0);
  }
  block = F.leftCols(n);
  block(n - 1, n - 1) = -1;
  EXPECT_FALSE(dense::factor_small(n, height, block.data(), C.data()));
  block(n - 1, n - 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(dense::factor_small(n, height, block.data(), C.data()));
}

TEST(FirstSolve, SmallFrontsAreFactoredAsDenseMatricesAre) {
  for (int n = 1; n <= dense::small_supernode; ++n)
    for (const int below : {0, 1, 2, 3, 4, 5, 7, 8, 9, 30, 61}) {
      SCOPED_TRACE(std::to_string(n) + " columns, rows below: " + std::to_string(below));
      expect_factors<double>(n, below);
      expect_factors<Complex>(n, below);
    }
}

TEST(FirstSolve, KeysThatFallComeInTheOrderOfASet) {
  std::mt19937 random(3);
  const int n = 200;
  const double never = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 20; ++round) {
    FallingKeys queue(n);
    std::set<std::pair<double, int>> set;
    std::vector<double> key(n, never);  // never: does not wait
    for (int step = 0; step < 3000; ++step) {
      const int i = static_cast<int>(random() % n);
      const double next = static_cast<double>(random() % 50);  // many are equal
      if (random() % 3 == 0 && !set.empty()) {
        const auto [least, first] = *set.begin();
        set.erase(set.begin());
        key[first] = never;
        ASSERT_EQ(queue.take(), first);
      } else if (next < key[i]) {
        set.erase({key[i], i});
        set.insert({next, i});
        key[i] = next;
        queue.put(i, next);
      }
      ASSERT_EQ(queue.empty(), set.empty());
    }
  }
}

TEST(FirstSolve, AFactorMadeWithItsConstraintsHasTheBitsOfAPatchedOne) {
  const SurfaceMesh mesh(test::grid_soup(30, 30));
  Report report;
  const Calculus C = triangle_operators(intrinsic_triangulation(mesh, report)).scalar;
  const auto poisson = [&](PoissonSolver solver) {
    return Poisson(C.L, C.component, C.n_components, {}, {}, solver);
  };
  const Poisson one = poisson(PoissonSolver::automatic_for_one_solve),
                many = poisson(PoissonSolver::automatic);
  EXPECT_EQ(one.nonzeros(), many.nonzeros());
  VecX b = VecX::Random(C.L.rows());
  b.array() -= b.mean();
  const auto held = [&](int from, double w) {
    SpMat A(5, C.L.cols());
    for (int r = 0; r < 5; ++r) A.insert(r, from + 3 * r) = w;
    A.makeCompressed();
    return A;
  };
  const std::vector<int> group(5, 0);
  Report a, c;
  // The same rows again, others, and rows of the same places with other numbers.
  const std::vector<std::pair<int, double>> asked = {{40, 1}, {40, 1}, {200, 1}, {40, 1}, {40, 2}};
  for (const auto& [from, w] : asked) {
    const SpMat A = held(from, w);
    const VecX value = VecX::LinSpaced(5, 0, 1);
    EXPECT_EQ(one.solve_levels(b, {A, group, {1}, value}, {}, a),
              many.solve_levels(b, {A, group, {1}, value}, {}, c));
    EXPECT_EQ(one.solve_soft(b, A, VecX::Constant(5, 3), {}, a, value),
              many.solve_soft(b, A, VecX::Constant(5, 3), {}, c, value));
  }
  EXPECT_EQ(one.solve(b, a), many.solve(b, c));
}

}  // namespace
}  // namespace littoral
