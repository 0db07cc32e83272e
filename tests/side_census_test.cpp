// What the winding number of boxes in boxes says of their sides.

#include "methods/implicit/side_census.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/index.h"
#include "broken_shapes.h"
#include "methods/implicit/settled_sides.h"
#include "space_helpers.h"
#include "spatial/triangulate.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// About the origin, 12 triangles.
PolygonSoup box(double size = 1) { return triangulate(test::box_soup(Vec3::Constant(size / 2))); }

SideCensus census_of(const PolygonSoup& soup, int places = 2048) {
  const MatX3i faces = triangles_of(soup);
  return side_census(soup.points, faces, WindingNumber(soup.points, faces), places);
}

TEST(SideCensus, BehindABoxIsOneAndBeforeItNothing) {
  const SideCensus census = census_of(box());
  ASSERT_EQ(census.face.size(), 2048u);
  for (std::size_t i = 1; i < census.face.size(); ++i) {  // the first lies on an edge
    EXPECT_NEAR(census.back[i], 1, 1e-9);
    EXPECT_NEAR(census.front[i], 0, 1e-9);
  }
}

TEST(SideCensus, PlacesAreSpreadByArea) {
  const PolygonSoup soup = test::joined(box(), box(2));  // which has four times the area
  for (const int places : {60, 2048}) {
    const SideCensus census = census_of(soup, places);
    EXPECT_TRUE(std::is_sorted(census.face.begin(), census.face.end()));
    for (int f = 0; f < 24; ++f)
      EXPECT_NEAR(double(std::count(census.face.begin(), census.face.end(), f)),
                  places / 60.0 * (f < 12 ? 1 : 4), 1)
          << f;
  }
  EXPECT_TRUE(census_of(PolygonSoup()).face.empty());
}

TEST(SideCensus, PartsMuchSmallerThanTheirDistanceBound) {
  PolygonSoup near = box(1e-6), far = near;
  far.points.col(0).array() += 1;
  const auto shares = census_of(test::joined(near, far)).shares({});
  EXPECT_NEAR(shares.bounds, 1, 1e-3);
}

TEST(SideCensus, SharesOfBoxesInBoxes) {
  const PolygonSoup wall = test::joined(box(), box(2));
  const auto inside = census_of(wall).shares({});
  EXPECT_NEAR(inside.bounds, 0.8, 1e-3);
  EXPECT_NEAR(inside.within, 0.2, 1e-3);
  EXPECT_EQ(inside.without, 0);

  const PolygonSoup hollow = test::joined(test::reversed(box()), box(2));
  EXPECT_NEAR(census_of(hollow).shares({}).bounds, 1, 1e-3);

  const PolygonSoup turned = test::reversed(box());
  const SideCensus census = census_of(turned);
  EXPECT_NEAR(census.shares({}).without, 1, 1e-3);
  EXPECT_NEAR(census.shares({1, -0.5}).bounds, 1, 1e-3);
  EXPECT_NEAR(census.shares({-1, 0.5}).bounds, 1, 1e-3);
}

TEST(SideCensus, TheRuleIsThatByWhichMostBounds) {
  const PolygonSoup turned = test::reversed(box());
  EXPECT_EQ(choose_sides(census_of(box()), false).sense, 1);
  EXPECT_EQ(choose_sides(census_of(box()), false).level, 0.5);
  EXPECT_EQ(choose_sides(census_of(turned), false).sense, -1);
  EXPECT_EQ(choose_sides(census_of(turned), false).level, 0.5);
  EXPECT_EQ(choose_sides(census_of(turned), true).sense, 1);
  EXPECT_EQ(choose_sides(census_of(turned), true).level, -0.5);
  EXPECT_EQ(choose_sides(census_of(PolygonSoup()), true).level, 0.5);
}

std::vector<std::string> codes(const Report& report) {
  std::vector<std::string> out;
  for (const Warning& w : report.warnings) out.push_back(w.code);
  return out;
}

TEST(SettledSides, WhatIsInsideAndWhatIsSaidOfIt) {
  const auto settled = [](const PolygonSoup& soup, bool as_given, Report& report) {
    return settled_sides(soup.points, triangles_of(soup), as_given, {}, report);
  };
  Report plain, reversed, given, wall;
  EXPECT_NEAR(settled(box(), false, plain).inside({0.1, 0.2, 0.1}, infinity), 0.5, 1e-9);
  EXPECT_TRUE(codes(plain).empty());
  EXPECT_EQ(plain.status, "converged");

  const PolygonSoup turned = test::reversed(box());
  const SettledSides sides = settled(turned, false, reversed);
  EXPECT_NEAR(sides.inside({0.1, 0.2, 0.1}, infinity), 0.5, 1e-9);
  EXPECT_NEAR(sides.inside({0.1, 0.2, 0.9}, infinity), -0.5, 1e-9);
  EXPECT_EQ(codes(reversed), std::vector<std::string>{"orientation-reversed"});
  const SettledSides as_given = settled(turned, true, given);
  EXPECT_NEAR(as_given.inside({0.1, 0.2, 0.1}, infinity), -0.5, 1e-9);
  EXPECT_NEAR(as_given.inside({0.1, 0.2, 0.9}, infinity), 0.5, 1e-9);
  EXPECT_TRUE(codes(given).empty());

  const PolygonSoup in_box = test::joined(box(), box(2));
  EXPECT_NEAR(settled(in_box, false, wall).inside({0.1, 0.2, 0.1}, infinity), 1.5, 1e-9);
  EXPECT_EQ(codes(wall), std::vector<std::string>{"walls-inside"});
}

TEST(SettledSides, CopiesThatOpenASurfaceAreLeftOut) {
  PolygonSoup open = box();
  open.corners.resize(30);  // two faces are missing
  open.face_offsets.resize(11);
  for (const int f : {2, 3})
    test::add_triangle(open, open.face(f)[0], open.face(f)[1], open.face(f)[2]);
  Report report;
  const SettledSides sides = settled_sides(open.points, triangles_of(open), false, {}, report);
  EXPECT_EQ(sides.faces.rows(), 10);
  EXPECT_EQ(sides.boundary.size(), 4u);
  EXPECT_TRUE(sides.bounds);
}

}  // namespace
}  // namespace littoral
