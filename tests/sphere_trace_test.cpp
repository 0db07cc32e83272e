// Sphere tracing: known hits, fields that are steeper than they should be, jumps.
#include "methods/implicit/sphere_trace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "field_helpers.h"

namespace littoral {
namespace {

using test::Formula;

Formula ball(double scale) {
  return Formula([scale](const Vec3& x) {
    return DistanceSample{scale * (x.norm() - 1), scale * x.normalized()};
  });
}

TEST(SphereTrace, MeetsBallsWhereTheyAre) {
  const Formula field = ball(1);
  TraceOptions options;
  options.tolerance = 1e-6;
  for (double level : {-0.4, 0.0, 0.7}) {
    options.level = level;
    const double r = 1 + level;
    for (double aside : {0.0, 0.3, 0.59}) {
      const TraceHit hit = sphere_trace(field, {aside, 0, 5}, -Vec3::UnitZ(), 0, 10, options);
      ASSERT_TRUE(hit.found);
      const Vec3 x(aside, 0, 5 - hit.t);
      EXPECT_NEAR(hit.t, 5 - std::sqrt(r * r - aside * aside), 1e-5);
      EXPECT_NEAR((hit.normal - x.normalized()).norm(), 0, 1e-9);
    }
    EXPECT_FALSE(sphere_trace(field, {r + 1e-3, 0, 5}, -Vec3::UnitZ(), 0, 10, options).found);
    EXPECT_FALSE(sphere_trace(field, {0, 0, 5}, -Vec3::UnitZ(), 0, 2, options).found);
    EXPECT_FALSE(sphere_trace(field, {0, 0, 5}, -Vec3::UnitZ(), 3, 3, options).found);
  }
  options.level = 0;  // from inside the far wall is seen
  EXPECT_NEAR(sphere_trace(field, {0, 0, 0.5}, -Vec3::UnitZ(), 0, 10, options).t, 1.5, 1e-5);
}

TEST(SphereTrace, SteepFieldsAreBracketed) {
  TraceOptions options;
  options.tolerance = 1e-6;  // the first step ends inside
  const TraceHit hit = sphere_trace(ball(1.25), {0.2, 0, 5}, -Vec3::UnitZ(), 0, 10, options);
  ASSERT_TRUE(hit.found);
  EXPECT_NEAR(hit.t, 5 - std::sqrt(1 - 0.04), 1e-5);
  EXPECT_NEAR(trace_steepness(ball(1.7), Vec3::Constant(-2), Vec3::Constant(2), 0), 1.785, 1e-9);
  EXPECT_EQ(trace_steepness(ball(0.3), Vec3::Constant(-2), Vec3::Constant(2), 0), 1);
}

TEST(SphereTrace, BracketsCloseInFewSteps) {
  int asked = 0;
  const Formula field([&asked](const Vec3& x) {
    ++asked;
    return ball(1.25).at(x);
  });
  TraceOptions options;
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    options.tolerance = tolerance;
    asked = 0;
    EXPECT_TRUE(sphere_trace(field, {0.2, 0, 5}, -Vec3::UnitZ(), 0, 10, options).found);
    EXPECT_GT(asked, 3);
    EXPECT_LT(asked, 16) << tolerance;  // 12 were seen, and 33 where every step halves a value
  }
}

TEST(SphereTrace, JumpsAreNoSurface) {
  // Changes sign on the plane z = 2 without being near 0, then reaches the plane z = 0.
  const Formula jump([](const Vec3& x) {
    return DistanceSample{x[2] > 2 ? 1.0 : -x[2], -Vec3::UnitZ()};
  });
  TraceOptions options;
  options.tolerance = 1e-6;
  const TraceHit hit = sphere_trace(jump, {0, 0, 5}, -Vec3::UnitZ(), 0, 10, options);
  ASSERT_TRUE(hit.found);
  EXPECT_NEAR(hit.t, 5, 1e-5);
}

TEST(SphereTrace, ValuesThatAreNoNumbersEndARay) {
  const Formula bad([](const Vec3&) { return DistanceSample{std::nan(""), Vec3::Zero()}; });
  TraceOptions options;
  options.tolerance = 1e-6;
  EXPECT_FALSE(sphere_trace(bad, {0, 0, 5}, -Vec3::UnitZ(), 0, 10, options).found);
  EXPECT_EQ(trace_steepness(bad, Vec3::Zero(), Vec3::Ones(), 0), 1);
}

}  // namespace
}  // namespace littoral
