// Nearest neighbours against looking at every point.

#include <algorithm>
#include <random>

#include "spatial/point_tree.h"

namespace littoral {
namespace {

std::vector<Neighbour> all_sorted(const MatX3& points, const Vec3& q) {
  std::vector<Neighbour> all;
  for (int i = 0; i < points.rows(); ++i) {
    const Vec3 d = points.row(i).transpose() - q;
    all.push_back({d[0] * d[0] + d[1] * d[1] + d[2] * d[2], i});
  }
  std::sort(all.begin(), all.end());
  return all;
}

MatX3 random_points(int n, unsigned seed, double snap) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  MatX3 points(n, 3);
  for (int i = 0; i < n; ++i)
    for (int d = 0; d < 3; ++d) {
      const double x = uniform(random);
      points(i, d) = snap > 0 ? snap * std::round(x / snap) : x;
    }
  return points;
}

void expect_same(const std::vector<Neighbour>& found, const std::vector<Neighbour>& expected,
                 std::size_t n) {
  ASSERT_EQ(found.size(), n);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_EQ(found[i].point, expected[i].point);
    EXPECT_EQ(found[i].squared_distance, expected[i].squared_distance);
  }
}

TEST(PointTree, TellsOfAllThatItFindsBeforeItReturnsThem) {
  const MatX3 points = random_points(3000, 11, 0.0);
  const PointTree tree(points);
  for (const Vec3& q : {Vec3(0, 0, 0), Vec3(0.3, -0.2, 0.9), Vec3(50, -3, 2)}) {
    std::vector<Neighbour> found(12), plain(12);
    std::vector<int> told;
    ASSERT_EQ(tree.nearest(q, 12, found.data(), [&](int point) { told.push_back(point); }), 12);
    tree.nearest(q, 12, plain.data());
    expect_same(found, plain, 12);
    for (const Neighbour& one : found)
      EXPECT_EQ(std::count(told.begin(), told.end(), one.point), 1) << one.point;
    EXPECT_LT(told.size(), 300u);
  }
}

TEST(PointTree, FindsTheSameAsLookingAtEveryPoint) {
  // Snapped coordinates give coincident points and ties, which the lower number wins.
  for (int n : {1, 2, 7, 8, 9, 64, 65, 500, 3000})
    for (double snap : {0.0, 0.25}) {
      const MatX3 points = random_points(n, 7 + n, snap);
      const PointTree tree(points);
      for (const Vec3& q :
           {Vec3(0, 0, 0), Vec3(0.3, -0.2, 0.9), Vec3(50, -3, 2), Vec3(0.25, 0.5, -0.25)}) {
        const auto expected = all_sorted(points, q);
        for (int k : {1, 5, 40}) {
          std::vector<Neighbour> found(static_cast<std::size_t>(k));
          found.resize(static_cast<std::size_t>(tree.nearest(q, k, found.data())));
          expect_same(found, expected, static_cast<std::size_t>(std::min(k, n)));
        }
        const double radius = 0.75;
        const auto inside = static_cast<std::size_t>(std::count_if(
            expected.begin(), expected.end(),
            [&](const Neighbour& a) { return a.squared_distance <= radius * radius; }));
        expect_same(tree.within(q, radius), expected, inside);
      }
    }
}

TEST(PointTree, AHundredThousandCoincidentPoints) {
  const MatX3 points = MatX3::Constant(100000, 3, 0.125);
  const PointTree tree(points);
  std::vector<Neighbour> found(3);
  ASSERT_EQ(tree.nearest(Vec3(1, 0.125, 0.125), 3, found.data()), 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(found[i].point, i);
    EXPECT_EQ(found[i].squared_distance, 0.875 * 0.875);
  }
}

TEST(PointTree, DisksKeepWhatIsNearOnSlantedPlanes) {
  // Points on a slanted plane, asked from far above: boxes hardly tell them apart.
  MatX3 points = random_points(5000, 3, 0);
  for (int i = 0; i < 5000; ++i) points(i, 2) = points(i, 0) + 0.5 * points(i, 1);
  const PointTree tree(points);
  for (const Vec3& q : {Vec3(-3, -1.5, 3), Vec3(-1e6, 0, 1e6), Vec3(0.1, 0.2, 0.2)}) {
    std::vector<Neighbour> found(12);
    tree.nearest(q, 12, found.data());
    expect_same(
        found,
        [&] {
          auto all = all_sorted(points, q);
          all.resize(12);
          return all;
        }(),
        12);
  }
}

TEST(PointTree, NumberedAnewItFindsTheSamePoints) {
  const MatX3 points = random_points(1000, 4, 0);
  const PointTree tree(points);
  PointTree again(points);
  const std::vector<int> old = again.renumber();
  std::vector<int> sorted = old;
  std::sort(sorted.begin(), sorted.end());
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(sorted[i], i);
  for (int i = 0; i < 50; ++i) {
    const Vec3 q = points.row(i) * 1.1;
    EXPECT_EQ(old[again.nearest(q).point], tree.nearest(q).point);
  }
}

}  // namespace
}  // namespace littoral
