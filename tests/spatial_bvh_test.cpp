#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "base/parallel.h"
#include "brute_force.h"
#include "littoral/error.h"
#include "spatial/covered_triangles.h"
#include "spatial/grid_values.h"
#include "spatial/nearest_kernels.h"
#include "spatial/triangle_bvh.h"
#include "spatial/triangulate.h"
#include "test_meshes.h"

namespace littoral {
namespace {

struct Soup {
  MatX3 points{0, 3};
  MatX3i faces{0, 3};
};

enum class Arrangement { generic, needles, collinear, coincident, repeated, lattice };

Soup random_soup(std::mt19937& random, Arrangement kind, int n) {
  std::uniform_real_distribution<double> u(-1, 1);
  Soup soup;
  soup.points.resize(3 * n, 3);
  soup.faces.resize(n, 3);
  for (int f = 0; f < n; ++f) {
    const Vec3 a(u(random), u(random), u(random));
    Vec3 b = a + 0.2 * Vec3(u(random), u(random), u(random));
    Vec3 c = a + 0.2 * Vec3(u(random), u(random), u(random));
    if (kind == Arrangement::needles)
      c = 0.5 * (a + b) + std::pow(10.0, -8 - 8 * u(random)) * (c - a);
    if (kind == Arrangement::collinear) c = a + u(random) * (b - a);
    if (kind == Arrangement::coincident) b = c = a;
    soup.points.row(3 * f) = a;
    soup.points.row(3 * f + 1) = b;
    soup.points.row(3 * f + 2) = c;
    soup.faces.row(f) << 3 * f, 3 * f + 1, 3 * f + 2;
    if (kind == Arrangement::repeated) soup.faces(f, 1) = soup.faces(f, f % 2 ? 0 : 2);
  }
  if (kind == Arrangement::lattice)
    soup.points = (soup.points * 4).array().round() / 4;  // many ties
  return soup;
}

void expect_consistent(const Soup& soup, const NearestPoint& hit, const Vec3& query) {
  ASSERT_GE(hit.face, 0);
  double sum = 0;
  Vec3 point = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(hit.barycentric[k], 0);
    EXPECT_LE(hit.barycentric[k], 1);
    sum += hit.barycentric[k];
    point += hit.barycentric[k] * soup.points.row(soup.faces(hit.face, k)).transpose();
  }
  EXPECT_NEAR(sum, 1, 1e-15 * 4);
  const double size = std::max(soup.points.cwiseAbs().maxCoeff(), query.cwiseAbs().maxCoeff());
  EXPECT_LE((point - hit.point).norm(), 4e-16 * 4 * size);
  EXPECT_NEAR((hit.point - query).norm(), hit.distance, 1e-14 * size);
}

/// The lowest face among the nearest that others do not cover, each face asked on its own: the same
/// arithmetic, no pruning.
NearestPoint one_by_one(const Soup& soup, const Vec3& query) {
  std::vector<std::array<Vec3, 3>> corners(soup.faces.rows());
  for (int f = 0; f < soup.faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) corners[f][k] = soup.points.row(soup.faces(f, k));
  const std::vector<bool> covered = covered_triangles(corners);
  NearestPoint best;
  for (int f = 0; f < soup.faces.rows(); ++f) {
    if (covered[f]) continue;
    const MatX3i face = soup.faces.row(f);
    NearestPoint hit = TriangleBvh(soup.points, face).closest_point(query);
    hit.face = f;
    if (best.face < 0 || hit.distance < best.distance) best = hit;
  }
  return best;
}

TEST(SpatialBvh, AgreesWithBruteForceOnSoups) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1.5, 1.5);
  for (Arrangement kind : {Arrangement::generic, Arrangement::needles, Arrangement::collinear,
                           Arrangement::coincident, Arrangement::repeated, Arrangement::lattice}) {
    for (int n : {1, 2, 5, 60, 700}) {
      const Soup soup = random_soup(random, kind, n);
      const TriangleBvh bvh(soup.points, soup.faces);
      for (int i = 0; i < 60; ++i) {
        Vec3 query(u(random), u(random), u(random));
        if (i % 3 == 1) query = soup.points.row(static_cast<int>(random() % soup.points.rows()));
        if (i % 3 == 2 && kind == Arrangement::lattice) query = (query * 4).array().round() / 4;
        const NearestPoint hit = bvh.closest_point(query);
        expect_consistent(soup, hit, query);
        const NearestPoint oracle = closest_point_brute_force(soup.points, soup.faces, query);
        EXPECT_NEAR(hit.distance, oracle.distance, 1e-15 * 8);
      }
    }
  }
}

