#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "api/space/sdf.h"
#include "api/space/walls.h"
#include "broken_shapes.h"
#include "littoral/repair.h"
#include "repair_helpers.h"
#include "space_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(RepairWallsSlow, SheetsBecomeWalls) {
  const PolygonSoup sheet = test::grid_soup(4, 4);
  RepairOptions options;
  options.grid.resolution = 64;
  const Repaired usual = repair(sheet, options);  // three spacings thick
  test::expect_watertight(usual.surface);
  ASSERT_FALSE(usual.report.warnings.empty());
  EXPECT_EQ(usual.report.warnings.back().code, "sheets-thickened");
  options.thicken = 0.1;
  const Repaired out = repair(sheet, options);
  test::expect_watertight(out.surface);
  EXPECT_EQ(test::size_named(out.report, "parts"), 1);
  // Steiner's formula: the sheet's area, half a tube along its sides, quarters of a ball.
  const double r = 0.05, steiner = 2 * r + M_PI * r * r * 2 + 4 * M_PI / 3 * r * r * r;
  EXPECT_NEAR(test::volume_of(out.surface.soup()), steiner, 0.01 * steiner);
}

TEST(RepairWallsSlow, OnlySheetsBecomeWalls) {
  const PolygonSoup box = test::box_soup(Vec3(0.5, 0.5, 0.5));
  RepairOptions options;
  options.grid.resolution = 48;
  options.thicken = 0.1;
  for (const bool remesh : {false, true}) {
    options.remesh = remesh;
    const Repaired closed = repair(box, options);
    EXPECT_EQ(closed.report.status, "converged");
    EXPECT_NEAR(test::volume_of(closed.surface.soup()), 1, 1e-6);
    if (remesh) {
      EXPECT_EQ(test::size_named(closed.report, "triangles that became walls"), 0);
    }
  }
  options.remesh = false;
  // A fin of half its width outside of the box, which stays as large as it is.
  PolygonSoup fin = test::grid_soup(2, 2);
  fin.points.rowwise() += Eigen::RowVector3d(0, -0.5, 0);
  const Repaired out = repair(test::joined(box, fin), options);
  test::expect_watertight(out.surface);
  EXPECT_EQ(test::size_named(out.report, "parts"), 1);
  EXPECT_LT(test::size_named(out.report, "input missed, share"), 0.005);
  // Steiner's formula for what sticks out: half a tube along three sides, quarters of a ball.
  const double r = 0.05, steiner = 2 * r * 0.5 + M_PI * r * r / 2 * 2 + 2 * M_PI / 3 * r * r * r;
  EXPECT_NEAR(test::volume_of(out.surface.soup()), 1 + steiner, 0.002);
  EXPECT_GT(test::size_named(out.report, "vertices moved onto the input"), 1000);
  // A fin has one half of its area outside, as much as a tenth of the box's has.
  EXPECT_NEAR(test::size_named(out.report, "share of the area that became walls"), 0.5 / 7, 0.01);
}

/// Steiner's formula: what lies within r of a box with these sides.
double steiner_of(const Vec3& side, double r) {
  const double area = 2 * (side[0] * side[1] + side[1] * side[2] + side[2] * side[0]);
  return side.prod() + r * area + M_PI * r * r * side.sum() + 4 * M_PI / 3 * r * r * r;
}

/// A box askew above the origin.
PolygonSoup thin_part(const Vec3& half, double angle) {
  PolygonSoup thin = test::box_soup(half);
  const Eigen::Matrix3d turn(Eigen::AngleAxis<double>(angle, Vec3(1, 2, 3).normalized()));
  thin.points = thin.points * turn.transpose();
  thin.points.rowwise() += Eigen::RowVector3d(0.1, 0, 0.7);
  return thin;
}

TEST(RepairWallsSlow, ThinPartsBecomeWallsAsAWhole) {
  // Plates and sticks so thin that the grid hits them in places, beside a box that it holds: they
  // become as thick as is asked for, all over, and the box stays as it is.
  const PolygonSoup box = test::box_soup(Vec3(0.5, 0.4, 0.3));
  RepairOptions options;
  options.remesh = true;
  options.grid.resolution = 64;  // a spacing is about 0.03
  options.thicken = 0.08;
  for (const auto& [half, tolerance] :  // round walls have chords of about a spacing
       {std::pair(Vec3(0.4, 0.3, 0.01), 0.02),
        {Vec3(0.4, 0.3, 0.0005), 0.02},
        {Vec3(0.4, 0.008, 0.006), 0.08}}) {
    const Repaired out = repair(test::joined(box, thin_part(half, 0.2)), options);
    test::expect_watertight(out.surface);
    EXPECT_EQ(test::size_named(out.report, "parts"), 2);
    EXPECT_EQ(test::size_named(out.report, "input missed, share"), 0);
    const auto area = [](const Vec3& a) { return 8 * (a[0] * a[1] + a[1] * a[2] + a[2] * a[0]); };
    const double share = area(half) / (area(half) + area(Vec3(0.5, 0.4, 0.3)));
    EXPECT_NEAR(test::size_named(out.report, "share of the area that became walls"), share,
                0.06 * share);
    const double r = (options.thicken - 2 * half.minCoeff()) / 2;
    const double volume = steiner_of(2 * half, r);
    EXPECT_NEAR(test::volume_of(out.surface.soup()), 8 * 0.5 * 0.4 * 0.3 + volume,
                tolerance * volume);
  }
}

