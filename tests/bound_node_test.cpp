// Bounds of distances from boxes and disks: below every point, and not far below for flat sets.

#include "spatial/bound_node.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "constants.h"
#include "space_helpers.h"

namespace littoral {
namespace {

using test::infinity;

std::vector<int> rows_of(const MatX3& points) {
  std::vector<int> rows(static_cast<std::size_t>(points.rows()));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

/// The bound and the true squared distance of q to the points.
std::pair<double, double> bound_and_truth(const MatX3& points, const Vec3& q) {
  BoundNode node;
  for (int l = 0; l < bound_lanes; ++l) set_empty(node, l);
  const std::vector<int> rows = rows_of(points);
  set_bounds(points, rows.data(), rows.data() + rows.size(), node, 3);
  double squared[bound_lanes];
  bound_kernel()(node, q.data(), squared);
  for (int l = 0; l < bound_lanes; ++l)
    if (l != 3) {
      EXPECT_EQ(squared[l], infinity);
    }
  return {squared[3], (points.rowwise() - q.transpose()).rowwise().squaredNorm().minCoeff()};
}

TEST(BoundNode, IsBelowEveryPoint) {
  const MatX3 queries = test::random_points(40, 1, 7);
  for (const double flatness : {1.0, 1e-3, 0.0}) {
    for (const int n : {1, 3, 50, 3000}) {
      MatX3 points = test::random_points(n, 1, static_cast<unsigned>(n));
      points.col(2) = flatness * points.col(2) + 0.5 * points.col(0);
      for (const double away : {0.0, 1e6})
        for (const double reach : {1e-3, 1.0, 1e3, 1e30})
          for (Eigen::Index i = 0; i < queries.rows(); ++i) {
            const MatX3 moved = points.array() + away;
            const Vec3 q = (reach * queries.row(i)).array() + away;
            const auto [bound, truth] = bound_and_truth(moved, q);
            EXPECT_LE(bound, truth);
            EXPECT_GE(bound, 0);
          }
    }
  }
}

TEST(BoundNode, SeesTiltedPlanesAsFlat) {
  MatX3 points = test::random_points(200, 1);
  points.col(2) = points.col(0) + points.col(1);  // their box is all around q
  const Vec3 q(0.5, 0.5, -0.5);
  const auto [bound, truth] = bound_and_truth(points, q);
  EXPECT_NEAR(std::sqrt(bound), 1.5 / std::sqrt(3), 1e-9);
  EXPECT_LE(bound, truth);
}

TEST(BoundNode, InSinglePrecisionItIsBelowEveryPointToo) {
  const MatX3 queries = test::random_points(60, 1, 8);
  const std::vector<int> rows = rows_of(MatX3(3000, 3));
  for (const double flatness : {1.0, 1e-3, 0.0})
    for (const int n : {1, 3, 50, 3000}) {
      MatX3 points = test::random_points(n, 0.5, static_cast<unsigned>(n));
      points.col(2) = flatness * points.col(2) + 0.5 * points.col(0);
      BoundNode node;
      for (int l = 0; l < bound_lanes; ++l) set_empty(node, l), node.child[l] = l;
      set_bounds(points, rows.data(), rows.data() + n, node, 3);
      SmallBoundNode small;
      set_small(node, small);
      for (const double reach : {1e-3, 1.0, 30.0, 33.0, 1e3, 1e30, 1e120})
        for (Eigen::Index i = 0; i < queries.rows(); ++i) {
          const Vec3 q = reach * queries.row(i);
          const double truth =
              (points.rowwise() - q.transpose()).rowwise().squaredNorm().minCoeff();
          alignas(64) double exact[bound_lanes], squared[bound_lanes];
          bound_kernel()(node, q.data(), exact);
          const SmallBoundKernels& kernels = small_bound_kernels();
          const auto kernel =
              q.cwiseAbs().maxCoeff() <= near_bound_kernel ? kernels.near : kernels.far;
          EXPECT_EQ(kernel(small, q.data(), truth, squared), 1u << 3);
          EXPECT_LE(squared[3], truth);
          EXPECT_EQ(squared[2], infinity);
          if (reach > 30) continue;
          EXPECT_GT(std::sqrt(squared[3]), std::sqrt(exact[3]) - 3e-3 * (1 + reach));
          EXPECT_EQ(kernel(small, q.data(), squared[3] / 2, squared),
                    squared[3] > 0 ? 0u : 1u << 3);
        }
    }
}

}  // namespace
}  // namespace littoral
