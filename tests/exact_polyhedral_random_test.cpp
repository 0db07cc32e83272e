// Exact polyhedral distance against the simple search on random meshes, on meshes that overlap
// themselves, and when it meets its limit.

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>
#include <random>

#include "geodesic_helpers.h"
#include "simple_exact.h"

namespace littoral {
namespace {

struct OnMesh {
  explicit OnMesh(const PolygonSoup& soup, const Sources& sources)
      : mesh(soup), T(intrinsic_triangulation(mesh, report)) {
    placed = place_sources(mesh, sources, report);
  }
  ExactDistance exact(double most_windows = 0, double tolerance = 0) {
    return exact_polyhedral(T, triangle_sources(mesh, T, placed), {}, report,
                            {most_windows, tolerance});
  }
  double windows() const {
    for (const auto& [loop, count] : report.iterations)
      if (loop == "windows") return count;
    return -1;
  }
  Report report;
  SurfaceMesh mesh;
  IntrinsicTriangulation T;
  PlacedSources placed;
};

PolygonSoup noisy(PolygonSoup soup, double amount, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-amount, amount);
  for (Eigen::Index v = 0; v < soup.points.rows(); ++v)
    for (int c = 0; c < 3; ++c) soup.points(v, c) += u(random);
  return soup;
}

/// Grids of m x n squares that share their first row.
PolygonSoup random_book(int pages, int m, int n) {
  PolygonSoup soup;
  soup.points.resize((n + 1) * (1 + pages * m), 3);
  for (int i = 0; i <= n; ++i) soup.points.row(i) << double(i) / n, 0, 0;
  for (int p = 0; p < pages; ++p)
    for (int j = 1; j <= m; ++j)
      for (int i = 0; i <= n; ++i)
        soup.points.row((n + 1) * (p * m + j) + i) << double(i) / n,
            double(j) / m * std::cos(1.0 * p), double(j) / m * std::sin(1.0 * p);
  for (int p = 0; p < pages; ++p)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = j == 0 ? i : (n + 1) * (p * m + j) + i, c = (n + 1) * (p * m + j + 1) + i;
        test::add_triangle(soup, a, a + 1, c + 1);
        test::add_triangle(soup, a, c + 1, c);
      }
  return soup;
}

/// Some faces again, some of them turned over.
PolygonSoup doubled(const PolygonSoup& soup, int every) {
  PolygonSoup out = soup;
  for (int f = 0; f < soup.n_faces(); f += every) {
    const auto c = soup.face(f);
    if (f % 2)
      test::add_triangle(out, c[1], c[0], c[2]);
    else
      test::add_triangle(out, c[2], c[0], c[1]);
  }
  return out;
}

/// Points, in faces too, or a curve through some vertices.
Sources some_sources(const PolygonSoup& soup, unsigned seed) {
  std::mt19937 random(seed);
  Sources sources;
  const int n = 1 + int(seed % 3);
  if (seed % 4 == 3) {
    const auto c = soup.face(int(random() % unsigned(soup.n_faces())));
    sources.curves.push_back({{SurfacePoint::at_vertex(c[0]), SurfacePoint::at_vertex(c[1]),
                               SurfacePoint::at_vertex(c[2])},
                              false});
  }
  for (int i = 0; i < n; ++i) {
    const int f = int(random() % unsigned(soup.n_faces()));
    if (seed % 2)
      sources.points.push_back(SurfacePoint::in_face(f, 0.2, 0.5, 0.3));
    else
      sources.points.push_back(SurfacePoint::at_vertex(soup.face(f)[0]));
  }
  return sources;
}

