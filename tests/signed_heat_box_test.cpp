// Signed heat on grids whose box holds little of the source, or nothing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api/space/sdf.h"
#include "space_helpers.h"

namespace littoral {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

VecX on_grid(double radius, const Grid& grid, SpaceConstraint constraint, Report& report) {
  SpaceSignedHeat method;
  method.constraint = constraint;
  PolygonSoup sphere = test::octasphere_soup(2);
  sphere.points *= radius;
  return grid_distance(sphere, grid, {method}, Task(), report);
}

TEST(SignedHeatBox, OneCellHoldsAllOfTheSource) {
  // Of 2 x 2 x 2 nodes: one row, which fixes the constant.
  for (const auto constraint : {SpaceConstraint::none, SpaceConstraint::zero_set}) {
    Report report;
    const VecX values = on_grid(0.05, test::cube_grid(2, 1), constraint, report);
    EXPECT_THAT(report.warnings, ::testing::Not(Contains(HasSubstr("holds no sample"))));
    EXPECT_NEAR(values.mean(), 0, 1e-9);  // at the middle of the cell, where the source is
  }
}

TEST(SignedHeatBox, WithoutTheSourceDistancesAreKnownUpToAConstant) {
  Grid within = test::cube_grid(6, 0.2);
  within.origin[0] += 0.5;
  Report report;
  const VecX values = on_grid(1, within, SpaceConstraint::zero_set, report);
  EXPECT_THAT(report.warnings, Contains(HasSubstr("holds no sample")));
  ASSERT_TRUE(values.allFinite());
  const auto at = [&](int i) { return values[static_cast<Eigen::Index>(within.node(i, 2, 2))]; };
  EXPECT_NEAR(at(5) - at(0), 0.4, 0.02);  // the length of the box, along a radius
}

}  // namespace
}  // namespace littoral
