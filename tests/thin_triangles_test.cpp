// Triangles and tets without area or volume: answers all the same.

#include <gtest/gtest.h>

#include "api/surface/surface_domain.h"
#include "base/triangle.h"
#include "one_call.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(ThinTriangles, CotangentsKeepTheirDigits) {
  // Sides d, 1, 1: cot = d / sqrt(4 - d^2) at the short side's ends, (2 - d^2) / (d sqrt(4 - d^2))
  // opposite it.
  for (const double d : {1.0, 1e-3, 1e-10}) {
    const TriangleShape t = triangle_shape(d, 1, 1, false);
    const double root = std::sqrt(4 - d * d);
    EXPECT_NEAR(t.cot[0] * root / d, 1, 1e-9);
    EXPECT_NEAR(t.cot[1] * root / d, 1, 1e-9);
    EXPECT_NEAR(t.cot[2] * d * root / (2 - d * d), 1, 1e-9);
    EXPECT_NEAR(t.p[2].real() / d, 0.5, 1e-9);
  }
}

/// A grid with a vertex moved onto another, and one whose only triangle is then a needle.
SurfaceMesh with_needles() {
  PolygonSoup soup = test::grid_soup(4, 4);
  soup.points.row(7) = soup.points.row(6);
  const int n = soup.n_vertices();
  soup.points.conservativeResize(n + 1, 3);
  soup.points.row(n) << 0.5, 0.5, 1;
  test::add_triangle(soup, 6, 7, n);
  return SurfaceMesh(soup);
}

TEST(ThinTriangles, EveryMethodAnswers) {
  const SurfaceMesh mesh = with_needles();
  Sources sources;
  sources.points = {SurfacePoint::at_vertex(0), SurfacePoint::in_face(12, 0.2, 0.3, 0.5)};
  for (const MethodInfo& method : Registry<SurfaceDomain>::instance().infos()) {
    Report report;
    VecX d;
    ASSERT_NO_THROW(
        d = test::surface_distance(mesh, sources, AnyMethod::named(method.name), report))
        << method.name;
    EXPECT_TRUE(d.allFinite()) << method.name;
    EXPECT_NEAR(d[6], d[7], 1e-3) << method.name;
  }
}

TEST(ThinTrianglesSlow, SourcesAreHeldBesideNeedles) {
  const SurfaceMesh mesh = with_needles();
  Sources all;
  for (int v = 0; v < mesh.n_vertices(); ++v) all.points.push_back(SurfacePoint::at_vertex(v));
  for (const char* method : {"regularized", "belyaev-fayolle", "quadratic"}) {
    Report report;
    const VecX d = test::surface_distance(mesh, all, AnyMethod::named(method), report);
    EXPECT_LT(d.maxCoeff(), 1e-3) << method;
  }
}

TEST(ThinTriangles, TetsThatRepeatAVertexAreHarmless) {
  TetMesh mesh = test::tet_box(2);
  mesh.tets.conservativeResize(mesh.tets.rows() + 1, 4);
  mesh.tets.bottomRows(1) << 0, 0, 1, 26;
  TetSources sources;
  sources.surface.points.resize(3, 3);
  sources.surface.points << 0.1, 0.1, 0.4, 0.9, 0.1, 0.4, 0.1, 0.9, 0.4;
  test::add_triangle(sources.surface, 0, 1, 2);
  for (const char* method : {"signed-heat", "regularized", "quadratic"}) {
    Report report;
    VecX d;
    ASSERT_NO_THROW(d = test::tet_mesh_distance(mesh, sources, AnyMethod::named(method), report))
        << method;
    EXPECT_TRUE(d.allFinite()) << method;
  }
}

}  // namespace
}  // namespace littoral