void expect_like_simple(const PolygonSoup& soup, const Sources& sources) {
  OnMesh on(soup, sources);
  constexpr double tolerance = 1e-3;
  const VecX d = on.exact().distance / on.T.unit,
             within = on.exact(0, tolerance).distance / on.T.unit;
  const auto [simple, n] = test::simple_exact(on.T, triangle_sources(on.mesh, on.T, on.placed));
  double largest = 0;
  for (int v = 0; v < d.size(); ++v)
    if (std::isfinite(simple[v])) largest = std::max(largest, simple[v]);
  for (int v = 0; v < d.size(); ++v)
    if (std::isfinite(simple[v])) {
      EXPECT_NEAR(d[v], simple[v], 1e-9 * largest) << v;
      EXPECT_NEAR(within[v], simple[v], tolerance * simple[v] + 1e-9 * largest) << v;
    }
}

TEST(ExactPolyhedralRandom, LikeTheSimpleSearch) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    PolygonSoup egg = test::octasphere_soup(3),
                needles = test::jittered_grid_soup(12, 10, 0.4, seed);
    egg.points.col(0) *= 1 + seed;
    needles.points.col(0) *= 300;
    const std::vector<PolygonSoup> meshes = {
        egg,
        noisy(test::octasphere_soup(3), 0.05, seed),
        noisy(test::torus_soup(24, 12), 0.08, seed),
        noisy(test::grid_soup(12, 9), 0.05, seed),
        noisy(random_book(4, 5, 6), 0.06, seed),
        random_book(3, 6, 6),
        noisy(needles, 0.02, seed),
        needles,
        test::scrap(seed, 40),
        doubled(noisy(test::octasphere_soup(1), 0.1, seed), 6)};
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      SCOPED_TRACE(i);
      expect_like_simple(meshes[i], some_sources(meshes[i], seed));
    }
  }
}

TEST(ExactPolyhedralRandom, LikeTheSimpleSearchFromCurvesThroughFaces) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const PolygonSoup ball = noisy(test::octasphere_soup(3), 0.04, seed);
    MatX3 line(4, 3);
    line << 1, 0.1, 0, 0.7, 0.7, 0.2, 0.1, 0.9, 0.3, -0.5, 0.5, 0.6;
    expect_like_simple(ball, test::space_curve(line, seed % 2));
    expect_like_simple(doubled(ball, 9), test::space_curve(line, seed % 2));
  }
}

/// The named source alone is as far: pieces, their ends, and points.
TEST(ExactPolyhedralRandom, NearestIsWhereThePathStarts) {
  const PolygonSoup ball = noisy(test::octasphere_soup(3), 0.04, 3);
  MatX3 line(3, 3);
  line << 1, 0.1, 0, 0.7, 0.7, 0.2, 0.1, 0.9, 0.3;
  Sources sources = test::space_curve(line);
  sources.points = {SurfacePoint::at_vertex(5), SurfacePoint::in_face(40, 0.2, 0.5, 0.3),
                    SurfacePoint::at_vertex(77)};
  OnMesh on(ball, sources);
  const ExactDistance all = on.exact();
  const int n_pieces = int(on.placed.pieces.size());
  ASSERT_GT(n_pieces, 4);
  const PlacedSources placed = on.placed;
  std::vector<int> times(n_pieces + 3, 0);
  for (int v = 0; v < on.T.n_vertices; ++v) ++times.at(all.nearest[v]);
  EXPECT_GT(std::accumulate(times.begin(), times.begin() + n_pieces, 0), 20);
  for (int s = 0; s < n_pieces + 3; ++s) {
    if (s >= n_pieces) {
      EXPECT_GT(times[s], 0) << s;
    }
    on.placed = placed;
    on.placed.pieces.clear();
    on.placed.points.clear();
    if (s < n_pieces)
      on.placed.pieces = {placed.pieces[s]};
    else
      on.placed.points = {placed.points[s - n_pieces]};
    const VecX d = on.exact().distance;
    for (int v = 0; v < on.T.n_vertices; ++v) {
      EXPECT_GE(d[v], all.distance[v] - 1e-12);
      if (all.nearest[v] == s) {
        EXPECT_NEAR(d[v], all.distance[v], 1e-12) << s << " " << v;
      }
    }
  }
}

