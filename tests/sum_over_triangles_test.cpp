// Sparse sums over triangles against dense ones.

#include "operators/sum_over_triangles.h"

#include <gtest/gtest.h>

#include <random>

#include "base/parallel.h"

namespace littoral {
namespace {

TEST(SumOverTriangles, IsTheDenseSumInSortedColumns) {
  constexpr int n = 40, n_triangles = 300;  // so that pairs of unknowns repeat many times
  std::mt19937 random(3);
  MatX3i unknowns(n_triangles, 3);
  std::vector<TriangleTerms<Complex>> terms(n_triangles);
  Eigen::MatrixXcd dense = Eigen::MatrixXcd::Zero(n, n);
  const auto number = [&] { return double(random() % 2001) - 1000; };  // sums without rounding
  for (int f = 0; f < n_triangles; ++f)
    for (int k = 0; k < 3; ++k) {
      unknowns(f, k) = static_cast<int>(random() % (n - 1));  // the last is in no triangle
      terms[f].diagonal[k] = number();
      terms[f].beside[k] = {number(), number()};
    }
  unknowns.row(5) << 7, 7, 3;  // one unknown twice
  for (int f = 0; f < n_triangles; ++f)
    for (int k = 0; k < 3; ++k) {
      const int i = unknowns(f, k), j = unknowns(f, (k + 1) % 3);
      dense(i, i) += terms[f].diagonal[k];
      dense(std::max(i, j), std::min(i, j)) += terms[f].beside[k];
    }
  const auto A = sum_over_triangles<Complex>(n, unknowns, [&](int f) { return terms[f]; });
  EXPECT_EQ((Eigen::MatrixXcd(A) - dense).cwiseAbs().maxCoeff(), 0);
  for (int j = 0; j < n; ++j)
    for (int e = A.outerIndexPtr()[j]; e + 1 < A.outerIndexPtr()[j + 1]; ++e)
      EXPECT_LT(A.innerIndexPtr()[e], A.innerIndexPtr()[e + 1]);
  EXPECT_EQ(A.outerIndexPtr()[n - 1], A.outerIndexPtr()[n]);
}

TEST(SumOverTriangles, HasTheSameBitsOnAnyNumberOfThreads) {
  constexpr int n = 30'000;
  std::mt19937 random(5);
  MatX3i unknowns(2 * n, 3);
  for (Eigen::Index i = 0; i < unknowns.size(); ++i)
    unknowns.data()[i] = static_cast<int>(random() % n);
  const auto sum = [&](int threads) {
    set_thread_count(threads);
    return sum_over_triangles<double>(n, unknowns, [](int f) {
      return TriangleTerms<double>{{1.0 / (f + 1), 0.1, 0.2}, {1.0 / (f + 3), 0.3, 0.7}};
    });
  };
  const SpMat one = sum(1), two = sum(2);
  set_thread_count(0);
  ASSERT_EQ(one.nonZeros(), two.nonZeros());
  EXPECT_TRUE(one.coeffs().cwiseEqual(two.coeffs()).all());
}

}  // namespace
}  // namespace littoral
