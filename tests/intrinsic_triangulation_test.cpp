// Frames of triangles and edges: where more than two triangles meet, and one-sided curves there.
#include "domain/intrinsic/intrinsic_triangulation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "domain/mesh/polygon_surface.h"
#include "heat_helpers.h"
#include "sources/systems/triangle_source_system.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(IntrinsicTriangulation, TrianglesThatLeaveAnEdgeInTheFirstsDirectionLieOnItsSide) {
  // Tips far along the edge: what counts is how they leave it, not where their tips are.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  int same = 0, opposite = 0;
  for (int round = 0; round < 60; ++round) {
    const int pages = 3 + round % 3;
    PolygonSoup soup;
    soup.points.resize(2 + pages, 3);
    soup.points.row(0) << 0, 0, 0;
    soup.points.row(1) << 0, 0, 1;
    std::vector<double> angle;
    for (int p = 0; p < pages; ++p) {
      angle.push_back(4 * u(random));
      soup.points.row(2 + p) << 0.4 * std::cos(angle[p]), 0.4 * std::sin(angle[p]), 6 * u(random);
      std::array<int, 3> corners{0, 1, 2 + p};
      if (random() % 2) std::swap(corners[0], corners[1]);
      std::rotate(corners.begin(), corners.begin() + random() % 3, corners.end());
      soup.add_face(corners);
    }
    Report report;
    const SurfaceMesh mesh(soup);
    const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
    const auto left = [&](int f) {  // of the edge as its frame has it
      for (int k = 0; k < 3; ++k)
        if (T.edges(T.side_edge(f, k), 0) + T.edges(T.side_edge(f, k), 1) == 1)
          return std::array{k, T.orientation[f] * T.along(f, k)};
      return std::array{-1, 0};
    };
    for (int p = 1; p < pages; ++p) {
      const double across = std::cos(angle[p] - angle[0]);
      if (std::abs(across) < 1e-3) continue;
      const auto [k, side] = left(p);
      const bool fits = side == (across > 0 ? 1 : -1) * left(0)[1];
      EXPECT_EQ(T.seam(p, k) != 0, !fits) << round << ", " << p;
      ++(across > 0 ? same : opposite);
    }
    EXPECT_EQ(T.seam(0, left(0)[0]), 0);
  }
  EXPECT_GT(same, 30);
  EXPECT_GT(opposite, 30);
}

TEST(PolygonSurface, PolygonsOfManyCornersAreOnePatchForEachOfTheirTriangles) {
  PolygonSoup soup;  // a square beside one whose sides have many corners
  const int n = 20;
  soup.points.resize(4 * n + 2, 3);
  std::vector<int> all;
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < n; ++i) {
      const double t = double(i) / n;
      const double x[4] = {t, 1, 1 - t, 0}, y[4] = {0, t, 1, 1 - t};
      soup.points.row(side * n + i) << x[side], y[side], 0;
      all.push_back(side * n + i);
    }
  soup.points.row(4 * n) << 2, 0, 0;
  soup.points.row(4 * n + 1) << 2, 1, 0;
  std::vector<int> beside{4 * n, 4 * n + 1, 2 * n};
  for (int i = n - 1; i >= 0; --i) beside.push_back(n + i);
  soup.add_face(all);
  soup.add_face(beside);
  Report report;
  const NodalSurface S = polygon_surface(SurfaceMesh(soup), report);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(report.warnings[0].code, "polygons-cut");
  const int triangles = 4 * n - 2, fan = static_cast<int>(beside.size());
  ASSERT_EQ(S.n_patches(), triangles + 1);
  for (int p = 0; p < triangles; ++p) EXPECT_EQ(S.patch_offsets[p], p);
  EXPECT_EQ(S.patch_offsets[triangles], triangles);
  EXPECT_EQ(S.patch_offsets[triangles + 1], triangles + fan);
}

TEST(PolygonSurface, PolygonsThatComeBackToACornerAreCutWhicheverComesFirst) {
  // A square with a slit from a corner to a point inside it, and what is beside it. At one place
  // twice in a row is no way back.
  for (int turn = 0; turn < 6; ++turn) {
    PolygonSoup soup;
    soup.points.resize(7, 3);
    soup.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.6, 0.5, 0, 2, 0, 0, 2, 1, 0;
    std::vector<int> slit{0, 1, 2, 4, 2, 3}, plain{1, 5, 6, 2};
    std::rotate(slit.begin(), slit.begin() + turn, slit.end());
    std::rotate(plain.begin(), plain.begin() + turn % 4, plain.end());
    plain.insert(plain.begin() + 1, plain[0]);
    soup.add_face(slit);
    soup.add_face(plain);
    Report report;
    const NodalSurface S = polygon_surface(SurfaceMesh(soup), report);
    ASSERT_EQ(S.n_patches(), 4 + 1) << turn;
    EXPECT_EQ(std::count_if(report.warnings.begin(), report.warnings.end(),
                            [](const auto& warning) { return warning.code == "polygons-cut"; }),
              1);
  }
}

