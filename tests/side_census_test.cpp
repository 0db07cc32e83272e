// What the winding number of boxes in boxes says of their sides.

#include "methods/implicit/side_census.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/index.h"
#include "methods/implicit/settled_sides.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// Adds a box of that size about the origin, 12 triangles; `outward` or turned round.
void add_box(PolygonSoup& soup, double size, bool outward = true) {
  const int first = soup.n_vertices();
  soup.points.conservativeResize(first + 8, 3);
  for (int c = 0; c < 8; ++c)
    soup.points.row(first + c) << size * ((c & 1) - 0.5), size * ((c >> 1 & 1) - 0.5),
        size * ((c >> 2) - 0.5);
  for (const auto& q : {std::array{0, 2, 3, 1},
                        {4, 5, 7, 6},
                        {0, 1, 5, 4},
                        {2, 6, 7, 3},
                        {0, 4, 6, 2},
                        {1, 3, 7, 5}})
    for (const auto& t : {std::array{q[0], q[1], q[2]}, {q[0], q[2], q[3]}}) {
      const int b = outward ? t[1] : t[2], c = outward ? t[2] : t[1];
      test::add_triangle(soup, first + t[0], first + b, first + c);
    }
}

MatX3i faces_of(const PolygonSoup& soup) {
  MatX3i faces(soup.n_faces(), 3);
  for (int f = 0; f < soup.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) faces(f, k) = soup.face(f)[std::size_t(k)];
  return faces;
}

SideCensus census_of(const PolygonSoup& soup, int places = 2048) {
  const MatX3i faces = faces_of(soup);
  return side_census(soup.points, faces, WindingNumber(soup.points, faces), places);
}

PolygonSoup box() {
  PolygonSoup soup;
  add_box(soup, 1);
  return soup;
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
  PolygonSoup soup = box();
  add_box(soup, 2);  // four times the area
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

TEST(SideCensus, SharesOfBoxesInBoxes) {
  PolygonSoup wall = box();
  add_box(wall, 2);
  const auto inside = census_of(wall).shares({});
  EXPECT_NEAR(inside.bounds, 0.8, 1e-3);
  EXPECT_NEAR(inside.within, 0.2, 1e-3);
  EXPECT_EQ(inside.without, 0);

  PolygonSoup hollow;
  add_box(hollow, 1, false);
  add_box(hollow, 2);
  EXPECT_NEAR(census_of(hollow).shares({}).bounds, 1, 1e-3);

  PolygonSoup turned;
  add_box(turned, 1, false);
  const SideCensus census = census_of(turned);
  EXPECT_NEAR(census.shares({}).without, 1, 1e-3);
  EXPECT_NEAR(census.shares({1, -0.5}).bounds, 1, 1e-3);
  EXPECT_NEAR(census.shares({-1, 0.5}).bounds, 1, 1e-3);
}

TEST(SideCensus, TheRuleIsThatByWhichMostBounds) {
  PolygonSoup turned;
  add_box(turned, 1, false);
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
    return settled_sides(soup.points, faces_of(soup), as_given, {}, report);
  };
  Report plain, reversed, given, wall;
  EXPECT_NEAR(settled(box(), false, plain).inside({0.1, 0.2, 0.1}, infinity), 0.5, 1e-9);
  EXPECT_TRUE(codes(plain).empty());
  EXPECT_EQ(plain.status, "converged");

  PolygonSoup turned;
  add_box(turned, 1, false);
  const SettledSides sides = settled(turned, false, reversed);
  EXPECT_NEAR(sides.inside({0.1, 0.2, 0.1}, infinity), 0.5, 1e-9);
  EXPECT_NEAR(sides.inside({0.1, 0.2, 0.9}, infinity), -0.5, 1e-9);
  EXPECT_EQ(codes(reversed), std::vector<std::string>{"orientation-reversed"});
  const SettledSides as_given = settled(turned, true, given);
  EXPECT_NEAR(as_given.inside({0.1, 0.2, 0.1}, infinity), -0.5, 1e-9);
  EXPECT_NEAR(as_given.inside({0.1, 0.2, 0.9}, infinity), 0.5, 1e-9);
  EXPECT_TRUE(codes(given).empty());

  PolygonSoup in_box = box();
  add_box(in_box, 2);
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
  const SettledSides sides = settled_sides(open.points, faces_of(open), false, {}, report);
  EXPECT_EQ(sides.faces.rows(), 10);
  EXPECT_EQ(sides.boundary.size(), 4u);
  EXPECT_TRUE(sides.bounds);
}

}  // namespace
}  // namespace littoral
