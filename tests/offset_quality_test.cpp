#include "api/space/offset_quality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "api/space/isosurfaces.h"
#include "api/space/sdf.h"
#include "broken_shapes.h"
#include "report_helpers.h"
#include "space_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::hemisphere;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Offsets, OfAnOpenHemisphereAreClosedAndMeasured) {
  const PolygonSoup open = hemisphere(4, false);
  Report report;
  const Grid grid = test::cube_grid(48, 1.6);
  SpaceAnswer answer = grid_answer(open, grid, {}, Task(), report);
  const auto surfaces =
      offset_isosurfaces({grid, answer.at_nodes}, {0.2, -0.1}, {}, false, report, Task());
  for (const Isosurface& each : surfaces)
    measure_offset(each, open, answer.completion, report, Task());
  EXPECT_THAT(report.warnings, IsEmpty());
  EXPECT_EQ(report.status, "converged");
  for (const double d : {0.2, -0.1}) {
    const std::string name = d > 0 ? "offset 0.2: " : "offset -0.1: ";
    EXPECT_EQ(test::size_named(report, name + "open edges"), 0);
    EXPECT_NEAR(test::size_named(report, name + "median distance"), std::abs(d),
                0.01 * std::abs(d));
    EXPECT_NEAR(test::size_named(report, name + "least distance"), std::abs(d), 0.1 * std::abs(d));
  }
  // Flat tops: pi of pi + 2 pi (1.2)^2 + the quarter of a tube around the rim, and inside.
  const double outer = M_PI / (M_PI + 2 * M_PI * 1.44 + M_PI * M_PI * 0.2 + 2 * M_PI * 0.04);
  EXPECT_NEAR(test::size_named(report, "offset 0.2: share over holes"), outer, 0.02);
  EXPECT_GT(test::size_named(report, "offset -0.1: share over holes"), 0.3);
  // Measured against another distance than was asked for.
  Report wrong;
  measure_offset({0.21, surfaces.front().surface}, open, answer.completion, wrong, Task());
  EXPECT_EQ(wrong.status, "uncertain");
  EXPECT_THAT(wrong.warnings, Contains(AllOf(HasSubstr("offset 0.21"), HasSubstr("0.2,"))));
}

double distance_to_box(const Vec3& x) {
  const Vec3 q = x.cwiseAbs() - Vec3::Ones();
  return q.cwiseMax(0).norm() + std::min(0.0, q.maxCoeff());
}

TEST(Offsets, VerticesLieAtTheDistanceHoweverCoarseTheGrid) {
  // The distance is not linear along edges of the grid that pass a crease of it: below a corner
  // inside, and beyond a convex edge, where half a cell is more than was asked for.
  PolygonSoup open = test::box_soup(Vec3::Ones());
  open.corners.resize(open.corners.size() - open.face(open.n_faces() - 1).size());
  open.face_offsets.pop_back();
  const Grid grid = test::cube_grid(24, 1.45);
  for (const bool whole : {true, false}) {
    const PolygonSoup input = whole ? test::box_soup(Vec3::Ones()) : open;
    Report report;
    const SpaceAnswer answer = grid_answer(input, grid, {}, Task(), report);
    ASSERT_TRUE(answer.function);
    const Volume volume{grid, answer.at_nodes};
    const double h = grid.spacing.maxCoeff(), merged = 0.05 * std::sqrt(3.0) * h;
    for (const double d : {0.06, -0.06}) {
      Report by_nodes, by_function;
      const auto coarse = offset_isosurfaces(volume, {d}, {}, false, by_nodes, Task());
      const auto fine =
          offset_isosurfaces(volume, {d}, {}, false, by_function, Task(), answer.function.get());
      EXPECT_EQ(fine[0].surface.n_faces(), coarse[0].surface.n_faces());
      measure_offset(fine[0], input, answer.completion, by_function, Task());
      EXPECT_THAT(by_function.warnings, IsEmpty()) << d;
      const std::string name = d > 0 ? "offset 0.06: " : "offset -0.06: ";
      for (const char* part : {"", "over holes, "}) {
        if (whole && *part) continue;
        EXPECT_NEAR(test::size_named(by_function, name + part + "least over asked"), 1,
                    merged / 0.06);
        EXPECT_NEAR(test::size_named(by_function, name + part + "median over asked"), 1, 0.002);
        EXPECT_NEAR(test::size_named(by_function, name + part + "greatest over asked"), 1,
                    merged / 0.06);
      }
      if (whole) {
        for (Eigen::Index v = 0; v < fine[0].surface.points.rows(); ++v)
          EXPECT_NEAR(distance_to_box(fine[0].surface.points.row(v)), d, merged);
      }
    }
  }
}

TEST(Offsets, WarnWhereTheyAreFarFromWhatWasAsked) {
  // A sphere of radius 1 and one around it, of which one vertex is pulled out to four times the
  // distance, or in to 0.3 of it: of the area a hundredth.
  PolygonSoup sphere = test::octasphere_soup(5), shell = sphere;
  shell.points *= 1.1;
  Report quiet;
  measure_offset({0.1, shell}, sphere, {}, quiet, Task());
  EXPECT_THAT(quiet.warnings, IsEmpty());
  shell.points.row(0) *= 1.4 / 1.1;
  Report far;
  measure_offset({0.1, shell}, sphere, {}, far, Task());
  EXPECT_EQ(far.status, "uncertain");
  EXPECT_NEAR(test::size_named(far, "offset 0.1: greatest over asked"), 4, 1e-9);
  EXPECT_THAT(far.warnings, ElementsAre(HasSubstr("4 times as far as asked at (")));
  // The same over a hole, which the first octant closes.
  PolygonSoup hole, rest;
  hole.points = rest.points = sphere.points;
  for (int f = 0; f < sphere.n_faces(); ++f) {
    const auto corners = sphere.face(f);
    const std::vector<int> face(corners.begin(), corners.end());
    const bool at = std::find(face.begin(), face.end(), 0) != face.end();
    (at ? hole : rest).add_face(face);
  }
  Report over;
  measure_offset({0.1, shell}, rest, hole, over, Task());
  EXPECT_NEAR(test::size_named(over, "offset 0.1: over holes, greatest over asked"), 4, 1e-9);
  EXPECT_NEAR(test::size_named(over, "offset 0.1: greatest over asked"), 1, 0.02);
  EXPECT_THAT(over.warnings, ElementsAre(HasSubstr("over a hole of the input")));
  shell.points.row(0) *= 1.03 / 1.4;
  Report near;
  measure_offset({0.1, shell}, sphere, {}, near, Task());
  EXPECT_THAT(near.warnings, ElementsAre(HasSubstr("0.3 times as near as asked at (")));
}

}  // namespace
}  // namespace littoral
