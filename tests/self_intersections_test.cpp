#include "spatial/self_intersections.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "broken_shapes.h"
#include "spatial/exact_signs.h"
#include "spatial/triangulate.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(ExactSigns, OfPointsNextToAPlane) {
  // The plane x + y + z = 3/2 through points that doubles hold exactly.
  const Vec3 a(1.5, 0, 0), b(0, 1.5, 0), c(0, 0, 1.5);
  const double ulp = std::ldexp(1.0, -53);
  EXPECT_EQ(orientation_sign(a, b, c, Vec3(0.5, 0.5, 0.5)), 0);
  EXPECT_EQ(orientation_sign(a, b, c, Vec3(0.5, 0.5, 0.5 + 2 * ulp)), 1);
  EXPECT_EQ(orientation_sign(a, b, c, Vec3(0.5, 0.5, 0.5 - ulp)), -1);
  EXPECT_EQ(orientation_sign(a, c, b, Vec3(0.5, 0.5, 0.5 - ulp)), 1);
}

TEST(ExactSigns, DoNotDependOnTheOrderOfThePoints) {
  // Nearly coplanar points, where rounding alone would give answers that contradict each other.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  int flat = 0;
  for (int i = 0; i < 2000; ++i) {
    std::array<Vec3, 4> x;
    for (Vec3& p : x) p = Vec3(0.1, 0.1, 0.1) * std::round(4 * u(random)) + Vec3(0, u(random), 0);
    const int sign = orientation_sign(x[0], x[1], x[2], x[3]);
    flat += sign == 0;
    EXPECT_EQ(orientation_sign(x[1], x[0], x[2], x[3]), -sign);
    EXPECT_EQ(orientation_sign(x[3], x[1], x[2], x[0]), -sign);
    EXPECT_EQ(orientation_sign(x[1], x[2], x[0], x[3]), sign);
  }
  EXPECT_GT(flat, 200);  // where two lie on one vertical line
}

TEST(ExactSigns, HoldAtAnyScale) {
  for (const double scale : {1e-200, 1e-100, 1.0, 1e100, 1e200}) {
    const Vec3 a = scale * Vec3(1, 0, 0), b = scale * Vec3(0, 1, 0), c = scale * Vec3(0, 0, 1);
    EXPECT_EQ(orientation_sign(a, b, c, 2 * (a + b + c)), 1);
    EXPECT_EQ(orientation_sign(a, b, c, Vec3::Zero()), -1);
    EXPECT_EQ(orientation_sign(a, b, c, Vec3((a + b) / 2)), 0);
    EXPECT_EQ(orientation_sign(Vec2(0, 0), Vec2(scale, 0), Vec2(scale, scale)), 1);
    EXPECT_EQ(orientation_sign(Vec2(0, 0), Vec2(scale, scale), Vec2(3 * scale, 3 * scale)), 0);
  }
}

int crossing(const PolygonSoup& soup) {
  const auto flags = self_intersecting_faces(soup.points, triangles_of(soup));
  return std::accumulate(flags.begin(), flags.end(), 0);
}

/// Two triangles by their corners; equal positions are one corner.
int crossing_of(const std::array<Vec3, 6>& x) {
  PolygonSoup soup;
  soup.points.resize(6, 3);
  for (int i = 0; i < 6; ++i) soup.points.row(i) = x[i];
  test::add_triangle(soup, 0, 1, 2);
  test::add_triangle(soup, 3, 4, 5);
  const int n = crossing(soup);
  EXPECT_TRUE(n == 0 || n == 2);  // both or none
  return n;
}

