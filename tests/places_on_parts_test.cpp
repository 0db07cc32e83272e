// Places on the parts of a surface: how many, where, and how evenly.

#include "methods/implicit/places_on_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace littoral {
namespace {

struct Surface {
  MatX3 points;
  MatX3i faces;
  VecX areas;
};

/// Right triangles beside one another, of legs 1 and of these lengths.
Surface right_triangles(const std::vector<double>& legs) {
  const auto n = static_cast<Eigen::Index>(legs.size());
  Surface out{MatX3(3 * n, 3), MatX3i(n, 3), VecX(n)};
  for (Eigen::Index f = 0; f < n; ++f) {
    const double x = 2 * double(f), leg = legs[std::size_t(f)];
    out.points.middleRows(3 * f, 3) << x, 0, 0, x + 1, 0, 0, x, leg, 0;
    out.faces.row(f) << 3 * int(f), 3 * int(f) + 1, 3 * int(f) + 2;
    out.areas[f] = leg / 2;
  }
  return out;
}

std::vector<Place> places_on(const Surface& s, const std::vector<int>& part) {
  return places_on_parts(s.points, s.faces, s.areas, part);
}

std::vector<int> counts(const std::vector<Place>& places, std::size_t n_faces) {
  std::vector<int> out(n_faces, 0);
  for (const Place& place : places) ++out[std::size_t(place.face)];
  return out;
}

TEST(PlacesOnParts, AreAsManyAsTheirShareOfTheArea) {
  const Surface s = right_triangles({1, 1, 2});  // parts of 1/4, 1/4 and 1/2 of the area
  EXPECT_EQ(counts(places_on(s, {0, 1, 2}), 3), (std::vector<int>{1024, 1024, 2048}));
}

TEST(PlacesOnParts, AreFourOnTheSmallestPartAndNoneOnOneWithoutArea) {
  const Surface s = right_triangles({1, 1e-5, 0, 1});
  EXPECT_EQ(counts(places_on(s, {0, 1, 2, 3}), 4), (std::vector<int>{2048, 4, 0, 2048}));
}

TEST(PlacesOnParts, AreOnAllFacesOfAPartByTheirArea) {
  const Surface s = right_triangles({4, 1, 2, 1});
  const std::vector<int> n = counts(places_on(s, {0, 0, 0, 0}), 4);
  EXPECT_EQ(n, (std::vector<int>{2048, 512, 1024, 512}));
  // Parts whose faces are not one after the other.
  const std::vector<int> mixed = counts(places_on(s, {0, 1, 1, 0}), 4);
  EXPECT_EQ(mixed, (std::vector<int>{2048, 512, 1024, 512}));
}

TEST(PlacesOnParts, FacesOfFewPlacesAreHitByTheMiddlesOfEvenSteps) {
  // Four places at 1/8, 3/8, 5/8 and 7/8 of the area of the small part.
  const Surface s = right_triangles({1, 2e-6, 1e-6, 1e-6});
  EXPECT_EQ(counts(places_on(s, {0, 1, 1, 1}), 4), (std::vector<int>{4096, 2, 1, 1}));
}

TEST(PlacesOnParts, LieInTheirFacesEvenlySpread) {
  const Surface s = right_triangles({1, 3});
  const std::vector<Place> places = places_on(s, {0, 1});
  for (int f = 0; f < 2; ++f) {
    const double leg = f == 0 ? 1 : 3;
    std::vector<int> cells(16, 0);  // squares of side 1/4
    double n = 0;
    Vec2 sum(0, 0);
    for (const Place& place : places) {
      if (place.face != f) continue;
      const double u = place.x[0] - 2 * f, v = place.x[1] / leg;
      EXPECT_GE(u, 0);
      EXPECT_GE(v, 0);
      EXPECT_LE(u + v, 1 + 1e-12);
      EXPECT_EQ(place.x[2], 0);
      ++cells[std::size_t(std::min(3, int(4 * u)) + 4 * std::min(3, int(4 * v)))];
      ++n;
      sum += Vec2(u, v);
    }
    EXPECT_LT((sum / n - Vec2(1, 1) / 3).norm(), 5e-3);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        const double share = i + j < 3 ? 2. / 16 : i + j == 3 ? 1. / 16 : 0;
        EXPECT_NEAR(cells[i + 4 * j] / n, share, 0.01) << i << " " << j;
      }
  }
}

}  // namespace
}  // namespace littoral
