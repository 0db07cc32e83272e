// Winding numbers by crossings of a ray and boundary angles, against sums of solid angles.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "brute_force.h"
#include "space_helpers.h"
#include "spatial/triangulate.h"
#include "spatial/winding_number.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// Every query that is not on a face gets the sum of all solid angles; returns how many were asked.
int expect_sums(const MatX3& points, const MatX3i& faces, const MatX3& queries,
                double tolerance = 1e-12) {
  const WindingNumber winding(points, faces);
  EXPECT_TRUE(winding.exact());
  const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
  int asked = 0;
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const Vec3 q = queries.row(i);
    if (closest_point_brute_force(points, faces, q).distance < 1e-12 * size) continue;
    EXPECT_NEAR(winding(q), winding_number_brute_force(points, faces, q), tolerance)
        << "query " << i << ": " << q.transpose();
    ++asked;
  }
  return asked;
}

/// Faces between random corners: nonmanifold, oriented anyhow, through each other.
MatX3i random_faces(int n, int corners, unsigned seed) {
  std::mt19937 random(seed);
  MatX3i faces(n, 3);
  for (int& v : faces.reshaped()) v = static_cast<int>(random() % unsigned(corners));
  return faces;
}

TEST(CrossingNumber, IsAnIntegerAroundClosedSurfaces) {
  const PolygonSoup torus = test::torus_soup(40, 20);
  const MatX3i faces = triangles_of(torus);
  const WindingNumber winding(torus.points, faces);
  const MatX3 queries = test::random_points(300, 1.6);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const double w = winding(queries.row(i));
    EXPECT_TRUE(w == 0 || w == 1) << w;
  }
  expect_sums(torus.points, faces, queries);
}

TEST(CrossingNumber, IsTheSumOfSolidAnglesOfSoups) {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    const MatX3 points = test::random_points(40, 1, seed);
    expect_sums(points, random_faces(300, 40, seed), test::random_points(60, 1.4, seed + 10));
  }
  const PolygonSoup open = test::octasphere_soup(3);
  expect_sums(open.points, triangles_of(open).topRows(400), test::random_points(200, 1.4));
}

// Corners and queries on one lattice: rays pass through corners and along edges and faces, also
// those of the boundary.
TEST(CrossingNumber, CountsSeamsOnce) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const MatX3 points = (2 * test::random_points(60, 1, seed)).array().round() / 2;
    const MatX3 queries = (2 * test::random_points(150, 1.2, seed + 9)).array().round() / 2;
    EXPECT_GT(expect_sums(points, random_faces(12, 60, seed), queries), 30);
  }
  const PolygonSoup sphere = test::octasphere_soup(2);
  const MatX3i faces = triangles_of(sphere);
  for (const int n : {static_cast<int>(faces.rows()), 90})
    for (const double r : {0.0, 0.5, 0.9, 1.5}) {
      MatX3 queries = r * sphere.points;
      // On the rays along each axis through a corner.
      for (int v = 0; v < sphere.n_vertices(); ++v)
        queries(v, v % 3) = sphere.points(v, v % 3) - 0.3,
                       queries(v, (v + 1) % 3) = sphere.points(v, (v + 1) % 3),
                       queries(v, (v + 2) % 3) = sphere.points(v, (v + 2) % 3);
      expect_sums(sphere.points, faces.topRows(n), queries);
    }
}

// A side of an edge that rounding gets wrong must be wrong for both faces and for the boundary.
TEST(CrossingNumber, GrazingRaysAgreeWithTheBoundary) {
  const MatX3 points = test::random_points(30, 1, 5);
  const MatX3i faces = random_faces(40, 30, 6);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(0, 1);
  MatX3 queries(900, 3);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const Eigen::Index f = i % faces.rows();
    const double t = i % 5 == 0 ? 0 : u(random);
    queries.row(i) = (1 - t) * points.row(faces(f, 0)) + t * points.row(faces(f, 1));
    queries(i, i % 3) -= u(random) + 0.1;
    queries(i, (i + 1) % 3) += 1e-16 * std::round(4 * (u(random) - 0.5));
  }
  expect_sums(points, faces, queries);
}

TEST(CrossingNumber, BesideFacesAtAnyPlaceAndScale) {
  const PolygonSoup sphere = test::octasphere_soup(3);
  const MatX3i faces = triangles_of(sphere);
  for (const double scale : {1e-250, 1.0, 1e150})
    for (const double offset : {0.0, 1e6}) {
      const MatX3 points = scale * (sphere.points.array() + offset);
      const WindingNumber winding(points, faces);
      for (int f = 0; f < 100; ++f) {
        const Vec3 a = sphere.points.row(faces(f, 0)), b = sphere.points.row(faces(f, 1)),
                   c = sphere.points.row(faces(f, 2));
        const Vec3 middle = (a + b + c) / 3, n = middle.normalized();
        for (const double side : {-1.0, 1.0}) {
          const Vec3 x = middle + side * (offset > 0 ? 1e-7 : 1e-13) * n;
          EXPECT_EQ(winding(scale * (x.array() + offset)), side < 0 ? 1 : 0);
        }
      }
    }
}

// Triangles with one centre: their size is that of their corners.
TEST(CrossingNumber, OfOneTriangleOfAnySize) {
  for (const double scale : {1e-150, 1.0, 1e150}) {
    MatX3 points(3, 3);
    points << 1, 0, 0, 0, 1, 0, 0, 0, 1;  // an eighth of the sphere around the origin
    points *= scale;
    const MatX3i face = Eigen::RowVector3i(0, 1, 2);
    EXPECT_NEAR(WindingNumber(points, face)(Vec3::Zero()), 0.125, 1e-14) << scale;
  }
}

TEST(CrossingNumber, ALongBoundaryIsSummedOverClusters) {
  PolygonSoup sphere = test::octasphere_soup(5);
  MatX3i faces = triangles_of(sphere);
  for (Eigen::Index f = 0; f < faces.rows(); f += 2) std::swap(faces(f, 0), faces(f, 1));
  EXPECT_FALSE(WindingNumber(sphere.points, faces).exact());
}

TEST(CrossingNumber, OnTheSurfaceItIsBetweenTheSides) {
  const PolygonSoup sphere = test::octasphere_soup(2);
  const MatX3i faces = triangles_of(sphere);
  for (const int n : {static_cast<int>(faces.rows()), 90}) {
    const WindingNumber winding(sphere.points, faces.topRows(n));
    for (int v = 0; v < sphere.n_vertices(); ++v) {
      const double w = winding(sphere.points.row(v));
      EXPECT_GE(w, n < faces.rows() ? -0.5 : 0);
      EXPECT_LE(w, 1);
    }
  }
}

}  // namespace
}  // namespace littoral