TEST(SelfIntersections, OfTwoTriangles) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  // Nothing in common.
  EXPECT_EQ(crossing_of({a, b, c, Vec3(.2, .2, -1), Vec3(.2, .2, 1), Vec3(2, 2, 0)}), 2);
  EXPECT_EQ(crossing_of({a, b, c, Vec3(.8, .8, -1), Vec3(.8, .8, 1), Vec3(2, 2, 0)}), 0);
  EXPECT_EQ(crossing_of({a, b, c, Vec3(.2, .2, 1e-9), Vec3(.3, .2, 1), Vec3(.2, .3, 1)}), 0);
  EXPECT_EQ(crossing_of({a, b, c, Vec3(.2, .2, 0), Vec3(.3, .2, 1), Vec3(.2, .3, 1)}), 2);
  // In one plane: apart, overlapping, one within the other.
  EXPECT_EQ(crossing_of({a, b, c, Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 2, 0)}), 0);
  EXPECT_EQ(crossing_of({a, b, c, Vec3(.4, .4, 0), Vec3(2, 1, 0), Vec3(1, 2, 0)}), 2);
  EXPECT_EQ(crossing_of({a, b, c, Vec3(.1, .1, 0), Vec3(.2, .1, 0), Vec3(.1, .2, 0)}), 2);
  // A common corner.
  EXPECT_EQ(crossing_of({a, b, c, a, Vec3(-1, 0, 0), Vec3(0, -1, 0)}), 0);
  EXPECT_EQ(crossing_of({a, b, c, a, Vec3(1, 1, 1), Vec3(1, 1, -1)}), 2);
  EXPECT_EQ(crossing_of({a, b, c, a, Vec3(.2, .2, 1), Vec3(.2, .2, -1)}), 2);
  EXPECT_EQ(crossing_of({a, b, c, a, Vec3(.3, .3, 0), Vec3(0, 0, 1)}), 2);
  EXPECT_EQ(crossing_of({a, b, c, a, Vec3(-.3, -.3, 0), Vec3(0, 0, 1)}), 0);
  // A common side.
  EXPECT_EQ(crossing_of({a, b, c, b, a, Vec3(0, 0, 1)}), 0);
  EXPECT_EQ(crossing_of({a, b, c, b, a, Vec3(0, -1, 0)}), 0);
  EXPECT_EQ(crossing_of({a, b, c, b, a, Vec3(.3, .3, 0)}), 2);
  EXPECT_EQ(crossing_of({a, b, c, b, a, Vec3(.3, .3, 1e-300)}), 0);
  // The same triangle twice.
  EXPECT_EQ(crossing_of({a, b, c, c, b, a}), 2);
}

TEST(SelfIntersections, OfWholeSurfaces) {
  PolygonSoup sphere = test::octasphere_soup(3);
  EXPECT_EQ(crossing(sphere), 0);
  EXPECT_EQ(crossing(test::grid_soup(9, 7)), 0);
  // Two spheres that cross.
  PolygonSoup shifted = sphere;
  shifted.points.rowwise() += Eigen::RowVector3d(0.77, 0, 0);
  const PolygonSoup two = test::joined(sphere, shifted);
  const auto flags = self_intersecting_faces(two.points, triangles_of(two));
  int n = 0;
  for (int f = 0; f < two.n_faces(); ++f) {
    if (!flags[f]) continue;
    ++n;  // along the circle where they meet
    double x = 0;
    for (const int v : two.face(f)) x += two.points(v, 0) / 3;
    EXPECT_NEAR(x, 0.385, 0.2);
  }
  EXPECT_GT(n, 40);
  // Corners that are not finite, faces without area, and no faces at all.
  sphere.points(0, 0) = NAN;
  EXPECT_EQ(crossing(sphere), 0);
  EXPECT_EQ(crossing_of({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0),
                         Vec3(2, 0, 0)}),
            0);
  EXPECT_EQ(crossing(PolygonSoup{}), 0);
}

/// Each face's flag is that of its pairs with the others.
void expect_as_pairs(const PolygonSoup& soup) {
  const MatX3i faces = triangles_of(soup);
  const auto all = self_intersecting_faces(soup.points, faces);
  for (int f = 0; f < soup.n_faces(); ++f) {
    bool any = false;
    for (int g = 0; g < soup.n_faces() && !any; ++g) {
      if (g == f) continue;
      MatX3i pair(2, 3);
      pair << faces.row(f), faces.row(g);
      any = self_intersecting_faces(soup.points, pair)[0] != 0;
    }
    EXPECT_EQ(any, all[f] != 0) << f;
  }
}

TEST(SelfIntersections, AgreeWithAllPairs) {
  // Random triangles: what the tree leaves out does not meet.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  PolygonSoup soup;
  soup.points.resize(3 * 150, 3);
  for (int f = 0; f < 150; ++f) {
    const Vec3 centre(u(random), u(random), u(random));
    for (int k = 0; k < 3; ++k)
      soup.points.row(3 * f + k) = centre + 0.2 * Vec3(u(random), u(random), u(random));
    test::add_triangle(soup, 3 * f, 3 * f + 1, 3 * f + 2);
  }
  expect_as_pairs(soup);
  const MatX3i faces = triangles_of(soup);
  const auto all = self_intersecting_faces(soup.points, faces);
  std::vector<char> asked(150, 0);  // also of some faces alone
  for (int f = 0; f < 150; f += 7) asked[f] = 1;
  const auto some = self_intersecting_faces(soup.points, faces, {}, asked);
  for (int f = 0; f < 150; ++f) EXPECT_EQ(some[f], asked[f] && all[f]) << f;
}

