// The order of points along a Morton curve.

#include "spatial/morton_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "space_helpers.h"

namespace littoral {
namespace {

std::vector<int> all_numbers(int n) {
  std::vector<int> numbers(static_cast<std::size_t>(n));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

TEST(MortonOrder, IsAPermutationThatKeepsNeighboursTogether) {
  const MatX3 points = test::random_points(4096, 1);
  const std::vector<int> order = morton_order(points);
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted, all_numbers(4096));
  double steps = 0;
  for (std::size_t i = 1; i < order.size(); ++i)
    steps += (points.row(order[i]) - points.row(order[i - 1])).norm();
  // In a cube of side 2, random neighbours are 1.3 apart; the nearest of 4096 points about 0.07.
  EXPECT_LT(steps / 4095, 0.2);
}

TEST(MortonOrder, OfManyPointsIsThatOfFewWithOthersBetween) {
  MatX3 points = test::random_points(9000, 1);
  points.row(0).setConstant(-1);  // the same lattice
  points.row(1).setConstant(1);
  points.row(2) = points.row(3);
  std::vector<int> many = morton_order(points);
  std::erase_if(many, [](int i) { return i >= 4000; });
  EXPECT_EQ(many, morton_order(points.topRows(4000)));
}

TEST(MortonOrder, OfCornersOfACubeFollowsTheirBits) {
  MatX3 corners(8, 3);
  for (int w = 0; w < 8; ++w) corners.row(7 - w) << (w & 1), (w >> 1 & 1), (w >> 2);
  const std::vector<int> order = morton_order(corners);
  for (int w = 0; w < 8; ++w) EXPECT_EQ(order[w], 7 - w);
}

TEST(MortonOrder, TakesAnyNumbers) {
  EXPECT_TRUE(morton_order(MatX3(0, 3)).empty());
  EXPECT_EQ(morton_order(MatX3::Constant(5, 3, 2.5)), all_numbers(5));
  MatX3 wrong = test::random_points(5, 2);
  wrong(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(morton_order(wrong), all_numbers(5));
  const double most = std::numeric_limits<double>::max();
  const double least = std::numeric_limits<double>::denorm_min();
  for (const double size : {most, least}) {
    MatX3 points = MatX3::Zero(3, 3);
    points(0, 0) = -size;
    points(2, 1) = size;
    std::vector<int> order = morton_order(points);
    std::sort(order.begin(), order.end());
    EXPECT_EQ(order, all_numbers(3));
  }
}

}  // namespace
}  // namespace littoral
