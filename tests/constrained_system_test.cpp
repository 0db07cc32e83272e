// Repeated solves under constraints, against dense ones.

#include "solve/poisson/constrained_system.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

namespace littoral {
namespace {

/// The Laplacian of two chains of n unknowns, lower triangle.
SpMat two_chains(int n) {
  Triplets entries;
  for (int i = 0; i + 1 < 2 * n; ++i) {
    if (i == n - 1) continue;
    entries.emplace_back(i, i, 1);
    entries.emplace_back(i + 1, i + 1, 1);
    entries.emplace_back(i + 1, i, -1);
  }
  SpMat K(2 * n, 2 * n);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

TEST(ConstrainedSystem, RowsThatGiveAreSprings) {
  const int n = 60;
  const SpMat K = two_chains(n);
  std::vector<int> component(2 * n, 0);
  std::fill(component.begin() + n, component.end(), 1);
  VecX b(2 * n);
  for (int i = 0; i < 2 * n; ++i) b[i] = std::sin(1 + 3 * i);
  // Springs at every `step`-th unknown: few of them by corrections of one factor, many by another.
  // The first chain has two held unknowns beside them, or none.
  for (const int step : {12, 1})
    for (const bool held : {false, true}) {
      Triplets rows;
      std::vector<double> give;
      const auto add = [&](int i, double s) {
        rows.emplace_back(static_cast<int>(give.size()), i, 1);
        give.push_back(s);
      };
      for (const int i : {4, 40})
        if (held) add(i, 0);
      for (int i = 2; i < 2 * n; i += step)
        if (!held || (i != 4 && i != 40)) add(i, 0.1 + 0.01 * i);
      SpMat A(static_cast<Eigen::Index>(give.size()), 2 * n);
      A.setFromTriplets(rows.begin(), rows.end());
      const VecX s = Eigen::Map<const VecX>(give.data(), A.rows());
      const VecX u = ConstrainedSystem(K, component, 2, {}).constrain(A, {}, s).solve(b);

      // [K A^T; A -s] [u; force] = [b; 0]
      MatX dense = MatX::Zero(2 * n + s.size(), 2 * n + s.size());
      dense.topLeftCorner(2 * n, 2 * n) = MatX(SpMat(K.selfadjointView<Eigen::Lower>()));
      dense.bottomLeftCorner(s.size(), 2 * n) = MatX(A);
      dense.topRightCorner(2 * n, s.size()) = MatX(A).transpose();
      dense.bottomRightCorner(s.size(), s.size()).diagonal() = -s;
      VecX rhs = VecX::Zero(dense.rows());
      rhs.head(2 * n) = b;
      const VecX expected = dense.fullPivLu().solve(rhs);
      EXPECT_LT((u - expected.head(2 * n)).cwiseAbs().maxCoeff(), 1e-9) << step << held;
    }
}

/// K with every entry of an edge times 1 + its number.
SpMat with_weights(const SpMat& K, int n) {
  Triplets entries;
  for (int i = 0; i + 1 < 2 * n; ++i) {
    if (i == n - 1) continue;
    entries.emplace_back(i, i, i + 1);
    entries.emplace_back(i + 1, i + 1, i + 1);
    entries.emplace_back(i + 1, i, -(i + 1));
  }
  SpMat out(K.rows(), K.cols());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

TEST(ConstrainedSystem, AnotherMatrixOnTheSameStructure) {
  const int n = 60;
  const SpMat K = two_chains(n), other = with_weights(K, n);
  std::vector<int> component(2 * n, 0);
  std::fill(component.begin() + n, component.end(), 1);
  VecX b(2 * n);
  for (int i = 0; i < 2 * n; ++i) b[i] = std::sin(1 + 3 * i);
  for (const int step : {12, 1})  // few rows and many
    for (const bool gives : {false, true}) {
      Triplets entries;
      for (int i = 2; i < 2 * n; i += step)
        entries.emplace_back(static_cast<int>(entries.size()), i, 1);
      SpMat rows(static_cast<Eigen::Index>(entries.size()), 2 * n);
      rows.setFromTriplets(entries.begin(), entries.end());
      const VecX give = gives ? VecX::LinSpaced(rows.rows(), 0.1, 2) : VecX();
      const ConstrainedSystem system(K, component, 2, {});
      const auto like = system.constrain(rows, {}, gives ? VecX(3 * give) : give);
      const VecX u = system.constrain_like(like, other, rows, {}, give).solve(b);
      const VecX expected =
          ConstrainedSystem(other, component, 2, {}).constrain(rows, {}, give).solve(b);
      EXPECT_LE((u - expected).norm(), 1e-12 * expected.norm()) << step << gives;
    }
}

/// Rows by their entries.
SpMat matrix_of_rows(int n, const std::vector<std::vector<std::pair<int, double>>>& rows) {
  SpMat out(static_cast<Eigen::Index>(rows.size()), n);
  Triplets entries;
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (const auto& [i, value] : rows[r]) entries.emplace_back(static_cast<int>(r), i, value);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

TEST(ConstrainedSystem, RowsThatAreAlmostAnotherAreThatOneHoweverStiffTheMatrix) {
  // A chain held at both ends under unit forces hangs in a parabola, and in a shorter one if the
  // unknown beside an end is held as well.
  const int n = 6;
  for (const double stiff : {1e-6, 1.0, 1e6}) {
    const SpMat K = stiff * two_chains(n).topLeftCorner(n, n);
    const ConstrainedSystem system(K, std::vector<int>(n, 0), 1, {});
    for (const double share : {1e-7, 1e-4}) {
      const SpMat rows = matrix_of_rows(n, {{{0, 1}}, {{0, 1 - share}, {1, share}}, {{n - 1, 1}}});
      const VecX u = system.constrain(rows, {}).solve(VecX::Ones(n));
      const int from = share < 1e-6 ? 0 : 1;
      for (int i = 0; i < n; ++i)
        EXPECT_NEAR(stiff * u[i], i < from ? 0 : 0.5 * (i - from) * (n - 1 - i), 1e-7)
            << stiff << " " << share << " " << i;
    }
  }
}

TEST(ConstrainedSystem, RepeatedRowsChangeNothing) {
  const int n = 8;
  const SpMat K = two_chains(n).topLeftCorner(n, n);
  const ConstrainedSystem system(K, std::vector<int>(n, 0), 1, {});
  VecX b(n);
  for (int i = 0; i < n; ++i) b[i] = std::sin(1 + 3 * i);
  const std::vector<std::pair<int, double>> first = {{0, 0.1}, {1, 0.2}, {3, 0.7}},
                                            other = {{4, 0.3}, {6, 0.7}};
  auto thrice = first;  // the sum of whose shares is rounded otherwise
  for (auto& [i, value] : thrice) value *= 3;
  const VecX once = system.constrain(matrix_of_rows(n, {first, other}), {}).solve(b);
  EXPECT_GT(once.cwiseAbs().maxCoeff(), 0.1);
  for (const auto& rows :
       {matrix_of_rows(n, {first, thrice, other}), matrix_of_rows(n, {first, other, other}),
        matrix_of_rows(n, {first, thrice, other, first, other})})
    EXPECT_LE((system.constrain(rows, {}).solve(b) - once).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace littoral
