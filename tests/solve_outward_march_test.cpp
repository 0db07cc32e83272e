// The order in which heat decays, from the matrix of heat alone.

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "littoral/error.h"
#include "littoral/types.h"
#include "solve/direct/hermitian_rows.h"
#include "solve/heat/outward_march.h"

namespace littoral {
namespace {

constexpr int stride = OutwardMarch<double>::stride;

/// Columns x rows places, each coupled to those beside it: M + sum of w on the diagonal and -w
/// between neighbours of a row, of a column, and across, from lower left to upper right.
struct Lattice {
  int columns, rows;
  double along, up, across;
  VecX M = VecX::Ones(Eigen::Index(columns) * rows);

  int at(int i, int j) const { return j * columns + i; }
  SpMat matrix() const {
    Triplets entries;
    const auto couple = [&](int a, int b, double w) {
      entries.emplace_back(b, a, -w);
      entries.emplace_back(a, a, w);
      entries.emplace_back(b, b, w);
    };
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        entries.emplace_back(at(i, j), at(i, j), M[at(i, j)]);
        if (i + 1 < columns && along > 0) couple(at(i, j), at(i + 1, j), along);
        if (j + 1 < rows && up > 0) couple(at(i, j), at(i, j + 1), up);
        if (i + 1 < columns && j + 1 < rows && across > 0)
          couple(at(i, j), at(i + 1, j + 1), across);
      }
    SpMat A(M.size(), M.size());
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
  }
  std::shared_ptr<const HermitianRows<double>> matrix_rows() const {
    return rows_of(std::make_shared<const SpMat>(matrix()), 1);
  }
};

std::vector<int> reached(const OutwardMarch<double>& march, int strides) {
  return {march.blocks(), march.blocks() + march.nearer_than(strides)};
}

TEST(OutwardMarch, KnowsHowHeatDecaysAlongAChain) {
  for (const double w : {1e-3, 0.2, 1.0, 40.0}) {
    const Lattice chain{400, 1, w, 0, 0};
    const auto A = chain.matrix_rows();
    OutwardMarch<double> march(*A, chain.M, {0});
    march.reach(1000, {});
    ASSERT_TRUE(march.ended());
    const double step = 2 * std::asinh(0.5 / std::sqrt(w));  // exp(-step k) solves A x = 0
    for (int s = 1; s <= 20; ++s) {
      const double nearer = std::min(400.0, std::ceil(s * stride / step));
      EXPECT_NEAR(double(march.nearer_than(s)), nearer, 1) << w << ' ' << s;
    }
    const std::vector<int> all = reached(march, 1000);
    ASSERT_EQ(all.size(), 400U);
    const bool sorted = std::is_sorted(all.begin(), all.end());
    EXPECT_TRUE(sorted || step < 0.25) << w;  // buckets hold more than one
  }
}

TEST(OutwardMarch, IsExactForPlaneWavesOnAStretchedLattice) {
  const Lattice lattice{9, 300, 30, 0.05, 0};
  const auto A = lattice.matrix_rows();
  std::vector<int> first_row(9);
  for (int i = 0; i < 9; ++i) first_row[i] = i;
  OutwardMarch<double> march(*A, lattice.M, first_row);
  march.reach(1000, {});
  const double step = 2 * std::asinh(0.5 / std::sqrt(0.05));
  for (int s = 1; s < 40; ++s)
    EXPECT_EQ(march.nearer_than(s), 9 * std::size_t(std::ceil(s * stride / step))) << s;
}

TEST(OutwardMarch, OrdersBlocksAsHeatFromAPointDecays) {
  for (const auto& [along, up, across] : {std::array{1.0, 1.0, 0.0}, std::array{1.0, 1.0, 1.0},
                                          std::array{9.0, 0.2, 0.0}, std::array{0.3, 4.0, 0.6}}) {
    const Lattice lattice{61, 61, along, up, across};
    const SpMat A = lattice.matrix();
    const Eigen::SimplicialLDLT<SpMat, Eigen::Lower> factor(A);
    VecX b = VecX::Zero(A.rows());
    const int source = lattice.at(30, 30);
    b[source] = 1;
    const VecX u = factor.solve(b), lengths = -(u / u[source]).array().log();
    const auto rows = lattice.matrix_rows();
    OutwardMarch<double> march(*rows, lattice.M, {source});
    march.reach(1000, {});
    double farthest = 0, early = 0;
    for (const int i : reached(march, 1000)) {
      farthest = std::max(farthest, lengths[i]);
      early = std::max(early, farthest - lengths[i]);
    }
    EXPECT_GT(farthest, 25) << along;
    EXPECT_LT(early, 0.1 * farthest) << along << ' ' << up << ' ' << across;
    const auto nearer = double((lengths.array() < stride).count());
    EXPECT_NEAR(double(march.nearer_than(1)), nearer, 0.2 * nearer) << along;
  }
}

TEST(OutwardMarch, GoesOnWhereItStopped) {
  const Lattice lattice{40, 50, 0.4, 0.1, 0.2};
  const auto A = lattice.matrix_rows();
  OutwardMarch<double> at_once(*A, lattice.M, {0, 700}), in_steps(*A, lattice.M, {0, 700});
  at_once.reach(100, {});
  for (int s = 0; s <= 100; ++s) in_steps.reach(s, {});
  EXPECT_TRUE(in_steps.ended());
  EXPECT_EQ(reached(in_steps, 100), reached(at_once, 100));
  for (int s = 0; s <= 100; ++s) EXPECT_EQ(in_steps.nearer_than(s), at_once.nearer_than(s));
  EXPECT_EQ(at_once.nearer_than(100), 2000U);
  EXPECT_LT(at_once.nearer_than(1), 2000U);
}

TEST(OutwardMarch, StaysWhereNothingIsCoupled) {
  const Lattice lines{7, 3, 2, 0, 0};
  const auto A = lines.matrix_rows();
  OutwardMarch<double> march(*A, lines.M, {lines.at(2, 1)});
  EXPECT_FALSE(march.ended());
  march.reach(100, {});
  std::vector<int> all = reached(march, 100);
  std::sort(all.begin(), all.end());
  EXPECT_EQ(all, (std::vector<int>{7, 8, 9, 10, 11, 12, 13}));
  OutwardMarch<double> from_nowhere(*A, lines.M, {});
  EXPECT_TRUE(from_nowhere.ended());
  from_nowhere.reach(100, {});
  EXPECT_EQ(from_nowhere.nearer_than(100), 0U);
}

TEST(OutwardMarch, CanBeStopped) {
  const Lattice lattice{9, 9, 1, 1, 0};
  const auto A = lattice.matrix_rows();
  OutwardMarch<double> march(*A, lattice.M, {0});
  const CancelToken stop;
  stop.cancel();
  EXPECT_THROW(march.reach(100, Task(stop)), Cancelled);
}

}  // namespace
}  // namespace littoral