TEST(SelfIntersections, AgreeWithAllPairsWhereAllHaveOneCorner) {
  // On a lattice, so that sides also touch, lie in one plane or are the same.
  std::mt19937 random(7);
  std::uniform_int_distribution<int> step(-1, 1);
  int meeting = 0;
  for (const int width : {3, 6, 12}) {
    std::uniform_int_distribution<int> place(-width, width);
    PolygonSoup soup;
    soup.points.resize(2 * 60 + 1, 3);
    soup.points.row(0).setZero();
    for (int f = 0; f < 60; ++f) {
      const Vec3 x(place(random), place(random), 2 * width);
      soup.points.row(2 * f + 1) = x;
      soup.points.row(2 * f + 2) = x + Vec3(step(random), step(random), step(random));
      test::add_triangle(soup, 0, 2 * f + 1, 2 * f + 2);
    }
    expect_as_pairs(soup);
    meeting += crossing(soup);
  }
  EXPECT_GT(meeting, 10);
  EXPECT_LT(meeting, 150);  // of 180
}

TEST(SelfIntersections, OfAConeOnItsBase) {
  // Two fans over each other with a common rim: no part of space holds faces of one alone.
  constexpr int n = 500;
  PolygonSoup cone;
  cone.points.resize(n + 2, 3);
  cone.points.row(n) << 0, 0, 1;
  cone.points.row(n + 1).setZero();
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    cone.points.row(i) << std::cos(angle), std::sin(angle), 0;
    test::add_triangle(cone, i, (i + 1) % n, n);
    test::add_triangle(cone, (i + 1) % n, i, n + 1);
  }
  EXPECT_EQ(crossing(cone), 0);
  cone.points(n + 1, 2) = 0.5;  // a dent, whose tip stays within
  EXPECT_EQ(crossing(cone), 0);
  cone.points.row(n + 1) << 0.9, 0, 0.5;  // outside
  EXPECT_GT(crossing(cone), 0);
}

TEST(SelfIntersectionsSlow, OfTwoLargeFansWithACommonRim) {
  constexpr int n = 2000;
  for (const double low : {-1.0, 0.0, 0.5}) {
    PolygonSoup cones;
    cones.points.resize(n + 2, 3);
    cones.points.row(n) << 0, 0, 1;
    cones.points.row(n + 1) << 0, 0, low;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      cones.points.row(i) << std::cos(angle), std::sin(angle), 0;
      test::add_triangle(cones, i, (i + 1) % n, n);
      test::add_triangle(cones, (i + 1) % n, i, n + 1);
    }
    EXPECT_EQ(crossing(cones), 0) << low;
    cones.points.row(n + 1) << 0.9, 0, 0.5;  // outside of the first
    EXPECT_GT(crossing(cones), 0) << low;
  }
}

TEST(SelfIntersections, AgreeWithAllPairsForFansWithACommonRim) {
  // On a lattice, so that fans also touch, lie in one plane or are folded onto each other.
  std::mt19937 random(11);
  std::uniform_int_distribution<int> place(-4, 4), height(-1, 1);
  int meeting = 0;
  constexpr int n = 40, rounds = 30;
  for (int round = 0; round < rounds; ++round) {
    PolygonSoup cones;
    cones.points.resize(n + 2, 3);
    for (int k : {n, n + 1}) cones.points.row(k) << place(random), place(random), place(random);
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      cones.points.row(i) << std::round(12 * std::cos(angle)), std::round(12 * std::sin(angle)),
          round % 3 == 0 ? 0 : height(random);
      test::add_triangle(cones, i, (i + 1) % n, n);
      test::add_triangle(cones, (i + 1) % n, i, n + 1);
    }
    expect_as_pairs(cones);
    meeting += crossing(cones);
  }
  EXPECT_GT(meeting, 100);
  EXPECT_LT(meeting, 2 * n * rounds - 100);
}

TEST(SelfIntersections, OfAConeWithVeryManySides) {
  constexpr int n = 30000;  // all pairs would take minutes
  PolygonSoup cone;
  cone.points.resize(n + 1, 3);
  cone.points.row(n) << 0, 0, 1;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    cone.points.row(i) << std::cos(angle), std::sin(angle), 0;
    test::add_triangle(cone, i, (i + 1) % n, n);
  }
  EXPECT_EQ(crossing(cone), 0);
  // A triangle from the tip, one side of it within the cone, the other outside.
  const double angle = 2 * std::numbers::pi * 100.5 / n;
  PolygonSoup pierced = cone;
  pierced.points.conservativeResize(n + 3, 3);
  pierced.points.row(n + 1) << 0.2 * std::cos(angle), 0.2 * std::sin(angle), 0;
  pierced.points.row(n + 2) << 2 * std::cos(angle), 2 * std::sin(angle), 0.1;
  test::add_triangle(pierced, n, n + 1, n + 2);
  const auto flags = self_intersecting_faces(pierced.points, triangles_of(pierced));
  EXPECT_EQ(flags[100], 1);
  EXPECT_EQ(flags[n], 1);
  EXPECT_EQ(std::accumulate(flags.begin(), flags.end(), 0), 2);
}

}  // namespace
}  // namespace littoral