TEST(SpatialBvh, PruningNeverChangesTheWinner) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1.5, 1.5);
  for (Arrangement kind : {Arrangement::generic, Arrangement::lattice, Arrangement::coincident}) {
    const Soup soup = random_soup(random, kind, 150);
    const TriangleBvh bvh(soup.points, soup.faces);
    for (int i = 0; i < 80; ++i) {
      const Vec3 query = (Vec3(u(random), u(random), u(random)) * 4).array().round() / 4;
      const NearestPoint hit = bvh.closest_point(query), slow = one_by_one(soup, query);
      EXPECT_EQ(hit.face, slow.face);
      EXPECT_EQ(hit.distance, slow.distance);
      EXPECT_EQ(hit.barycentric, slow.barycentric);
      for (const int hint : {0, 77, 149, 150, 1000000}) {
        const NearestPoint hinted = bvh.closest_point(query, hint);
        EXPECT_EQ(hinted.face, slow.face);
        EXPECT_EQ(hinted.barycentric, slow.barycentric);
      }
    }
  }
}

TEST(SpatialBvh, BoundsOfEightTrianglesHold) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  for (Arrangement kind : {Arrangement::generic, Arrangement::needles, Arrangement::collinear,
                           Arrangement::coincident, Arrangement::repeated, Arrangement::lattice})
    for (int round = 0; round < 200; ++round) {
      Soup soup = random_soup(random, kind, nearest_lanes);
      soup.points /= 1.2;
      CornerLanes lanes;
      for (int l = 0; l < nearest_lanes; ++l)
        for (int k = 0; k < 9; ++k)
          lanes.corner[k][l] = static_cast<float>(soup.points(soup.faces(l, k / 3), k % 3));
      Vec3 query = std::pow(10, 1.5 * u(random) - 0.5) * Vec3(u(random), u(random), u(random));
      if (round % 4 == 0) query = soup.points.row(round % 24);
      const std::array<float, 3> from{float(query[0]), float(query[1]), float(query[2])};
      alignas(32) std::array<float, nearest_lanes> bound;
      float most = std::numeric_limits<float>::max();
      const unsigned met = nearest_kernels().bounds(lanes, from.data(), most, bound.data());
      double least = std::numeric_limits<double>::infinity(), gap = 0;
      for (int l = 0; l < nearest_lanes; ++l) {
        const double distance =
            closest_point_brute_force(soup.points, soup.faces.row(l), query).distance;
        least = std::min(least, distance);
        EXPECT_LE(std::sqrt(bound[l]), distance);
        EXPECT_EQ(met >> l & 1, bound[l] <= most ? 1u : 0u);
        gap = std::max(gap, distance - std::sqrt(bound[l]));
      }
      EXPECT_GE(std::sqrt(most), least);
      if (kind == Arrangement::generic || kind == Arrangement::coincident) {
        EXPECT_LE(gap, 1e-4 * (1 + query.norm()));
      }
    }
}

