// Strips of right-hand sides: what one at a time gives, in any order of the unknowns.

#include "solve/direct/strip_solve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "littoral/error.h"
#include "solve/direct/sparse_rows.h"

namespace littoral {
namespace {

/// Laplacian plus 1 of an n x n grid with far entries, lower triangle.
SpMat definite_grid(int n) {
  Triplets entries;
  for (int i = 0; i < n * n; ++i) {
    entries.emplace_back(i, i, 5);
    if (i % n + 1 < n) entries.emplace_back(i + 1, i, -1);
    if (i + n < n * n) entries.emplace_back(i + n, i, -1 - 0.1 * (i % 3));
  }
  if (n > 3) entries.emplace_back(n * n - 1, 0, 0.5);
  SpMat A(n * n, n * n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

Strip waves(Eigen::Index n) {
  Strip x(n, strip_width);
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] = std::sin(7.7 * double(i));
  return x;
}

TEST(StripSolve, GivesWhatOneAtATimeGives) {
  for (const int n : {1, 2, 9, 31, 90}) {
    const SpMat A = definite_grid(n);
    const Cholesky<double> factor(A, {});
    const MatX b = waves(A.rows());
    const MatX expected = factor.solve(b);
    std::vector<int> shuffled(b.rows());
    std::iota(shuffled.begin(), shuffled.end(), 0);
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
    for (const std::vector<int>& row_of : {factor.structure()->new_of, shuffled}) {
      Strip x(b.rows(), strip_width), spare;
      for (Eigen::Index i = 0; i < b.rows(); ++i) x.row(row_of[i]) = b.row(i);
      StripSolve(factor, row_of)(x, {}, spare, {});
      double worst = 0;
      for (Eigen::Index i = 0; i < b.rows(); ++i)
        worst = std::max(worst, (x.row(row_of[i]) - expected.row(i)).cwiseAbs().maxCoeff());
      EXPECT_LT(worst, 1e-13 * expected.cwiseAbs().maxCoeff()) << n;
    }
  }
}

TEST(StripSolve, LeavesOutWhatNothingFlowsInto) {
  const SpMat A = definite_grid(40);
  const Cholesky<double> factor(A, {});
  const std::vector<int>& row_of = factor.structure()->new_of;
  const StripSolve solve(factor, row_of);
  Strip few = Strip::Zero(A.rows(), strip_width), spare;
  std::vector<int> given;
  for (int k = 0; k < strip_width; ++k) {
    given.push_back(row_of[97 * k]);
    few(given.back(), k) = 1 + k;
  }
  Strip all = few;
  solve(few, given, spare, {});
  solve(all, {}, spare, {});
  EXPECT_EQ(few, all);
}

TEST(StripSolve, ColumnsDoNotTouchEachOther) {
  const SpMat A = definite_grid(40);
  const Cholesky<double> factor(A, {});
  const StripSolve solve(factor, factor.structure()->new_of);
  Strip x = waves(A.rows()), y = x, spare;
  for (int k = 0; k < strip_width; k += 3) y.col(k).setConstant(std::nan(""));
  solve(x, {}, spare, {});
  solve(y, {}, spare, {});
  for (int k = 0; k < strip_width; ++k) {
    if (k % 3 != 0) {
      EXPECT_EQ(x.col(k), y.col(k)) << k;
    }
  }
}

TEST(StripSolve, Stops) {
  const SpMat A = definite_grid(9);
  const Cholesky<double> factor(A, {});
  const CancelToken cancel;
  cancel.cancel();
  Strip x = waves(A.rows()), spare;
  EXPECT_THROW(StripSolve(factor, factor.structure()->new_of)(x, {}, spare, Task(cancel)),
               Cancelled);
}

TEST(StripSolve, ResidualsAreTheirDefinition) {
  const SpRows A = full_rows(definite_grid(20));
  const Strip b = waves(A.rows()), x = 0.3 * b.colwise().reverse();
  const Strip expected = b - A * x;
  for (const auto residual : {dense::residual_strip, dense::residual_plain}) {
    Strip r(A.rows(), strip_width);
    double sums[3][strip_width];
    residual(static_cast<int>(A.rows()), A.outerIndexPtr(), A.innerIndexPtr(), A.valuePtr(),
             b.data(), x.data(), r.data(), sums[0]);
    EXPECT_LT((r - expected).cwiseAbs().maxCoeff(), 1e-13);
    for (int k = 0; k < strip_width; ++k) {
      EXPECT_NEAR(sums[0][k], expected.col(k).squaredNorm(), 1e-10);
      EXPECT_NEAR(sums[1][k], b.col(k).squaredNorm(), 1e-10);
      EXPECT_NEAR(sums[2][k], x.col(k).squaredNorm(), 1e-10);
    }
  }
}

TEST(StripSolve, OneSupernodeAsByTriangularSolves) {
  for (const int n : {1, 2, 3, 5, 8, 13, 20})
    for (const int below : {0, 1, 2, 3, 4, 7}) {
      MatX block(n + below, n);
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n + below; ++i) block(i, j) = 0.3 * std::sin(3.1 * i + 5.7 * j);
        block(j, j) = 2 + j % 3;
      }
      const Eigen::Matrix<double, -1, -1, Eigen::ColMajor> columns = block;
      const MatX L = block.topRows(n).triangularView<Eigen::Lower>(), A = block.bottomRows(below);
      std::vector<int> rows;
      for (int i = 0; i < below; ++i) rows.push_back((5 * i + 3) % 11);
      const Strip own = waves(n), strip = waves(n + 11).bottomRows(11);
      const Strip solved = L.triangularView<Eigen::Lower>().solve(MatX(own));
      Strip passed = strip, back = own;
      for (int i = 0; i < below; ++i) {
        passed.row(rows[i]) -= A.row(i) * solved;
        back -= A.row(i).transpose() * strip.row(rows[i]);
      }
      back = Strip(L.transpose().triangularView<Eigen::Upper>().solve(MatX(back)));
      for (const auto forward : {dense::forward_strip, dense::forward_plain}) {
        Strip x = own, y = strip;
        forward(n, n + below, columns.data(), x.data(), y.data(), rows.data());
        EXPECT_LT((x - solved).cwiseAbs().maxCoeff(), 1e-13) << n << " " << below;
        EXPECT_LT((y - passed).cwiseAbs().maxCoeff(), 1e-13) << n << " " << below;
      }
      for (const auto backward : {dense::backward_strip, dense::backward_plain}) {
        Strip x = own;
        backward(n, n + below, columns.data(), x.data(), strip.data(), rows.data());
        EXPECT_LT((x - back).cwiseAbs().maxCoeff(), 1e-13) << n << " " << below;
      }
    }
}

}  // namespace
}  // namespace littoral