/// A grid over [0, 1]^2, and with it what is its mirror image below; the faces of the first come
/// first.
PolygonSoup mirrored_grid(const PolygonSoup& grid, int nx) {
  PolygonSoup soup = grid;
  const int n = grid.n_vertices();
  soup.points.conservativeResize(2 * n, 3);
  std::vector<int> there(static_cast<std::size_t>(n));
  for (int v = 0; v < n; ++v) {
    there[v] = v <= nx ? v : n + v;
    soup.points.row(n + v) << grid.points(v, 0), -grid.points(v, 1), 0;
  }
  for (int f = 0; f < grid.n_faces(); ++f)
    test::add_triangle(soup, there[grid.face(f)[1]], there[grid.face(f)[0]],
                       there[grid.face(f)[2]]);
  return soup;
}

/// Of one curve, without sides.
SourceSystem unsigned_system(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                             const Curve& curve) {
  Report report;
  Sources sources;
  sources.curves.push_back(curve.unsigned_curve());
  return source_system(mesh, T, place_sources(mesh, sources, report));
}

TEST(TriangleSources, UnsignedCurvesAlongTheBoundaryAreAsStrongAsOneSideOfThoseWithin) {
  const int nx = 6;
  PolygonSoup grid = test::jittered_grid_soup(nx, 5, 0.2);
  for (int v = 0; v <= nx; ++v) ASSERT_EQ(grid.points(v, 1), 0);
  const PolygonSoup both = mirrored_grid(grid, nx);
  const auto vectors = [&](const PolygonSoup& soup, int faces) {
    const SurfaceMesh mesh(soup);
    Report report;
    const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
    std::vector<int> along(std::size_t(nx - 1));
    std::iota(along.begin(), along.end(), 1);
    const SourceSystem system = unsigned_system(mesh, T, Curve::along_vertices(along));
    VecX length = VecX::Zero(T.n_edges());
    for (const auto& [e, z] : system.X0) length[e] = std::abs(z) * T.unit;
    // Of edges inside the first faces, and not at the ends of the curve.
    std::vector<double> out;
    for (int e = 0; e < T.n_edges(); ++e) {
      const Vec3 x = (mesh.point(T.edges(e, 0)) + mesh.point(T.edges(e, 1))) / 2;
      if (mesh.edge_faces(e)[0] < faces && x[1] > 1e-9 && x[0] > 2.6 / nx && x[0] < 3.4 / nx)
        out.push_back(length[e]);
    }
    return out;
  };
  const std::vector<double> one = vectors(grid, grid.n_faces());
  const std::vector<double> of_two = vectors(both, grid.n_faces());
  ASSERT_EQ(one.size(), of_two.size());
  int some = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_NEAR(one[i], of_two[i], 1e-9) << i;
    some += one[i] > 1e-3;
  }
  EXPECT_GE(some, 1);
}

TEST(TriangleSources, AShortClosedUnsignedCurvePushesOutOfItsTriangle) {
  // Around the middle of an even triangle: nearly from there to the middle of each side, by its
  // length.
  PolygonSoup soup;
  soup.points.resize(3, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0.5, std::sqrt(0.75), 0;
  test::add_triangle(soup, 0, 1, 2);
  const SurfaceMesh mesh(soup);
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const double a = 1.0 / 3 - 0.001, b = 1 - 2 * a, length = 3 * (b - a) / T.unit;
  const SourceSystem system = unsigned_system(
      mesh, T,
      Curve::through({SurfacePoint::in_face(0, b, a, a), SurfacePoint::in_face(0, a, b, a),
                      SurfacePoint::in_face(0, a, a, b), SurfacePoint::in_face(0, b, a, a)}));
  ASSERT_EQ(system.X0.size(), 3u);
  for (const auto& [e, z] : system.X0)
    for (int k = 0; k < 3; ++k)
      if (T.side_edge(0, k) == e) {
        EXPECT_NEAR(z.imag() * T.along(0, k) * T.orientation[0], -length, 0.05 * length);
        EXPECT_NEAR(z.real(), 0, 0.05 * length);
      }
}

}  // namespace
}  // namespace littoral