TEST(SpatialBvh, CandidatesAreThoseWithinSlackOfTheNearest) {
  // Triangles (0, 0, h), (1, 0, h), (0, 1, h), seen from above the inside, from beyond a side and
  // from beyond a corner: distances are known.
  const std::array<float, 4> height{0, 1, 1.001f, 3};
  std::array<NearTriangle<float>, 4> triangles;
  for (std::size_t i = 0; i < 4; ++i) {
    NearTriangle<float>& t = triangles[i];
    t.corner = {{{0, 0, height[i]}, {1, 0, height[i]}, {0, 1, height[i]}}};
    t.edge = {{{1, 0, 0}, {-1, 1, 0}, {0, -1, 0}}};
    t.per_length = {1, 0.5f, 1};
    t.normal = {0, 0, 1};
    t.inward = {{{0, 1, 0}, {-1, -1, 0}, {1, 0, 0}}};
    t.per_normal = 1;
  }
  std::array<char, 4> may_be{};
  std::array<RoughTriangle, 4> rough;
  for (std::size_t i = 0; i < 4; ++i) rough[i] = {&triangles[i], &may_be[i]};
  alignas(32) std::array<float, 4 * nearest_lanes> room;
  const auto candidates = [&](const std::array<std::array<float, 3>, nearest_lanes>& at,
                              float slack) {
    PlaceLanes places;
    for (std::size_t l = 0; l < nearest_lanes; ++l)
      places.x[l] = at[l][0], places.y[l] = at[l][1], places.z[l] = at[l][2];
    may_be.fill(1);
    nearest_kernels().candidates(rough.data(), 4, places, slack, room.data());
    return may_be;
  };
  using Flags = std::array<char, 4>;
  for (const std::array<float, 2>& side : {std::array<float, 2>{0.25f, 0.25f}, {2, 3}, {-3, -4}}) {
    std::array<std::array<float, 3>, nearest_lanes> at;
    at.fill({side[0], side[1], 0.25f});
    EXPECT_EQ(candidates(at, 1e-5f), (Flags{1, 0, 0, 0}));
    at[5][2] = 1.5f;  // one of eight sees others
    EXPECT_EQ(candidates(at, 1e-5f), (Flags{1, 0, 1, 0}));
    EXPECT_EQ(candidates(at, 2e-3f), (Flags{1, 1, 1, 0}));
    at.fill({side[0], side[1], 0.5f});  // equally far
    EXPECT_EQ(candidates(at, 1e-5f), (Flags{1, 1, 0, 0}));
  }
  std::array<std::array<float, 3>, nearest_lanes> at;
  at.fill({0.25f, 0.25f, 0.5f});
  candidates(at, 0);
  EXPECT_EQ(room[0], 0.25f);  // squared distance of the first
  at.fill({-3, -4, 12});
  candidates(at, 0);
  EXPECT_EQ(room[0], 169.0f);
}

/// Nodes about the soup, from three times its size down to a thousandth of it.
std::vector<Grid> grids_about_soups() {
  Grid wide, flat, close, far;
  wide.n = {37, 33, 9};
  wide.origin = {-1.5, -1.5, -1.5};
  wide.spacing = {0.08, 0.09, 0.37};
  flat.n = {70, 1, 2};
  flat.origin = {-3, 0.1, 0.2};
  flat.spacing = {0.09, 1, 0.01};
  close.n = {12, 11, 10};
  close.origin = {0.1, 0.2, 0.3};
  close.spacing.setConstant(1e-4);
  far.n = {3, 3, 3};
  far.origin = {5e3, 0, 0};
  far.spacing.setConstant(0.5);
  return {wide, flat, close, far};
}

void expect_distances_of_points(const MatX3& points, const MatX3i& faces, const Grid& grid,
                                double allowed) {
  const TriangleBvh bvh(points, faces);
  set_thread_count(1);
  const VecX one = bvh.distances(grid, Task());
  set_thread_count(3);
  const VecX three = bvh.distances(grid, Task());
  set_thread_count(0);
  EXPECT_TRUE(one == three);
  const VecX slow =
      grid_values(grid, Task(), [&](const Vec3& x, int&) { return bvh.closest_point(x).distance; });
  EXPECT_LE((one - slow).cwiseAbs().maxCoeff(), allowed);
  const VecX asked = bvh.values_at_nodes(
      grid,
      [&](const Vec3& x, const NearestPoint& foot) {
        Vec3 point = Vec3::Zero();
        for (int k = 0; k < 3; ++k) point += foot.barycentric[k] * points.row(faces(foot.face, k));
        EXPECT_LE((point - foot.point).norm(), 1e-14);
        EXPECT_NEAR((point - x).norm(), foot.distance, 1e-14 * (1 + foot.distance));
        return foot.distance;
      },
      Task());
  EXPECT_TRUE(asked == one);
}

