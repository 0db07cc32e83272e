// Which triangles lines meet, beside all triangles one by one.

#include "methods/implicit/place_tree.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>
#include <utility>
#include <vector>

namespace littoral {
namespace {

/// Bits for an odd number of faces but its own on either side of each place, one by one.
std::vector<unsigned char> parities_one_by_one(const std::vector<Place>& places,
                                               const MatX3& points, const MatX3i& faces,
                                               const Vec3& direction) {
  std::vector<unsigned char> out;
  for (const Place& place : places) {
    unsigned char bits = 0;
    for (int f = 0; f < faces.rows(); ++f) {
      if (f == place.face) continue;
      Eigen::Matrix3d sides;
      const Vec3 a = points.row(faces(f, 0)), b = points.row(faces(f, 1)),
                 c = points.row(faces(f, 2));
      sides << b - a, c - a, -direction;
      const Vec3 s = sides.inverse() * (place.x - a);
      if (s[0] < 0 || s[1] < 0 || s[0] + s[1] > 1) continue;
      bits ^= s[2] < 0 ? odd_before : odd_after;
    }
    out.push_back(bits);
  }
  return out;
}

TEST(PlaceTree, FindsWhatLinesPassInCrowdsAndOutsideThem) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  for (const auto& [n, size] :
       {std::pair(300, 1.0), {301, 0.05}, {302, 1e-7}, {3, 1.0}, {1, 0.1}}) {
    MatX3 points(3 * n, 3);
    MatX3i faces(n, 3);
    std::vector<Place> places;
    for (int f = 0; f < n; ++f) {
      const bool in_crowd = f % 3 != 0;
      for (int k = 0; k < 3; ++k) {
        faces(f, k) = 3 * f + k;
        points.row(3 * f + k) = in_crowd ? Vec3(Vec3(0.3, 0.2, 0.1) + size * any()) : any();
      }
      const Vec3 w = any().cwiseAbs() + Vec3::Constant(0.1);
      places.push_back({f, points.middleRows(3 * f, 3).transpose() * w / w.sum()});
    }
    for (int i = 0; i < 100; ++i) places.push_back({-1, any()});
    const PlaceTree tree(places);
    for (int d = 0; d < 3; ++d) {
      const Vec3 direction = any().normalized();
      EXPECT_EQ(tree.parities(points, faces, direction, Task()),
                parities_one_by_one(places, points, faces, direction));
    }
  }
  EXPECT_TRUE(PlaceTree({}).parities(MatX3(0, 3), MatX3i(0, 3), {0, 0, 1}, Task()).empty());
}

TEST(PlaceTree, LinesThroughSidesAndCornersMeetOneTriangle) {
  // A square of triangles around its middle, and lines on its sides, diagonals and the middle.
  const int n = 8;
  MatX3 points(n + 1, 3);
  MatX3i faces(n, 3);
  const double x[n] = {1, 1, 0, -1, -1, -1, 0, 1}, y[n] = {0, 1, 1, 1, 0, -1, -1, -1};
  points.row(n) = Vec3(0, 0, 1);
  for (int k = 0; k < n; ++k) {
    points.row(k) = Vec3(x[k], y[k], 1);
    faces.row(k) << k, (k + 1) % n, n;
  }
  std::vector<Place> below;
  for (int i = -3; i < 4; ++i)
    for (int j = -3; j < 4; ++j) below.push_back({-1, Vec3(i / 4.0, j / 4.0, 0)});
  const PlaceTree tree(below);
  for (const int turned : {0, 1}) {
    for (const unsigned char bits : tree.parities(points, faces, Vec3(0, 0, 1), Task()))
      EXPECT_EQ(bits, odd_after) << turned;
    for (const unsigned char bits : tree.parities(points, faces, Vec3(0, 0, -1), Task()))
      EXPECT_EQ(bits, odd_before) << turned;
    faces.col(1).swap(faces.col(2));
  }
}

}  // namespace
}  // namespace littoral
