// A face cut by points and segments is still that face, and holds them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "domain/mesh/cut_face.h"

namespace littoral {
namespace {

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

Vec2 at(const FaceTriangulation& face, int v) { return face.points()[std::size_t(v)]; }

double least_area(const FaceTriangulation& face) {
  double least = 1;
  for (const auto& [a, b, c] : face.triangles())
    least = std::min(least, turn(at(face, a), at(face, b), at(face, c)) / 2);
  return least;
}

double area(const FaceTriangulation& face) {
  double sum = 0;
  for (const auto& [a, b, c] : face.triangles())
    sum += turn(at(face, a), at(face, b), at(face, c)) / 2;
  return sum;
}

std::set<std::pair<int, int>> directed_sides(const FaceTriangulation& face) {
  std::set<std::pair<int, int>> sides;
  for (const auto& triangle : face.triangles())
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_TRUE(sides.emplace(triangle[k], triangle[(k + 1) % 3]).second) << "twice";
    }
  return sides;
}

FaceTriangulation right_triangle() { return {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}; }

TEST(FaceTriangulation, APointInsideMakesThreeTriangles) {
  FaceTriangulation face = right_triangle();
  EXPECT_EQ(face.insert({0.25, 0.25}, 1e-9), 3);
  ASSERT_EQ(face.triangles().size(), 3u);
  EXPECT_DOUBLE_EQ(least_area(face), 0.125);
  EXPECT_DOUBLE_EQ(area(face), 0.5);
}

TEST(FaceTriangulation, APointWithinToleranceOfAnotherIsThatOne) {
  FaceTriangulation face = right_triangle();
  EXPECT_EQ(face.insert({0.01, 0}, 0.02), 0);
  EXPECT_EQ(face.insert({0.99, 0}, 0.02), 1);
  EXPECT_EQ(face.insert({0, 1.01}, 0.02), 2);
  EXPECT_EQ(face.insert({0.3, 0.3}, 0.02), 3);
  EXPECT_EQ(face.insert({0.31, 0.3}, 0.02), 3);
  EXPECT_EQ(face.insert({0.33, 0.3}, 0.02), 4);
  EXPECT_EQ(face.points().size(), 5u);
}

TEST(FaceTriangulation, APointWithinToleranceOfASideIsPutOnIt) {
  for (const double height : {0.01, -0.01}) {
    FaceTriangulation face = right_triangle();
    EXPECT_EQ(face.insert({0.5, height}, 0.02), 3);
    ASSERT_EQ(face.triangles().size(), 2u) << height;
    const auto sides = directed_sides(face);
    EXPECT_TRUE(sides.count({0, 3}) && sides.count({3, 1}) && sides.count({3, 2}));
  }
  FaceTriangulation face = right_triangle();
  face.insert({0.5, 0.03}, 0.02);
  EXPECT_EQ(face.triangles().size(), 3u);
}

TEST(FaceTriangulation, ToleranceIsALengthInFacesOfAnySize) {
  for (const double size : {0.01, 1.0, 100.0}) {
    FaceTriangulation face(Vec2(0, 0), Vec2(size, 0), Vec2(0, size));
    face.insert({0.5 * size, 0.01 * size}, 0.02 * size);
    EXPECT_EQ(face.triangles().size(), 2u) << size;
    FaceTriangulation finer(Vec2(0, 0), Vec2(size, 0), Vec2(0, size));
    finer.insert({0.5 * size, 0.01 * size}, 0.005 * size);
    EXPECT_EQ(finer.triangles().size(), 3u) << size;
  }
}

TEST(FaceTriangulation, ToleranceIsALengthWhereverTheFaceLies) {
  for (const Vec2& at : {Vec2(0, 0), Vec2(40, 0), Vec2(-30, 50), Vec2(-0.5, -0.01)}) {
    const Vec2 a = at + Vec2(0, 0), b = at + Vec2(1, 0), c = at + Vec2(0, 1);
    FaceTriangulation above(a, b, c);
    above.insert(at + Vec2(0.5, 0.03), 0.02);
    EXPECT_EQ(above.triangles().size(), 3u) << at.transpose();
    FaceTriangulation on(a, b, c);
    on.insert(at + Vec2(0.5, 0.01), 0.02);
    EXPECT_EQ(on.triangles().size(), 2u) << at.transpose();
  }
}

TEST(FaceTriangulation, APointNearTwoSidesIsPutOnTheNearerOne) {
  // Far from the origin, and with sides of very different length.
  const Vec2 at(7, -9);
  FaceTriangulation face(at, at + Vec2(10, 0), at + Vec2(0, 1));
  const int added = face.insert(at + Vec2(0.02, 0.5), 0.03);
  ASSERT_EQ(face.triangles().size(), 2u);
  const auto sides = directed_sides(face);
  EXPECT_TRUE(sides.count({2, added}) && sides.count({added, 0}));
  FaceTriangulation other(at, at + Vec2(10, 0), at + Vec2(0, 1));
  const int below = other.insert(at + Vec2(0.04, 0.02), 0.03);
  ASSERT_EQ(other.triangles().size(), 2u);
  const auto split = directed_sides(other);
  EXPECT_TRUE(split.count({0, below}) && split.count({below, 1}));
}

TEST(FaceTriangulation, APointInsideMakesThreeTrianglesOfOneInAnyPlace) {
  // The triangle that holds a point is the one in which it lies, not the one beside it.
  for (const Vec2& at : {Vec2(0, 0), Vec2(25, -3)}) {
    FaceTriangulation face(at, at + Vec2(1, 0), at + Vec2(0, 1));
    ASSERT_EQ(face.insert(at + Vec2(0.1, 0.1), 1e-9), 3);
    face.insert(at + Vec2(0.5, 0.1), 1e-9);
    face.insert(at + Vec2(0.1, 0.5), 1e-9);
    face.insert(at + Vec2(0.4, 0.4), 1e-9);
    EXPECT_EQ(face.triangles().size(), 9u);
    EXPECT_GT(least_area(face), 1e-3);
    EXPECT_NEAR(area(face), 0.5, 1e-14);
  }
}

TEST(FaceTriangulation, APointOnAnInnerEdgeMakesFourTrianglesOfTwo) {
  FaceTriangulation face = right_triangle();
  face.split_side(0, 1, {0.5, 0});
  EXPECT_EQ(face.insert({0.25, 0.5}, 1e-9), 4);
  EXPECT_EQ(face.triangles().size(), 4u);
  EXPECT_DOUBLE_EQ(area(face), 0.5);
  EXPECT_DOUBLE_EQ(least_area(face), 0.125);
}

TEST(FaceTriangulation, AnEdgeThatIsThereIsThePath) {
  FaceTriangulation face = right_triangle();
  face.connect(2, 1, 0);
  EXPECT_EQ(face.path(0), (std::vector<int>{2, 1}));
  EXPECT_EQ(face.triangles().size(), 1u);
}

TEST(FaceTriangulation, APathPassesThePointsOnItsWay) {
  FaceTriangulation face = right_triangle();
  const int a = face.split_side(0, 1, {0.5, 0});
  const int b = face.insert({0.25, 0.25}, 1e-9);
  const int c = face.split_side(2, 0, {0, 0.5});
  face.connect(a, c, 1);
  EXPECT_EQ(face.path(1), (std::vector<int>{a, b, c}));
}

TEST(FaceTriangulation, ASecondSegmentCutsTheFirstWhereTheyCross) {
  FaceTriangulation face = right_triangle();
  const int a = face.split_side(0, 1, {0.25, 0}), b = face.split_side(1, 2, {0.25, 0.75});
  const int c = face.split_side(2, 0, {0, 0.25}), d = face.split_side(1, b, {0.75, 0.25});
  face.connect(a, b, 0);
  face.connect(c, d, 1);
  ASSERT_EQ(face.path(0).size(), 3u);
  ASSERT_EQ(face.path(1).size(), 3u);
  const int x = face.path(0)[1];
  EXPECT_EQ(face.path(0), (std::vector<int>{a, x, b}));
  EXPECT_EQ(face.path(1), (std::vector<int>{c, x, d}));
  EXPECT_NEAR((at(face, x) - Vec2(0.25, 0.25)).norm(), 0, 1e-15);
  EXPECT_NEAR(area(face), 0.5, 1e-15);
}

TEST(FaceTriangulation, APointInsertedOnAPathBelongsToIt) {
  FaceTriangulation face = right_triangle();
  const int a = face.split_side(0, 1, {0.5, 0});
  face.connect(a, 2, 0);
  const int b = face.insert({0.25, 0.5}, 1e-9), c = face.insert({0.375, 0.25}, 1e-9);
  EXPECT_EQ(face.path(0), (std::vector<int>{a, c, b, 2}));
}

TEST(FaceTriangulation, EdgesThatAreInNoPathAreFlippedNotCut) {
  FaceTriangulation face = right_triangle();  // a fan of edges from point 3 lies across
  face.insert({0.1, 0.8}, 1e-9);
  const int a = face.insert({0.1, 0.1}, 1e-9), b = face.insert({0.8, 0.1}, 1e-9);
  face.connect(a, b, 0);
  EXPECT_EQ(face.path(0), (std::vector<int>{a, b}));
  EXPECT_EQ(face.points().size(), 6u);
}

/// Random points and segments: what is left is a triangulation of the face along all of them.
TEST(FaceTriangulation, RandomSegmentsAreChainsOfEdges) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> some(0, 1);
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    FaceTriangulation face = right_triangle();
    for (int i = 0; i < 8; ++i) {
      double x = some(random), y = some(random);
      if (x + y > 1) x = 1 - x, y = 1 - y;
      face.insert({x, y}, 1e-6);
    }
    const int n = static_cast<int>(face.points().size());
    std::vector<std::pair<int, int>> ends;
    for (int s = 0; s < 6; ++s) {
      const int a = static_cast<int>(random() % unsigned(n)), b = (a + 1 + s) % n;
      ends.emplace_back(a, b);
      face.connect(a, b, s);
    }
    EXPECT_GT(least_area(face), -1e-15);
    EXPECT_NEAR(area(face), 0.5, 1e-12);
    const auto sides = directed_sides(face);
    for (int s = 0; s < 6; ++s) {
      const std::vector<int>& path = face.path(s);
      ASSERT_GE(path.size(), 2u);
      EXPECT_EQ(std::pair(path.front(), path.back()), ends[std::size_t(s)]);
      double length = 0;
      for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        EXPECT_TRUE(sides.count({path[i], path[i + 1]}) || sides.count({path[i + 1], path[i]}));
        length += (at(face, path[i + 1]) - at(face, path[i])).norm();
      }
      EXPECT_NEAR(length, (at(face, path.back()) - at(face, path.front())).norm(), 1e-12);
    }
    // By Euler: three points are on the rim and all others inside, or on sides.
    std::size_t rim = 0;
    for (const auto& [a, b] : sides) rim += sides.count({b, a}) == 0;
    EXPECT_EQ(face.triangles().size(), 2 * face.points().size() - 2 - rim);
  }
}

}  // namespace
}  // namespace littoral
