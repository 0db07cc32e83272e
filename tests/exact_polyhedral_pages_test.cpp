// What meets at an edge; where paths bend: at vertices with more than a full turn, and where
// triangles do not close up.

#include "methods/geodesic/exact_polyhedral_pages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "domain/mesh/surface_mesh.h"
#include "geodesic_helpers.h"
#include "littoral/report.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using ::testing::ElementsAreArray;

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

/// n triangles on a common edge, from vertex 0 to 1, every other one turned.
PolygonSoup triangles_on_an_edge(int n) {
  PolygonSoup soup;
  soup.points = MatX3::Zero(n + 2, 3);
  soup.points(1, 2) = 1;
  for (int k = 0; k < n; ++k) {
    soup.points.row(k + 2) = Vec3(std::cos(k), std::sin(k), 0.3);
    test::add_triangle(soup, k % 2, 1 - k % 2, k + 2);
  }
  return soup;
}

TEST(PolyhedralPages, SidesAtAnEdgeAreThoseOfItsTriangles) {
  for (const int n : {1, 2, 3, 4, 9}) {
    Report report;
    const IntrinsicTriangulation T =
        intrinsic_triangulation(SurfaceMesh(triangles_on_an_edge(n)), report);
    const PolyhedralPages pages(T);
    for (int e = 0; e < T.n_edges(); ++e) {
      std::vector<int> sides;
      for (int side = 0; side < 3 * T.n_faces(); ++side)
        if (T.side_edge(side / 3, side % 3) == e) sides.push_back(side);
      ASSERT_THAT(pages.at(e), ElementsAreArray(sides)) << n;
      const PolyhedralPages::Edge& edge = pages.edges[e];
      EXPECT_EQ(edge.n_pages(), sides.size());
      for (std::size_t page = 0; page < sides.size(); ++page) {
        EXPECT_EQ(pages.page_of(edge, sides[page]), page);
        EXPECT_EQ(pages.leads_on(edge, sides[page]), sides.size() > 1);
      }
    }
    for (int f = 0; f < T.n_faces(); ++f)
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(pages.triangles[f].length[k], T.length(f, k));
        EXPECT_EQ(pages.triangles[f].vertex[k], T.faces(f, k));
        EXPECT_EQ(pages.triangles[f].edge[k], T.side_edge(f, k));
        EXPECT_EQ(pages.triangles[f].along[k], T.along(f, k));
      }
  }
}

TEST(PolyhedralPages, OfTrianglesWithTheSameEdgesOnlyTheFirstIsEntered) {
  PolygonSoup soup = triangles_on_an_edge(2);
  test::add_triangle(soup, 1, 0, 2);  // as the first
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(SurfaceMesh(soup), report);
  const PolyhedralPages pages(T);
  for (int k = 0; k < 3; ++k) {
    const PolyhedralPages::Edge& edge = pages.edges[T.side_edge(2, k)];
    EXPECT_EQ(pages.page_of(edge, 6 + k), Window::no_page);
    EXPECT_TRUE(pages.leads_on(edge, 6 + k));
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
