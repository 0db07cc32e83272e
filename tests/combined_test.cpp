// Combined fields: known answers of spheres and boxes, bounds, symmetry, gradients.
#include "methods/implicit/combined.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "api/space/sampled_distance.h"
#include "field_helpers.h"
#include "littoral/error.h"

namespace littoral {
namespace {

using test::Formula;

std::shared_ptr<const PointwiseDistance> ball(const Vec3& centre, double radius) {
  return std::make_shared<const Formula>([=](const Vec3& x) {
    return DistanceSample{(x - centre).norm() - radius, (x - centre).normalized()};
  });
}

std::shared_ptr<const PointwiseDistance> half_space(const Vec3& n, double at) {
  return std::make_shared<const Formula>([=](const Vec3& x) {
    return DistanceSample{n.dot(x) - at, n};
  });
}

std::vector<Vec3> places(int n) { return test::places(n, 5, 2); }

TEST(Combined, IsInsideWhatItShouldBe) {
  const std::vector fields = {ball({0, 0, 0}, 1), ball({0.8, 0, 0}, 0.9), ball({0, 0.5, 0}, 0.8),
                              ball({0, 0, 0.7}, 0.6)};
  const Combined shape(fields, {{Boolean::unite, Boolean::intersect, Boolean::subtract}, 0, 0});
  for (const Vec3& x : places(2000)) {
    bool in[4];
    for (std::size_t f = 0; f < 4; ++f) in[f] = fields[f]->value(x) < 0;
    EXPECT_EQ(shape.value(x) < 0, (in[0] || in[1]) && in[2] && !in[3]) << x.transpose();
  }
}

TEST(Combined, UnionIsExactOutsideAndABoundInside) {
  const Combined two({ball({-0.5, 0, 0}, 1), ball({0.5, 0, 0}, 1)}, {{Boolean::unite}, 0, 0});
  EXPECT_DOUBLE_EQ(two.value({3, 0, 0}), 1.5);
  EXPECT_NEAR(two.value({0, 2, 0}), std::hypot(0.5, 2) - 1, 1e-15);
  // In the middle the circle where the two meet is the nearest place, at sqrt(3) / 2, and the
  // bound says 1/2.
  EXPECT_NEAR(two.value({0, 0, 0}), -0.5, 1e-15);
  for (const Vec3& x : places(500)) {
    const double phi = two.value(x);
    EXPECT_LE(-phi, 1.5);
    EXPECT_LE(two.at(x).gradient.norm(), 1 + 1e-12);
  }
}

TEST(Combined, DifferenceAndIntersectionOfHalfSpacesAreBoundsOutsideOfCorners) {
  const Combined corner({half_space(Vec3::UnitX(), 0), half_space(Vec3::UnitY(), 0)},
                        {{Boolean::intersect}, 0, 0});
  EXPECT_DOUBLE_EQ(corner.value({-1, -2, 0}), -1);  // exact inside
  EXPECT_DOUBLE_EQ(corner.value({1, 1, 0}), 1);     // the corner is at sqrt(2)
  const Combined step({half_space(Vec3::UnitX(), 0), half_space(Vec3::UnitY(), 0)},
                      {{Boolean::subtract}, 0, 0});
  EXPECT_DOUBLE_EQ(step.value({-1, 2, 0}), -1);
  EXPECT_DOUBLE_EQ(step.value({-1, -2, 0}), 2);
}

TEST(Combined, OffsetMovesTheSurface) {
  const Combined grown({ball({0, 0, 0}, 1)}, {{}, 0, 0.25});
  EXPECT_DOUBLE_EQ(grown.value({2, 0, 0}), 0.75);
  EXPECT_DOUBLE_EQ(grown.value({1.25, 0, 0}), 0);
}

TEST(Combined, BlendIsSmoothBoundedAndLocal) {
  const double r = 0.4;
  const std::vector fields = {half_space(Vec3::UnitX(), 0), half_space(Vec3::UnitY(), 0)};
  const Combined sharp(fields, {{Boolean::unite}, 0, 0}), round(fields, {{Boolean::unite}, r, 0});
  EXPECT_DOUBLE_EQ(round.value({1, 1, 0}), 1 - r / 4);
  EXPECT_DOUBLE_EQ(round.value({0, r, 0}), 0);  // the rounded corner begins here
  for (const Vec3& x : places(2000)) {
    const double a = sharp.value(x), b = round.value(x);
    EXPECT_LE(b, a);
    EXPECT_GE(b, a - r / 4);
    if (std::abs(x[0] - x[1]) >= r) {
      EXPECT_EQ(a, b);
    }
    const DistanceSample sample = round.at(x);
    EXPECT_LE(sample.gradient.norm(), 1 + 1e-12);
    for (int d = 0; d < 3; ++d) {
      const Vec3 step = 1e-6 * Vec3::Unit(d);
      EXPECT_NEAR(sample.gradient[d], (round.value(x + step) - round.value(x - step)) / 2e-6, 1e-5);
    }
  }
}

TEST(Combined, OrderDoesNotMatterAndFlippingSwapsUnionAndIntersection) {
  const auto a = ball({0, 0, 0}, 1), b = ball({1, 0.2, 0}, 0.8), c = ball({0.5, 1, 0.3}, 0.7);
  const std::vector<Boolean> both(2, Boolean::unite);
  const Combined abc({a, b, c}, {both, 0.3, 0}), cab({c, a, b}, {both, 0.3, 0});
  for (const Vec3& x : places(500)) EXPECT_EQ(abc.value(x), cab.value(x));
  const Combined minus({a, b}, {{Boolean::subtract}, 0.3, 0});
  const auto outside_b = std::make_shared<const Formula>([b](const Vec3& x) {
    const DistanceSample s = b->at(x);
    return DistanceSample{-s.value, -s.gradient};
  });
  const Combined within({a, outside_b}, {{Boolean::intersect}, 0.3, 0});
  for (const Vec3& x : places(500)) EXPECT_EQ(minus.value(x), within.value(x));
}

TEST(Combined, InfiniteValuesAndBadRadii) {
  const double inf = std::numeric_limits<double>::infinity();
  const DistanceSample far{inf, Vec3::Zero()}, near{1, Vec3::UnitX()};
  EXPECT_EQ(smooth_min(far, far, 0.5).value, inf);
  EXPECT_EQ(smooth_min(far, near, 0.5).value, 1);
  const auto a = ball({0, 0, 0}, 1);
  EXPECT_THROW(Combined({}, {}), InputError);
  EXPECT_THROW(Combined({a, a}, {}), InputError);
  EXPECT_THROW(Combined({a}, {{}, -1, 0}), InputError);
  EXPECT_THROW(Combined({a}, {{}, std::nan(""), 0}), InputError);
  EXPECT_THROW(Combined({a}, {{}, 0, inf}), InputError);
}

/// x + 2 y - z, which trilinear interpolation meets exactly, moved to 1 at the box's lower corner.
Volume linear_field() {
  Volume field;
  field.grid = {{3, 4, 5}, Vec3(-1, 0, 2), Vec3(0.5, 0.25, 0.125)};
  field.values.resize(60);
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 3; ++i) {
        const Vec3 p = field.grid.point(i, j, k);
        field.values[static_cast<Eigen::Index>(field.grid.node(i, j, k))] =
            p[0] + 2 * p[1] - p[2] + 4;
      }
  return field;
}

TEST(SampledDistance, IsLinearInsideAndGrowsOutside) {
  const SampledDistance field(linear_field());
  const auto [value, gradient] = field.at({-0.3, 0.4, 2.2});
  EXPECT_NEAR(value, -0.3 + 0.8 - 2.2 + 4, 1e-12);
  EXPECT_NEAR((gradient - Vec3(1, 2, -1)).norm(), 0, 1e-12);
  EXPECT_NEAR(field.value({-1, 0, 2}), 1, 1e-12);
  EXPECT_NEAR(field.value({-2, 0, 2}), std::hypot(1, 1), 1e-12);
  for (const Vec3& x : places(200)) {  // continuous, and the gradient is its own
    const DistanceSample sample = field.at(x);
    for (int d = 0; d < 3; ++d) {
      const Vec3 step = 1e-7 * Vec3::Unit(d);
      EXPECT_NEAR(sample.gradient[d], (field.value(x + step) - field.value(x - step)) / 2e-7, 1e-5);
    }
  }
}

TEST(SampledDistance, BadVolumesAreNamed) {
  Volume bad = linear_field();
  bad.values[7] = std::nan("");
  EXPECT_THROW(SampledDistance{bad}, InputError);
  bad = linear_field();
  bad.values.conservativeResize(59);
  EXPECT_THROW(SampledDistance{bad}, InputError);
  bad = linear_field();
  bad.grid.n = {1, 4, 15};
  EXPECT_THROW(SampledDistance{bad}, InputError);
  bad = linear_field();
  bad.grid.spacing[1] = 0;
  EXPECT_THROW(SampledDistance{bad}, InputError);
}

}  // namespace
}  // namespace littoral