TEST(ExactPolyhedralRandom, NothingIsNearestWhereNothingReaches) {
  PolygonSoup soup = test::grid_soup(2, 2);
  soup.points.conservativeResize(13, 3);
  soup.points.bottomRows(4) << 5, 0, 0, 6, 0, 0, 5, 1, 0, 9, 9, 9;
  test::add_triangle(soup, 9, 10, 11);
  const ExactDistance d = OnMesh(soup, test::vertex_points({0, 8})).exact();
  EXPECT_EQ(d.nearest[1], 0);
  EXPECT_EQ(d.nearest[7], 1);
  for (int v = 9; v < 13; ++v) EXPECT_EQ(d.nearest[v], -1);
}

/// Several triangulations of the same points of a plane, edges and triangles shared where they
/// agree: distance is Euclidean. Copied at every edge, windows would double with each triangle.
PolygonSoup layers(int n, int count, unsigned seed) {
  PolygonSoup soup = test::jittered_grid_soup(n, n, 0.2, seed);
  std::mt19937 random(seed);
  PolygonSoup out;
  out.points = soup.points;
  for (int l = 0; l < count; ++l)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
        if (random() % 2) {
          test::add_triangle(out, a, b, d);
          test::add_triangle(out, a, d, c);
        } else {
          test::add_triangle(out, a, b, c);
          test::add_triangle(out, b, d, c);
        }
      }
  return out;
}

TEST(ExactPolyhedralRandom, LayersOfAPlaneStayBounded) {
  for (const int count : {1, 2, 3, 6}) {
    SCOPED_TRACE(count);
    const int n = 20, source = 5 * (n + 1) + 7;
    OnMesh on(layers(n, count, 4), test::vertex_points({source}));
    const VecX d = on.exact().distance;
    for (int v = 0; v < on.T.n_vertices; ++v)
      EXPECT_NEAR(d[v], (on.mesh.point(v) - on.mesh.point(source)).norm(), 1e-12);
    EXPECT_LT(on.windows(), 20 * on.T.n_faces());
  }
}

/// Random triangles over few points, many of them the same: windows that are not compared multiply.
TEST(ExactPolyhedralRandom, CoincidentTrianglesStayBounded) {
  for (const auto& [points, faces] :
       std::vector<std::pair<int, int>>{{4, 9}, {5, 9}, {6, 9}, {8, 56}, {12, 220}, {30, 2000}})
    for (unsigned seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(std::to_string(points) + " " + std::to_string(faces));
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> u(0, 1);
      PolygonSoup soup;
      soup.points.resize(points, 3);
      for (int v = 0; v < points; ++v) soup.points.row(v) << u(random), u(random), u(random);
      while (soup.n_faces() < faces) {
        const int a = int(random() % unsigned(points)), b = int(random() % unsigned(points)),
                  c = int(random() % unsigned(points));
        if (a != b && b != c && c != a) test::add_triangle(soup, a, b, c);
      }
      OnMesh on(soup, some_sources(soup, seed));
      const VecX d = on.exact().distance;
      EXPECT_LT(on.windows(), 20 * faces);
      // An edge is the shortest way between its ends.
      for (int e = 0; e < on.mesh.n_edges(); ++e) {
        const int a = on.mesh.edges()(e, 0), b = on.mesh.edges()(e, 1);
        if (std::isfinite(d[a])) {
          EXPECT_LE(std::abs(d[a] - d[b]), (on.mesh.point(a) - on.mesh.point(b)).norm() + 1e-12);
        }
      }
    }
}

