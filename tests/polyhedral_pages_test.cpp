// Where shortest paths bend: at vertices with few and with many triangles around them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/geodesic/exact_polyhedral_pages.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// Triangles from vertex 0 to n vertices around it that are in turn this high and this low, in any
/// order and sense; the last one is left out if it is open.
void add_cone(PolygonSoup& soup, int n, double high, double low, bool open = false) {
  const int first = std::max(1, soup.n_vertices());
  soup.points.conservativeResize(first + n, 3);
  soup.points.row(0).setZero();
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    soup.points.row(first + i) << std::cos(a), std::sin(a), i % 2 == 0 ? high : low;
  }
  std::vector<int> order(std::size_t(open ? n - 1 : n));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::mt19937 random(static_cast<unsigned>(n));
  std::shuffle(order.begin(), order.end(), random);
  for (const int i : order) {
    std::array<int, 3> face{0, first + i, first + (i + 1) % n};
    std::shuffle(face.begin(), face.end(), random);
    soup.add_face(face);
  }
}

int bends_at_zero(const PolygonSoup& soup) {
  Report report;
  return PolyhedralPages(intrinsic_triangulation(SurfaceMesh(soup), report)).bends[0];
}

TEST(PolyhedralPages, PathsBendBehindSaddlesOnly) {
  for (const int n : {4, 6, 8, 14, 16, 18, 20, 40}) {
    PolygonSoup cone, flat, saddle, open;
    add_cone(cone, n, 0.5, 0.5);
    add_cone(flat, n, 0, 0);
    add_cone(saddle, n, 1, -1);
    add_cone(open, n, 0.5, 0.5, true);
    EXPECT_EQ(bends_at_zero(cone), PolyhedralPages::never) << n;
    EXPECT_EQ(bends_at_zero(flat), PolyhedralPages::never) << n;
    EXPECT_EQ(bends_at_zero(saddle), PolyhedralPages::behind) << n;
    EXPECT_EQ(bends_at_zero(open), PolyhedralPages::anywhere) << n;
  }
}

TEST(PolyhedralPages, PathsBendWhereTwoConesTouch) {
  for (const int n : {3, 8, 9, 20}) {
    PolygonSoup both;
    add_cone(both, n, 0.5, 0.5);
    add_cone(both, n, -0.5, -0.5);
    EXPECT_EQ(bends_at_zero(both), PolyhedralPages::anywhere) << n;
  }
}

}  // namespace
}  // namespace littoral