TEST(SpatialBvh, DistancesAtNodesAreThoseOfTheirPoints) {
  std::mt19937 random(13);
  for (Arrangement kind : {Arrangement::generic, Arrangement::needles, Arrangement::collinear,
                           Arrangement::coincident, Arrangement::repeated, Arrangement::lattice})
    for (int n : {1, 7, 60, 700}) {
      const Soup soup = random_soup(random, kind, n);
      for (const Grid& grid : grids_about_soups())
        expect_distances_of_points(soup.points, soup.faces, grid, 1e-15 * 8 * grid.origin.norm());
    }
}

TEST(SpatialBvhSlow, DistancesAtNodesAreRightWhereManyFacesAreEquallyNear) {
  // About the middle of a sphere all its faces are, in the middle of a torus rings of them.
  for (const PolygonSoup& soup : {test::octasphere_soup(5), test::torus_soup(60, 30, 0.7, 0.3)})
    for (Grid grid : grids_about_soups()) {
      expect_distances_of_points(soup.points, triangles_of(triangulate(soup)), grid,
                                 1e-15 * 8 * grid.origin.norm());
      grid.origin =
          -grid.spacing.cwiseProduct(Vec3(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1)) / 2;
      expect_distances_of_points(soup.points, triangles_of(triangulate(soup)), grid, 1e-14);
    }
}

TEST(SpatialBvh, DistancesAtNodesStopWhenAsked) {
  CancelToken stop;
  stop.cancel();
  const PolygonSoup soup = test::octasphere_soup(3);
  EXPECT_THROW(TriangleBvh(soup.points, triangles_of(soup))
                   .distances(grids_about_soups().front(), Task(stop)),
               Cancelled);
}

TEST(SpatialBvh, PropertyDistanceMatchesOracleAtAnyScaleAndOffset) {
  EXPECT_TRUE(rc::check([] {
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    const Arrangement kind = static_cast<Arrangement>(*rc::gen::inRange(0, 6));
    Soup soup = random_soup(random, kind, *rc::gen::inRange(1, 40));
    const double scale = std::pow(10.0, *rc::gen::inRange(-30, 31));
    const double offset = *rc::gen::element(0.0, 1e7);
    soup.points = (soup.points.array() + offset) * scale;
    std::uniform_real_distribution<double> u(-2, 2);
    const Vec3 query = (Vec3(u(random), u(random), u(random)).array() + offset) * scale;
    const NearestPoint hit = TriangleBvh(soup.points, soup.faces).closest_point(query);
    const NearestPoint oracle = closest_point_brute_force(soup.points, soup.faces, query);
    RC_ASSERT(std::abs(hit.distance - oracle.distance) <= 1e-14 * scale);
    RC_ASSERT((hit.point - query).norm() <= hit.distance + 1e-15 * 8 * scale * (1 + offset));
  }));
}

TEST(SpatialBvh, LowestFaceAmongEquals) {
  const PolygonSoup sphere = test::octasphere_soup(2);
  const MatX3i faces = triangles_of(sphere);
  const TriangleBvh bvh(sphere.points, faces);
  for (int v = 0; v < sphere.n_vertices(); ++v) {  // out along a vertex: all its faces tie
    const Vec3 query = 3 * sphere.points.row(v).transpose();
    int lowest = -1;
    for (int f = static_cast<int>(faces.rows()) - 1; f >= 0; --f)
      for (int k = 0; k < 3; ++k)
        if (faces(f, k) == v) lowest = f;
    EXPECT_EQ(bvh.closest_point(query).face, lowest);
  }
  MatX3i twice(2 * faces.rows(), 3);  // every face once more
  twice << faces, faces;
  const TriangleBvh doubled(sphere.points, twice);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 50; ++i) {
    const Vec3 query = Vec3(u(random), u(random), u(random)) * 2;
    EXPECT_EQ(doubled.closest_point(query).face, bvh.closest_point(query).face);
  }
}

