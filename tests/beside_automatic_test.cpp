// Named methods beside the automatic one: warned about where sides disagree, and only there.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "api/space/csg.h"
#include "test_meshes.h"

namespace littoral {
namespace {

CsgShapes ball_by(const AnyMethod& method, PolygonSoup soup) {
  CsgShapes shapes;
  shapes.all.resize(1);
  shapes.all[0].surface = std::move(soup);
  shapes.all[0].request.method = method;
  return shapes;
}

PolygonSoup every_second_turned(PolygonSoup soup) {
  for (int f = 0; f < soup.n_faces(); f += 2)
    std::swap(soup.corners[3 * f], soup.corners[3 * f + 1]);
  return soup;
}

bool warns(const Report& report) {
  return std::ranges::any_of(report.warnings, [](const auto& warning) {
    return warning.text.find("differ from those of method auto") != std::string::npos;
  });
}

TEST(BesideAutomatic, MethodsThatLoseTheSideSaySo) {
  for (const AnyMethod& method : {AnyMethod(SpaceSignedHeat{}), AnyMethod(Planar{})}) {
    for (const bool turned : {false, true}) {
      const PolygonSoup ball = test::octasphere_soup(3);
      const CsgShapes shapes = ball_by(method, turned ? every_second_turned(ball) : ball);
      const Grid grid = choose_grid(shapes, {.resolution = 24});
      Report report;
      grid_distance(shapes, grid, {}, report);
      EXPECT_EQ(warns(report), turned) << method.name();
    }
  }
}

TEST(BesideAutomatic, ThinPartsHaveTheirInsideNextToTheSurface) {
  for (const bool turned : {false, true}) {
    PolygonSoup plate = test::octasphere_soup(4);
    plate.points.col(2) *= 0.06;  // three spacings at most
    if (turned)
      for (int f = 0; f < plate.n_faces(); ++f)
        std::swap(plate.corners[3 * std::size_t(f)], plate.corners[3 * std::size_t(f) + 1]);
    const CsgShapes shapes = ball_by(AnyMethod::named("winding"), plate);
    const Grid grid = choose_grid(shapes, {.resolution = 48});
    Report report;
    grid_distance(shapes, grid, {}, report);
    EXPECT_EQ(warns(report), turned);
  }
}

TEST(BesideAutomatic, FieldsToBeAskedAtPointsToo) {
  for (const bool turned : {false, true}) {
    const PolygonSoup ball = test::octasphere_soup(2);
    const CsgShapes shapes =
        ball_by(AnyMethod::named("winding"), turned ? every_second_turned(ball) : ball);
    Report report;
    pointwise_distance(shapes, {}, report);
    EXPECT_EQ(warns(report), turned);
  }
}

TEST(BesideAutomatic, NothingIsComparedOfTheMethodItself) {
  const PolygonSoup ball = test::octasphere_soup(2);
  Report report;
  grid_distance(ball_by(AnyMethod(SpaceAutomatic{}), every_second_turned(ball)),
                choose_grid(ball, {.resolution = 12}), {}, report);
  EXPECT_FALSE(warns(report));
  EXPECT_TRUE(std::ranges::none_of(report.residuals, [](const auto& each) {
    return each.first == "mean difference from method auto";
  }));
}

}  // namespace
}  // namespace littoral
