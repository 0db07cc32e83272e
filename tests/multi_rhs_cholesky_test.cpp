// Sixteen right-hand sides at once give what one at a time gives.

#include "solve/direct/multi_rhs_cholesky.h"

#include <gtest/gtest.h>

#include "littoral/error.h"
#include "solve/direct/cholesky.h"

namespace littoral {
namespace {

/// Five-point Laplacian of an n x n grid plus `shift`, lower triangle, with a far entry.
SpMat grid_matrix(int n, double shift) {
  Triplets entries;
  for (int i = 0; i < n * n; ++i) {
    entries.emplace_back(i, i, 4 + shift);
    if (i % n + 1 < n) entries.emplace_back(i + 1, i, -1);
    if (i + n < n * n) entries.emplace_back(i + n, i, -1 - 0.1 * (i % 3));
  }
  entries.emplace_back(n * n - 1, 0, 0.5);
  SpMat A(n * n, n * n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

TEST(MultiRhsCholesky, SolvesAsTheOtherFactorDoes) {
  for (const int n : {1, 2, 9, 31}) {
    const SpMat A = grid_matrix(n, 1);
    const Elimination structure(A, dissection(A, {}));
    Strip x(n * n, strip_width);
    for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] = std::sin(7.7 * double(i));
    const Eigen::MatrixXd b = x;
    MultiRhsCholesky(A, structure).solve(x);
    const Eigen::MatrixXd expected = Cholesky<double>(A, {}).solve(b);
    EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff());
  }
}

TEST(MultiRhsCholesky, RefusesWhatIsNotDefinite) {
  const SpMat A = grid_matrix(4, -6);
  EXPECT_THROW(MultiRhsCholesky(A, Elimination(A, dissection(A, {}))), SolveError);
}

}  // namespace
}  // namespace littoral