TEST(ExactPolyhedralRandom, FacesAgainChangeNothing) {
  const PolygonSoup once = noisy(test::torus_soup(24, 12), 0.05, 2);
  const Sources sources = some_sources(once, 2);
  OnMesh a(once, sources), b(doubled(doubled(once, 1), 1), sources);
  const VecX d = a.exact().distance, e = b.exact().distance;
  EXPECT_LT((d - e).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(b.windows(), 1.1 * a.windows());
}

/// Two vertices in one place: their triangles are needles that were made strict, and are longer by
/// 1e-10 than their neighbours think. Paths along edges must count there.
TEST(ExactPolyhedralRandom, AlongEdgesWhereTrianglesDisagreeAboutThem) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    PolygonSoup soup = noisy(test::grid_soup(5, 3), 0.3, seed);
    const int a = 6 + int(seed % 12);
    soup.points.row(a + 1) = soup.points.row(a);
    OnMesh on(soup, test::vertex_points({a + int(seed % 2)}));
    const VecX d = on.exact().distance;
    for (int e = 0; e < on.mesh.n_edges(); ++e) {
      const int v = on.mesh.edges()(e, 0), w = on.mesh.edges()(e, 1);
      EXPECT_LE(std::abs(d[v] - d[w]), (on.mesh.point(v) - on.mesh.point(w)).norm() + 1e-9);
    }
  }
}

/// Beyond its limit the search still ends, warns, and gives lengths of paths.
TEST(ExactPolyhedralRandom, AtTheLimitValuesAreTooLargeIfAnything) {
  const PolygonSoup soup = noisy(test::torus_soup(48, 24), 0.01, 5);
  OnMesh on(soup, test::vertex_points({0}));
  const VecX exact = on.exact().distance;
  const double windows = on.windows();
  EXPECT_TRUE(on.report.warnings.empty());
  for (const double share : {0.003, 0.01, 0.03, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}) {
    SCOPED_TRACE(share);
    const double error = share < 0.5 ? 0.1 : 0.02;
    OnMesh limited(soup, test::vertex_points({0}));
    const ExactDistance found = limited.exact(share * windows);
    const VecX& d = found.distance;
    EXPECT_GE((d - exact).minCoeff(), -1e-12);
    EXPECT_LT((d - exact).maxCoeff(), error * exact.maxCoeff());
    EXPECT_GT((d - exact).maxCoeff(), 1e-9) << "the limit was not met";
    EXPECT_EQ(limited.report.warnings.size(), 1);
    EXPECT_GT(found.exact_within, 0);
    for (int v = 0; v < d.size(); ++v) {
      if (exact[v] < found.exact_within) {
        EXPECT_NEAR(d[v], exact[v], 1e-12);
      }
    }
    EXPECT_LT(limited.windows(), 40 * windows);
  }
  OnMesh enough(soup, test::vertex_points({0}));
  EXPECT_TRUE(std::isinf(enough.exact(windows + 1).exact_within));
  EXPECT_TRUE(enough.report.warnings.empty());
}

/// Six unit triangles around a vertex, and six more behind them: the first windows are half the
/// root of three away, and go no further.
TEST(ExactPolyhedralRandom, ExactUpToTheNearestWindowLeft) {
  PolygonSoup soup;
  soup.points = MatX3::Zero(13, 3);
  for (int i = 0; i < 6; ++i) {
    const double angle = std::numbers::pi * i / 3;
    soup.points.row(1 + i) << 5 * std::cos(angle), 5 * std::sin(angle), 0;
  }
  for (int i = 0; i < 6; ++i) {
    const int next = (i + 1) % 6;
    soup.points.row(7 + i) = soup.points.row(1 + i) + soup.points.row(1 + next);
    test::add_triangle(soup, 0, 1 + i, 1 + next);
    test::add_triangle(soup, 7 + i, 1 + next, 1 + i);
  }
  OnMesh on(soup, test::vertex_points({0}));
  const ExactDistance d = on.exact(1);
  EXPECT_NEAR(d.exact_within, 5 * std::sqrt(0.75), 1e-12);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(d.distance[1 + i], 5, 1e-12);
    EXPECT_NEAR(d.distance[7 + i], 5 * std::sqrt(3.0), 1e-12);  // one triangle further, straight
  }
}

}  // namespace
}  // namespace littoral