TEST(SpatialBvh, KnownAnswers) {
  MatX3 points(3, 3);
  points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  MatX3i face(1, 3);
  face << 0, 1, 2;
  const TriangleBvh bvh(points, face);
  const NearestPoint inside = bvh.closest_point({0.25, 0.25, 2});
  EXPECT_DOUBLE_EQ(inside.distance, 2);
  EXPECT_TRUE(inside.point.isApprox(Vec3(0.25, 0.25, 0), 1e-15));
  EXPECT_TRUE(bvh.closest_point({1, 1, 0}).point.isApprox(Vec3(0.5, 0.5, 0), 1e-15));
  EXPECT_EQ(bvh.closest_point({-3, -4, 0}).distance, 5);
  EXPECT_EQ(bvh.closest_point({-3, -4, 0}).barycentric, (std::array<double, 3>{1, 0, 0}));
}

TEST(SpatialBvh, ExtremeMagnitudes) {
  for (double scale : {1e-300, 1e-200, 1e-30, 1e30, 1e200, 1e300}) {
    const PolygonSoup sphere = test::octasphere_soup(2);
    const MatX3 points = sphere.points * scale;
    const TriangleBvh bvh(points, triangles_of(sphere));
    const NearestPoint hit = bvh.closest_point(Vec3(3, 0, 0) * scale);
    EXPECT_NEAR(hit.distance / scale, 2, 1e-14);
    EXPECT_NEAR(hit.point[0] / scale, 1, 1e-14);
    const NearestPoint far = bvh.closest_point({0, 1e308, 0});
    EXPECT_NEAR(far.distance / 1e308, scale < 1e300 ? 1 : 1 - 1e-8, 1e-7);
    EXPECT_TRUE(far.point.allFinite());
  }
}

TEST(SpatialBvh, BadInput) {
  MatX3 points(4, 3);
  points << 0, 0, 0, 1, 0, 0, 0, 1, 0, std::nan(""), 0, 0;
  MatX3i faces(2, 3);
  faces << 0, 1, 3, 0, 1, 2;
  const TriangleBvh bvh(points, faces);
  EXPECT_EQ(bvh.closest_point({0, 0, 1}).face, 1);
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_THROW(bvh.closest_point({inf, 0, 0}), InputError);
  EXPECT_THROW(bvh.closest_point({0, std::nan(""), 0}), InputError);
  EXPECT_THROW(TriangleBvh(MatX3(0, 3), MatX3i(0, 3)), InputError);
  EXPECT_THROW(TriangleBvh(points, MatX3i(faces.topRows(1))), InputError);
  faces(0, 2) = 4;
  EXPECT_THROW(TriangleBvh(points, faces), InputError);
  faces(0, 2) = -1;
  EXPECT_THROW(TriangleBvh(points, faces), InputError);
}

TEST(SpatialBvh, ManyCoincidentAndNestedTrianglesBuildFast) {
  // 60000 copies of one triangle (no split by position helps), then triangles halving in size
  // towards a corner (splits by area peel them one by one).
  const int copies = 60000, nested = 1000;
  MatX3 points(3 * (1 + nested), 3);
  MatX3i faces(copies + nested, 3);
  for (int i = 0; i <= nested; ++i) {
    const double s = std::pow(0.5, i);
    points.middleRows(3 * i, 3) << 0, 0, 0, s, 0, 0, 0, s, 0;
  }
  for (int f = 0; f < copies; ++f) faces.row(f) << 0, 1, 2;
  for (int i = 1; i <= nested; ++i) faces.row(copies + i - 1) << 3 * i, 3 * i + 1, 3 * i + 2;
  const TriangleBvh bvh(points, faces);
  const NearestPoint hit = bvh.closest_point({0.1, 0.2, 0.5});
  EXPECT_EQ(hit.face, 0);
  EXPECT_DOUBLE_EQ(hit.distance, 0.5);
  EXPECT_EQ(bvh.closest_point({-1, 0, 0}).face, 0);
}

}  // namespace
}  // namespace littoral
