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

/// Triangles round vertex 0, `width` apart where they are needles.
PolygonSoup needle_fan(double width) {
  PolygonSoup soup;
  soup.points.resize(8, 3);
  soup.points.row(0).setZero();
  for (int i = 1; i < 8; ++i)
    if (i < 5)
      soup.points.row(i) << 1, (i - 1) * width, i == 3 ? width : 0;
    else
      soup.points.row(i) << std::cos(0.5 * (i - 1)), std::sin(0.5 * (i - 1)), i == 5 ? width : 0;
  for (int i = 1; i < 7; ++i) test::add_triangle(soup, 0, i, i + 1);
  return soup;
}

TEST(ThinTriangles, RefinementLeavesNeedlesAnArea) {
  for (const double width : {1e-9, 1e-6}) {
    const SurfaceMesh mesh(needle_fan(width));
    Sources sources;
    sources.points = {SurfacePoint::at_vertex(0), SurfacePoint::on_edge(2, 0),
                      SurfacePoint::on_edge(11, 0.7)};
    for (const char* method : {"unsigned-heat", "signed-heat"}) {
      Report report;
      VecX d;
      ASSERT_NO_THROW(
          d = test::surface_distance(
              mesh, sources, AnyMethod::named(method, {{"intrinsic-delaunay", "on"}}), report))
          << method;
      EXPECT_TRUE(d.allFinite()) << method;
      EXPECT_LT(d.maxCoeff(), 1.2) << method;
    }
  }
}

TEST(ThinTriangles, RegularizedDistancesAreThoseOfWiderNeedles) {
  const auto all_pairs = [](double width, const char* alpha) {
    Report report;
    const PairsAnswer answer =
        test::pair_distances(SurfaceMesh(needle_fan(width)), {},
                             AnyMethod::named("symmetric", {{"alpha", alpha}}), report);
    EXPECT_EQ(report.status, "converged") << width << " " << alpha;
    return answer.distances;
  };
  for (const char* alpha : {"0.05", "1", "40000"}) {
    const MatX wider = all_pairs(1e-5, alpha);
    for (const double width : {1e-8, 1e-9, 1e-12})
      EXPECT_LT((all_pairs(width, alpha) - wider).cwiseAbs().maxCoeff(), 0.01 * wider.maxCoeff())
          << width << " " << alpha;
  }
  for (const char* method : {"regularized", "belyaev-fayolle"}) {
    const auto from = [&](double width) {
      Report report;
      Sources sources;
      sources.points = {SurfacePoint::at_vertex(6), SurfacePoint::at_vertex(2)};
      const VecX d = test::surface_distance(SurfaceMesh(needle_fan(width)), sources,
                                            AnyMethod::named(method), report);
      EXPECT_EQ(report.status, "converged") << method << width;
      return d;
    };
    const VecX wider = from(1e-5);
    for (const double width : {1e-8, 1e-9, 1e-12})
      EXPECT_LT((from(width) - wider).cwiseAbs().maxCoeff(), 0.01) << method << width;
  }
}

TEST(ThinTriangles, NormalsArePreservedBesidePolygonsWithoutArea) {
  PolygonSoup soup;
  soup.points.resize(9, 3);  // a strip of quads: the second and its neighbours have collapsed
  soup.points << 0, 0, 0.18356933593750002, 1, 0, 0.055459594726562506, 0, 1. / 3,
      0.13030395507812501, 0, 1. / 3, 0.13030395507812501, 0, 2. / 3, 0.1950836181640625, 0, 2. / 3,
      0.1950836181640625, 0, 1, 0.12463684082031251, 1, 1, 0.056604003906250006, 0.007080078125,
      0.54119873046875, 0.354095458984375;
  for (const auto& [a, b, c, d] : {std::array{0, 1, 3, 2}, {2, 3, 5, 4}, {4, 5, 7, 6}}) {
    const int face[4] = {a, b, c, d};
    soup.add_face(face);
  }
  test::add_triangle(soup, 2, 3, 8);
  const auto first =
      SurfacePoint::in_face(0, 0.9515380859375, 0.035198038443922997, 0.013263875618577003);
  Curve loop, across;
  loop.nodes = {
      first, SurfacePoint::in_face(3, 0.2710113525390625, 0.35213613300584257, 0.37685251445509493),
      SurfacePoint::on_edge(5, 0.7189178466796875),
      SurfacePoint::in_face(3, 0.48345947265625, 0.22552933730185032, 0.29101119004189968), first};
  across.nodes = {
      SurfacePoint::on_edge(7, 0.393341064453125),
      SurfacePoint::in_face(3, 0.8757781982421875, 0.026356569724157453, 0.097865232033655047),
      SurfacePoint::in_face(2, 1, 0, 0)};
  Sources sources;
  sources.curves = {loop, across};
  Report report;
  VecX d;
  ASSERT_NO_THROW(
      d = test::surface_distance(
          SurfaceMesh(soup), sources,
          AnyMethod::named("signed-heat", {{"preserve-normals", "on"}, {"discontinuous", "on"}}),
          report));
  EXPECT_TRUE(d.allFinite());
}

TEST(ThinTriangles, ExactDistanceIsNotNegativeBesideACurve) {
  PolygonSoup grid;  // vertices 1 and 5 are at one place
  grid.points.resize(6, 3);
  grid.points << 0, 0, 0.286, 0.5, 0, 0.362, 1, 0, 0.323, 0, 1, 0.047, 0.5, 1, 0.1, 0.5, 0, 0.362;
  for (const auto& [a, b, c] : {std::array{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}})
    test::add_triangle(grid, a, b, c);
  Curve loop, side;
  loop.is_signed = side.is_signed = false;
  loop.nodes = {SurfacePoint::at_vertex(1), SurfacePoint::on_edge(7, 0),
                SurfacePoint::in_face(1, 0.73, 0.07, 0.2), SurfacePoint::in_face(1, 1, 0, 0),
                SurfacePoint::at_vertex(1)};
  side.nodes = {SurfacePoint::at_vertex(0), SurfacePoint::at_vertex(1)};
  Sources sources;
  sources.curves = {loop, side};
  for (const char* method : {"auto", "exact"}) {
    Report report;
    const VecX d =
        test::surface_distance(SurfaceMesh(grid), sources, AnyMethod::named(method), report);
    EXPECT_GE(d.minCoeff(), 0) << method;
    EXPECT_LT(d[5], 1e-9) << method;
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
