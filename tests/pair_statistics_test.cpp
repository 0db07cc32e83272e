// What is counted of matrices of pairs: asymmetry, and violations of the triangle inequality.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "methods/regularized/all_pairs.h"

namespace littoral {
namespace {

TEST(PairStatistics, CountsWhatIsWrong) {
  MatX D(4, 4);  // points 0, 1, 2, 3 of a line
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) D(i, j) = std::abs(i - j);
  PairStatistics s = pair_statistics(D, 4, {});
  EXPECT_EQ(s.largest_asymmetry, 0);
  EXPECT_EQ(s.violations, 0);
  EXPECT_EQ(s.triplets, 12);  // six pairs, two others each
  D(0, 3) = D(3, 0) = 4;      // against 1 + 2 and 2 + 1
  s = pair_statistics(D, 4, {});
  EXPECT_DOUBLE_EQ(s.violations, 2. / 12);
  EXPECT_DOUBLE_EQ(s.largest_violation, 0.5);
  D(0, 1) = 1.5;
  s = pair_statistics(D, 4, {});
  EXPECT_DOUBLE_EQ(s.largest_asymmetry, 0.25);
  EXPECT_DOUBLE_EQ(s.mean_asymmetry, 0.25 * 2 / 12);
}

TEST(PairStatistics, OfManyNodesAreThoseOfSome) {
  // The points 0, 1, ... of a line.
  constexpr int n = 2500;
  EXPECT_EQ(statistics_nodes(1000), 1000);
  const Eigen::Index m = statistics_nodes(n);
  EXPECT_NEAR(static_cast<double>(m * m) * n / 2, 5e8, 3e6);
  MatX D(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) D(i, j) = std::abs(i - j);
  PairStatistics s = pair_statistics(D, 4, {});
  EXPECT_EQ(s.violations, 0);
  EXPECT_EQ(s.triplets, static_cast<double>(m * (m - 1) / 2) * (n - 2));
  D(2, 1) += 0.5;
  for (int j = 1; j < n; ++j) D(0, j) = D(j, 0) = j + 3;  // node 0 is looked at
  s = pair_statistics(D, 4, {});
  EXPECT_DOUBLE_EQ(s.largest_asymmetry, 0.25);
  EXPECT_DOUBLE_EQ(s.mean_asymmetry, 0.25 / (0.5 * n * (n - 1)));
  EXPECT_EQ(s.violations, 0);                 // as far from everything
  const Eigen::Index last = (m - 1) * n / m;  // and so is this one
  D(0, last) = D(last, 0) = 2 * n;
  s = pair_statistics(D, 4, {});
  EXPECT_DOUBLE_EQ(s.violations, (n - 2) / s.triplets);
  EXPECT_DOUBLE_EQ(s.largest_violation, (2 * n - (last + 3)) / 2.);
}

TEST(PairStatistics, CountsNoTripletsAcrossComponents) {
  constexpr double far = std::numeric_limits<double>::infinity();
  MatX D = MatX::Constant(5, 5, far);  // three points of a line, and two of another
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      if ((i < 3) == (j < 3)) D(i, j) = std::abs(i - j);
  const PairStatistics s = pair_statistics(D, 1, {});
  EXPECT_EQ(s.triplets, 3);  // three pairs, one other each; the fourth pair has none
  D(0, 2) = D(2, 0) = 3;
  EXPECT_DOUBLE_EQ(pair_statistics(D, 1, {}).violations, 1. / 3);
}

}  // namespace
}  // namespace littoral
