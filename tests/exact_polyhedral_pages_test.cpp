// Where paths bend: at vertices with more than a full turn, and where triangles do not close up.

#include "methods/geodesic/exact_polyhedral_pages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "domain/mesh/surface_mesh.h"
#include "geodesic_helpers.h"
#include "littoral/report.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// n triangles around vertex 0, whose other corners lie on a circle around it, up and down by
/// turns.
PolygonSoup fan(int n, double up, double down, bool closed = true) {
  PolygonSoup soup;
  soup.points = MatX3::Zero(n + 1, 3);
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * k / n;
    soup.points.row(k + 1) = Vec3(std::cos(angle), std::sin(angle), k % 2 ? up : down);
  }
  for (int k = 0; k < n - (closed ? 0 : 1); ++k)
    test::add_triangle(soup, 0, 1 + k, 1 + (k + 1) % n);
  return soup;
}

PolyhedralPages::Bends bends_at_0(const PolygonSoup& soup) {
  Report report;
  const PolyhedralPages pages(intrinsic_triangulation(SurfaceMesh(soup), report));
  for (int v = 1; v < soup.n_vertices(); ++v)
    EXPECT_EQ(pages.bends[v], PolyhedralPages::anywhere) << "on the boundary";
  return static_cast<PolyhedralPages::Bends>(pages.bends[0]);
}

TEST(PolyhedralPages, PathsBendBehindSaddlesAndWhereTrianglesDoNotCloseUp) {
  for (const int n : {4, 6, 16, 18, 40}) {  // few triangles are looked at in another way than many
    EXPECT_EQ(bends_at_0(fan(n, 0, 0)), PolyhedralPages::never) << n;
    EXPECT_EQ(bends_at_0(fan(n, 0.3, 0.3)), PolyhedralPages::never) << n;
    EXPECT_EQ(bends_at_0(fan(n, 0.3, -0.3)), PolyhedralPages::behind) << n;
    EXPECT_EQ(bends_at_0(fan(n, 0, 0, false)), PolyhedralPages::anywhere) << n;
  }
}

TEST(PolyhedralPages, DistancesAroundASaddleOfAnyAngleAreExact) {
  for (int n = 6; n <= 40; n += 2)
    for (const double height : {0.1, 0.3, 0.6, 1.5}) {
      const SurfaceMesh mesh(fan(n, height, -height));
      const double r = std::hypot(1, height), side = (mesh.point(1) - mesh.point(2)).norm();
      const double angle = 2 * std::asin(side / (2 * r));  // of a triangle
      const VecX d = test::exact(mesh, test::vertex_points({1}));
      EXPECT_NEAR(d[0], r, 1e-14);
      for (int k = 0; k < n; ++k) {
        const double turned =
            std::min(k, n - k) * angle;  // half a turn and more: by way of vertex 0
        EXPECT_NEAR(d[k + 1], 2 * r * std::sin(std::min(turned, std::numbers::pi) / 2), 1e-12)
            << n << " triangles, " << n * angle / (2 * std::numbers::pi) << " turns, vertex " << k;
      }
    }
}

TEST(PolyhedralPages, TurnedTrianglesCloseUpToo) {
  for (const int n : {6, 18}) {
    PolygonSoup soup = fan(n, 0.1, 0.1);
    for (int f = 0; f < n; f += 3) std::swap(soup.corners[3 * f + 1], soup.corners[3 * f + 2]);
    EXPECT_EQ(bends_at_0(soup), PolyhedralPages::never) << n;
  }
}

TEST(PolyhedralPages, TwoConesThatTouchDoNotCloseUp) {
  for (const int n : {4, 7, 20}) {
    const PolygonSoup one = fan(n, 1, 1), other = fan(n, -1, -1);
    PolygonSoup both = one;
    both.points.conservativeResize(2 * n + 1, 3);
    both.points.bottomRows(n) = other.points.bottomRows(n);
    for (int f = 0; f < n; ++f)
      test::add_triangle(both, 0, n + other.face(f)[1], n + other.face(f)[2]);
    EXPECT_EQ(bends_at_0(both), PolyhedralPages::anywhere) << n;
  }
}

}  // namespace
}  // namespace littoral
