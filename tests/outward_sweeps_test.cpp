// Relaxation outward from the source, against a closed form and against a factor.

#include "solve/heat/outward_sweeps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solve/direct/cholesky.h"

namespace littoral {
namespace {

/// -x_(i-1) + (2 + s) x_i - x_(i+1) on a chain with nothing beyond its ends.
SpMat chain(int n, double s) {
  Triplets entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 2 + s);
    if (i + 1 < n) entries.emplace_back(i + 1, i, -1);
  }
  SpMat A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

TEST(OutwardSweeps, AreExactHoweverFarHeatHasFallen) {
  // x_i = sinh((n - i) theta) / sinh((n + 1) theta), 2 cosh theta = 2 + s, of a unit at the end.
  const int n = 600;
  const SpMat A = chain(n, 1);
  const double theta = std::acosh(1.5);
  MatX3 B = MatX3::Zero(n, 3);
  B.row(0) << 1, 0, -2;
  const auto X = solve_by_outward_sweeps(A, B, Task());
  ASSERT_TRUE(X);
  for (int i = 0; i < n; ++i) {
    const double log_of_exact = -(i + 1) * theta + std::log1p(-std::exp(-2 * (n - i) * theta)) -
                                std::log1p(-std::exp(-2 * (n + 1) * theta));
    EXPECT_NEAR(std::log((*X)(i, 0)), log_of_exact, 1e-9) << i;
    EXPECT_EQ((*X)(i, 1), 0);
    EXPECT_NEAR((*X)(i, 2), -2 * (*X)(i, 0), 1e-9 * (*X)(i, 0));
  }
  EXPECT_LT((*X)(n - 1, 0), 1e-240);
}

TEST(OutwardSweeps, AgreeWithAFactorWhereSeveralSourcesMeet) {
  // A box of cells whose neighbours pull by different amounts.
  const int n = 12;
  const auto number = [&](int i, int j, int k) { return (k * n + j) * n + i; };
  VecX diagonal = VecX::Constant(n * n * n, 0.2);
  Triplets entries;
  const auto join = [&](int a, int b) {
    const double weight = 1 + 0.5 * std::sin(a + 3.0 * b);
    diagonal[a] += weight;
    diagonal[b] += weight;
    entries.emplace_back(std::max(a, b), std::min(a, b), -weight);
  };
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        if (i + 1 < n) join(number(i, j, k), number(i + 1, j, k));
        if (j + 1 < n) join(number(i, j, k), number(i, j + 1, k));
        if (k + 1 < n) join(number(i, j, k), number(i, j, k + 1));
      }
  for (int i = 0; i < diagonal.size(); ++i) entries.emplace_back(i, i, diagonal[i]);
  SpMat A(diagonal.size(), diagonal.size());
  A.setFromTriplets(entries.begin(), entries.end());
  MatX3 B = MatX3::Zero(diagonal.size(), 3);
  B.row(number(0, 0, 0)) << 1, 2, 3;
  B.row(number(n - 1, 4, 5)) << -1, 0, 1;
  const auto X = solve_by_outward_sweeps(A, B, Task());
  ASSERT_TRUE(X);
  const MatX3 exact = Cholesky<double>(A, Task()).solve(B);
  for (int i = 0; i < X->rows(); ++i)
    EXPECT_LT((X->row(i) - exact.row(i)).norm(), 1e-9 * exact.row(i).norm()) << i;
}

TEST(OutwardSweeps, LeaveAloneWhatNoHeatReachesAndWhatWouldTakeTooLong) {
  SpMat two(4, 4);
  const Triplets entries{{0, 0, 3}, {1, 0, -1}, {1, 1, 3}, {2, 2, 1}, {3, 2, 0}, {3, 3, 1}};
  two.setFromTriplets(entries.begin(), entries.end());
  MatX3 B = MatX3::Zero(4, 3);
  EXPECT_EQ(*solve_by_outward_sweeps(two, B, Task()), B);
  B(0, 0) = 8;
  const auto X = solve_by_outward_sweeps(two, B, Task());
  ASSERT_TRUE(X);
  EXPECT_NEAR((*X)(0, 0), 3, 1e-12);
  EXPECT_NEAR((*X)(1, 0), 1, 1e-12);
  EXPECT_TRUE(X->bottomRows(2).isZero(0));
  MatX3 at_one_end = MatX3::Zero(1000, 3);
  at_one_end(0, 0) = 1;
  EXPECT_FALSE(solve_by_outward_sweeps(chain(1000, 1e-5), at_one_end, Task()));
}

}  // namespace
}  // namespace littoral
