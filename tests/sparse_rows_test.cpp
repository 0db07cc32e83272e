// Sparse matrices by rows, against dense ones.

#include "solve/direct/sparse_rows.h"

#include <gtest/gtest.h>

#include <random>

namespace littoral {
namespace {

/// A few entries; nothing in the first and last two rows and columns.
SpRows some_matrix(int rows, int cols, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> row(1, rows - 3), col(1, cols - 3);
  std::normal_distribution<double> value;
  Triplets entries;
  for (int k = 0; k < 2 * rows; ++k) {
    const int i = row(random), j = col(random);
    entries.emplace_back(i, j, value(random));
  }
  SpRows A(rows, cols);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

TEST(SparseRows, TransposedAndProductsLikeDense) {
  const SpRows A = some_matrix(20, 13, 1), B = some_matrix(13, 30, 2);
  const SpRows T = transposed(A);
  EXPECT_EQ(MatX(T), MatX(A).transpose());
  EXPECT_EQ(T.nonZeros(), A.nonZeros());
  EXPECT_LE((MatX(product(A, B, {})) - MatX(A) * MatX(B)).cwiseAbs().maxCoeff(), 1e-14);
  const VecX x = VecX::LinSpaced(13, 1, 2);
  VecX y, some = VecX::Constant(20, 7);
  multiply(A, x, y, {});
  EXPECT_LE((y - MatX(A) * x).cwiseAbs().maxCoeff(), 1e-14);
  multiply_rows(A, 5, 9, x.data(), some.data());
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(some[i], i >= 5 && i < 9 ? y[i] : 7, 1e-14) << i;
}

TEST(SparseRows, SymmetricFromTheirLowerTriangle) {
  const SpRows A = some_matrix(15, 15, 3);
  const SpMat lower = SpMat(A).triangularView<Eigen::Lower>();
  const MatX full = MatX(SpMat(lower.selfadjointView<Eigen::Lower>()));
  const SpRows rows = full_rows(lower);
  EXPECT_EQ(MatX(rows), full);
  EXPECT_EQ(MatX(copied(lower)), MatX(lower));
  EXPECT_EQ(copied(lower).nonZeros(), lower.nonZeros());
  EXPECT_EQ(copied(SpMat(3, 3)).nonZeros(), 0);
  for (int i = 0; i < 15; ++i) {
    int before = -1;
    for (SpRows::InnerIterator it(rows, i); it; ++it) {
      EXPECT_GT(it.col(), before) << i;
      before = it.col();
    }
  }
  const VecX x = VecX::LinSpaced(15, 1, 2), b = VecX::LinSpaced(15, 5, -3);
  EXPECT_LE((SymmetricRows(lower).residual(lower, x, b) - (b - full * x)).cwiseAbs().maxCoeff(),
            1e-14);
}

}  // namespace
}  // namespace littoral