TEST(RepairWallsSlow, ThinPartsBecomeWallsWhereTheyAreTornAlone) {
  // As thick as a spacing, nearly: the surface has holes, but misses little of the area.
  const PolygonSoup box = test::box_soup(Vec3(0.5, 0.4, 0.3));
  RepairOptions options;
  options.remesh = true;
  options.grid.resolution = 64;
  options.thicken = 0.08;
  for (const auto& [thickness, walls] : {std::pair(0.0186, true), std::pair(0.03, false)}) {
    const Vec3 half(0.4, 0.3, thickness / 2);
    const Repaired out = repair(test::joined(box, thin_part(half, 0.6)), options);
    test::expect_watertight(out.surface);
    EXPECT_EQ(test::size_named(out.report, "parts"), 2);
    const double volume = walls ? steiner_of(2 * half, 0.04 - thickness / 2) : 8 * half.prod();
    EXPECT_NEAR(test::volume_of(out.surface.soup()), 8 * 0.5 * 0.4 * 0.3 + volume, 0.03 * volume);
  }
}

TEST(RepairWalls, WhatLiesOnThePartIsNoWall) {
  // A sheet of two triangles that lies on a box: what reaches over it becomes a wall, the rest of
  // the same triangles does not.
  const PolygonSoup box = test::box_soup(Vec3(0.5, 0.5, 0.5));
  PolygonSoup sheet = test::grid_soup(1, 1);
  sheet.points.rowwise() += Eigen::RowVector3d(0, -0.5, 0.5);
  RepairOptions options;
  options.remesh = true;
  options.grid.resolution = 64;
  options.thicken = 0.1;
  const Repaired out = repair(test::joined(box, sheet), options);
  test::expect_watertight(out.surface);
  const PolygonSoup soup = out.surface.soup();
  double top = 0;  // over the box, away from what reaches over it
  for (int v = 0; v < soup.n_vertices(); ++v)
    if (soup.points(v, 0) < 0.4) top = std::max(top, soup.points(v, 2));
  EXPECT_NEAR(top, 0.5, 1e-9);
  const double r = 0.05, whole = 2 * r * 0.5 + M_PI * r * r / 2 * 2 + 2 * M_PI / 3 * r * r * r;
  const double above = M_PI * r * r / 4 * 1;  // a quarter of a tube at most on the box
  EXPECT_GT(test::volume_of(soup), 1 + whole - 0.002);
  EXPECT_LT(test::volume_of(soup), 1 + whole + above + 0.002);
}

/// A flat rod along x of needles from end to end, side by side.
PolygonSoup needles(int count, double width) {
  PolygonSoup out;
  out.points.resize(4 * count, 3);
  for (int k = 0; k < count; ++k) {
    const double y = width * k / count, next = width * (k + 1) / count;
    out.points.middleRows(4 * k, 4) << 0, y, 0, 1, y, 0, 1, next, 0, 0, next, 0;
    out.add_face(std::array{4 * k, 4 * k + 1, 4 * k + 2});
    out.add_face(std::array{4 * k, 4 * k + 2, 4 * k + 3});
  }
  return out;
}

TEST(RepairWallsSlow, CrowdedNeedlesTakeTheTimeOfAFew) {
  const double width = 0.004, r = 0.05;
  const PolygonSoup crowd = needles(200, width), few = needles(1, width);
  const Grid grid = choose_grid(crowd, {.resolution = 64});
  const Walls walls = walls_of_all(crowd, grid, 2 * r, {}),
              of_few = walls_of_all(few, grid, 2 * r, {});
  EXPECT_EQ(walls.triangles, 400);
  EXPECT_EQ(walls.share, 1);
  EXPECT_LE(walls.pieces.n_faces(), 4 * of_few.pieces.n_faces());

  RepairOptions options;
  options.grid.resolution = 64;
  options.thicken = 2 * r;
  const Repaired out = repair(crowd, options);
  test::expect_watertight(out.surface);
  const double volume = test::volume_of(out.surface.soup());
  EXPECT_NEAR(volume, test::volume_of(repair(few, options).surface.soup()), 0.03 * volume);
}

TEST(RepairWallsSlow, DentsAreNoWalls) {
  // Small pieces between the holes of a sphere: its surface may not reach them, but they are no
  // sheets.
  const PolygonSoup whole = test::octasphere_soup(4);
  PolygonSoup broken;
  broken.points = whole.points;
  std::mt19937 random(5);
  for (int f = 0; f < whole.n_faces(); ++f)
    if (random() % 3 > 0)
      test::add_triangle(broken, whole.face(f)[0], whole.face(f)[1], whole.face(f)[2]);
  RepairOptions options;
  options.grid.resolution = 96;
  const Repaired without = repair(broken, options);
  options.thicken = 0.1;
  const Repaired with = repair(broken, options);
  test::expect_watertight(with.surface);
  EXPECT_EQ(test::size_named(with.report, "triangles that became walls"), 0);
  EXPECT_NEAR(test::volume_of(with.surface.soup()), test::volume_of(without.surface.soup()), 0.005);
  EXPECT_GT(test::size_named(with.report, "input missed, share"), 0);
}

}  // namespace
}  // namespace littoral
