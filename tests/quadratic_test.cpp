// Quadratic-order geodesics: exact in the plane, quadratic order on the sphere, any topology.

#include <gtest/gtest.h>

#include <random>

#include "base/parallel.h"
#include "littoral/error.h"
#include "one_call.h"
#include "quadratic_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::largest_squared_error;
using test::point_source;
using test::quadratic;

/// A flat star: a fan of n triangles about the origin, boundary radii at random, every triangle cut
/// in three at a random point. Everything in a small disk about the origin sees all of it.
PolygonSoup star_soup(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  const int n = 5 + static_cast<int>(seed % 9);
  PolygonSoup soup;
  soup.points.resize(2 * n + 1, 3);
  soup.points.setZero();
  const double turn = 2 * std::acos(-1.0);
  for (int i = 0; i < n; ++i) {
    const double a = turn * (i + 0.4 * uniform(random)) / n, r = 0.8 + 0.4 * uniform(random);
    soup.points.row(1 + i) << r * std::cos(a), r * std::sin(a), 0;
  }
  for (int i = 0; i < n; ++i) {
    const int a = 1 + i, b = 1 + (i + 1) % n, c = 1 + n + i;
    Vec3 w(0.05 + uniform(random), 0.05 + uniform(random), 0.05 + uniform(random));
    w /= w.sum();
    soup.points.row(c) =
        w[0] * soup.points.row(0) + w[1] * soup.points.row(a) + w[2] * soup.points.row(b);
    test::add_triangle(soup, 0, a, c);
    test::add_triangle(soup, a, b, c);
    test::add_triangle(soup, b, 0, c);
  }
  return soup;
}

TEST(QuadraticSolver, FlatStarsAreExactForSourcesInTheKernel) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    const SurfaceMesh mesh(star_soup(seed));
    // The centre itself, or a point near it on an edge or in a face.
    SurfacePoint p = SurfacePoint::at_vertex(0);
    const int f = static_cast<int>(3 * (seed % 5));
    const double t = mesh.side_along(f, 0) ? 0.1 : 0.9;
    if (seed % 3 == 1) p = SurfacePoint::on_edge(mesh.side_edge(f, 0), t);
    if (seed % 3 == 2) p = SurfacePoint::in_face(f, 0.8, 0.15, 0.05);
    Quadratic options;
    options.tolerance = 1e-6;
    Report report;
    const auto field = quadratic(mesh, point_source(p), options, report);
    const Vec3 source = mesh.position(p);
    EXPECT_LT(
        largest_squared_error(mesh, field, [&](const Vec3& x) { return (x - source).norm(); }),
        2e-4)
        << "seed " << seed << " status " << report.status;
  }
}

TEST(QuadraticSolver, FlatConvexIsExactForAnySourceAndTriangulation) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (unsigned seed = 0; seed < 8; ++seed) {
    const SurfaceMesh mesh(test::jittered_grid_soup(6, 5, 0.24, seed));
    double a = uniform(random), b = uniform(random);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const SurfacePoint p =
        SurfacePoint::in_face(static_cast<int>(uniform(random) * mesh.n_faces()), 1 - a - b, a, b);
    Quadratic options;
    options.tolerance = 1e-6;
    Report report;
    const auto field = quadratic(mesh, point_source(p), options, report);
    const Vec3 source = mesh.position(p);
    EXPECT_LT(
        largest_squared_error(mesh, field, [&](const Vec3& x) { return (x - source).norm(); }),
        2e-4)
        << "seed " << seed;
    EXPECT_EQ(report.status, "converged");
    EXPECT_LT(report.residuals.front().second, 1e-5);  // duality gap
  }
}

TEST(QuadraticSolver, OrderOnTheSphere) {
  double last = 0;
  for (int level : {2, 3, 4}) {
    const SurfaceMesh mesh(test::octasphere_soup(level));
    Report report;
    const VecX d =
        quadratic(mesh, point_source(SurfacePoint::at_vertex(4)), {}, report).at_vertices();
    double sum = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v)
      sum += std::pow(d[v] - std::acos(std::clamp(mesh.point(v)[2], -1.0, 1.0)), 2);
    const double rms = std::sqrt(sum / mesh.n_vertices());
    if (last > 0) {
      EXPECT_GT(std::log2(last / rms), 1.5) << "level " << level;
    }
    last = rms;
  }
  EXPECT_LT(last, 6e-3);
}

TEST(QuadraticSolver, ScaleAndThreadsDoNotMatter) {
  const PolygonSoup soup = test::octasphere_soup(2);
  const auto solve = [](PolygonSoup s, double scale) {
    s.points *= scale;
    Report report;
    return quadratic(SurfaceMesh(s), point_source(SurfacePoint::in_face(5, 0.5, 0.2, 0.3)), {},
                     report)
        .at_vertices();
  };
  set_thread_count(1);
  const VecX one = solve(soup, 1);
  set_thread_count(0);
  EXPECT_EQ(one, solve(soup, 1));
  for (double scale : {1e-3, 1e3, 1e30})
    EXPECT_LT((solve(soup, scale) / scale - one).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(QuadraticSolver, ComponentsWithoutSourceAreInfiniteAndListed) {
  PolygonSoup soup = test::grid_soup(2, 2);
  const int n = soup.n_vertices();
  soup.points.conservativeResize(n + 4, 3);
  soup.points.bottomRows(4) << 5, 0, 0, 6, 0, 0, 5, 1, 0, 9, 9, 9;  // a triangle and a loose vertex
  test::add_triangle(soup, n, n + 1, n + 2);
  const SurfaceMesh mesh(soup);
  Report report;
  const auto field = quadratic(mesh, point_source(SurfacePoint::at_vertex(0)), {}, report);
  const VecX d = field.at_vertices();
  for (int v = 0; v < n; ++v) EXPECT_NEAR(d[v], mesh.point(v).norm(), 1e-3);
  for (int v = n; v < n + 4; ++v) EXPECT_EQ(d[v], std::numeric_limits<double>::infinity());
  EXPECT_EQ(field.distance(mesh.n_faces() - 1, P2Shape<2>::centre()),
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(report.unreachable_components, std::vector<int>{1});
}

/// One mesh, and a second one beside it that is smaller.
PolygonSoup beside(const PolygonSoup& large, const PolygonSoup& small, double scale) {
  PolygonSoup soup = large;
  const int n = soup.n_vertices();
  soup.points.conservativeResize(n + small.n_vertices(), 3);
  for (int v = 0; v < small.n_vertices(); ++v)
    soup.points.row(n + v) = scale * small.points.row(v) + Vec3(3, 0, 0).transpose();
  for (int f = 0; f < small.n_faces(); ++f)
    test::add_triangle(soup, n + small.face(f)[0], n + small.face(f)[1], n + small.face(f)[2]);
  return soup;
}

TEST(QuadraticSolver, EachComponentIsAProblemOfItsOwn) {
  const PolygonSoup grid = test::jittered_grid_soup(6, 6, 0.2);
  const int n = grid.n_vertices();
  for (const double scale : {1e-3, 1e-4, 1e-5}) {
    const SurfaceMesh mesh(beside(grid, grid, scale));
    Sources sources = point_source(SurfacePoint::at_vertex(8));
    sources.points.push_back(SurfacePoint::at_vertex(n + 8));
    Report report;
    const VecX d = quadratic(mesh, sources, {}, report).at_vertices();
    EXPECT_EQ(report.status, "converged");
    for (int v = 0; v < n; ++v) {
      const double exact = (grid.points.row(v) - grid.points.row(8)).norm();
      EXPECT_NEAR(d[v], exact, 3e-4);
      EXPECT_NEAR(d[n + v] / scale, exact, 3e-4) << scale;
    }
    std::vector<std::string> names;
    for (const auto& [name, value] : report.residuals) names.push_back(name);
    for (const char* name : {"duality gap", "duality gap, component 0", "duality gap, component 1"})
      EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  }
}

TEST(QuadraticSolver, EveryVertexMayBeASource) {
  PolygonSoup triangle;
  triangle.points.resize(3, 3);
  triangle.points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  test::add_triangle(triangle, 0, 1, 2);
  for (const PolygonSoup& soup : {triangle, test::grid_soup(3, 2), test::octasphere_soup(0),
                                  test::octasphere_soup(2), beside(triangle, triangle, 1e-5)}) {
    const SurfaceMesh mesh(soup);
    Sources sources;
    for (int v = 0; v < mesh.n_vertices(); ++v)
      sources.points.push_back(SurfacePoint::at_vertex(v));
    Report report;
    const auto field = quadratic(mesh, sources, {}, report);
    EXPECT_EQ(report.status, "converged");
    EXPECT_LT(field.at_vertices().maxCoeff(), 1e-3);
    const double half = 0.5 * (mesh.point(mesh.face(0)[0]) - mesh.point(mesh.face(0)[1])).norm();
    EXPECT_NEAR(field.distance(0, P2Shape<2>::middle(0)), half, 1e-3 * half);
  }
}

TEST(QuadraticSolver, SeveralPointsInOneTriangle) {
  const SurfaceMesh mesh(test::jittered_grid_soup(6, 5, 0.2));
  const double h = 0.2;
  const int f = 23;
  std::vector<std::vector<SurfacePoint>> sets;
  for (const double apart : {0.5, 0.1, 0.01})
    sets.push_back({SurfacePoint::in_face(f, 0.4, 0.3, 0.3),
                    SurfacePoint::in_face(f, 0.4 - apart / 2, 0.3 + apart / 2, 0.3)});
  sets.push_back(
      {SurfacePoint::at_vertex(mesh.face(f)[0]), SurfacePoint::at_vertex(mesh.face(f)[1])});
  sets.push_back(
      {SurfacePoint::at_vertex(mesh.face(f)[0]), SurfacePoint::in_face(f, 0.2, 0.2, 0.6)});
  for (std::size_t k = 0; k < sets.size(); ++k) {
    Sources sources;
    sources.points = sets[k];
    const double apart = (mesh.position(sets[k][0]) - mesh.position(sets[k][1])).norm();
    Report report;
    const VecX d = quadratic(mesh, sources, {}, report).at_vertices();
    EXPECT_EQ(report.status, "converged");
    double worst = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const double exact = std::min((mesh.point(v) - mesh.position(sets[k][0])).norm(),
                                    (mesh.point(v) - mesh.position(sets[k][1])).norm());
      worst = std::max(worst, std::abs(d[v] - exact));
    }
    EXPECT_LT(worst, 0.5 * std::min(apart, 0.2 * h)) << k << ", " << apart << " apart";
  }
}

TEST(QuadraticSolver, ScalesWhoseSquaresOverflow) {
  for (const double scale : {1e160, 1e-160}) {
    PolygonSoup soup = test::grid_soup(3, 3);
    soup.points *= scale;
    const SurfaceMesh mesh(soup);
    Report report;
    const VecX d =
        quadratic(mesh, point_source(SurfacePoint::at_vertex(0)), {}, report).at_vertices();
    for (int v = 0; v < mesh.n_vertices(); ++v)
      EXPECT_NEAR(d[v] / scale, (mesh.point(v) / scale).norm(), 1e-3);
  }
}

TEST(QuadraticSolver, CoincidentCornersAreNoReasonToFail) {
  PolygonSoup soup = test::grid_soup(4, 4);
  soup.points.row(7) = soup.points.row(6);
  const SurfaceMesh mesh(soup);
  Report report;
  const VecX d =
      quadratic(mesh, point_source(SurfacePoint::at_vertex(0)), {}, report).at_vertices();
  EXPECT_EQ(report.status, "converged");
  EXPECT_NEAR(d[6], d[7], 1e-3);
  for (int v = 0; v < mesh.n_vertices(); ++v) EXPECT_GT(d[v], mesh.point(v).norm() - 1e-2) << v;
}

TEST(QuadraticSolver, ThreePagesOfABookAreFlatTwoByTwo) {
  PolygonSoup soup;  // three half squares around the edge 0-1
  soup.points.resize(8, 3);
  soup.points << 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, -1, 0, 0, -1, 1, 0, 0, 0, 1, 0, 1, 1;
  for (int k = 0; k < 3; ++k) {
    test::add_triangle(soup, 0, 2 + 2 * k, 1);
    test::add_triangle(soup, 1, 2 + 2 * k, 3 + 2 * k);
  }
  const SurfaceMesh mesh(soup);
  Report report;
  const VecX d =
      quadratic(mesh, point_source(SurfacePoint::at_vertex(2)), {}, report).at_vertices();
  const double far = std::hypot(2.0, 1.0);
  const double exact[] = {1, std::sqrt(2.0), 0, 1, 2, far, 2, far};
  for (int v = 0; v < 8; ++v) EXPECT_NEAR(d[v], exact[v], 2e-3) << v;
}

TEST(QuadraticSolver, StraightCurvesAcrossAFlatDomain) {
  const SurfaceMesh mesh(test::jittered_grid_soup(7, 7, 0.2, 5));
  Sources sources;
  sources.space_curves.push_back(
      {(MatX3(2, 3) << 0.37, 0, 0, 0.37, 1, 0).finished(), false, "test"});
  Quadratic options;
  options.tolerance = 1e-6;
  Report report;
  const auto field = quadratic(mesh, sources, options, report);
  EXPECT_LT(largest_squared_error(mesh, field, [](const Vec3& x) { return std::abs(x[0] - 0.37); }),
            2e-5);
  options.spacing = 0.5;  // samples let the field dip between them
  const auto sampled = quadratic(mesh, sources, options, report);
  EXPECT_LT(
      largest_squared_error(mesh, sampled, [](const Vec3& x) { return std::abs(x[0] - 0.37); }),
      5e-3);
  EXPECT_EQ(report.status, "converged");
}

TEST(QuadraticSolver, NeedlesAreMollifiedAndHaveABoundedEffect) {
  PolygonSoup soup = test::grid_soup(4, 4);
  const int n = soup.n_vertices();
  soup.points.conservativeResize(n + 1, 3);
  soup.points.row(n) = 0.5 * (soup.points.row(6) + soup.points.row(7));  // on the edge 6-7
  test::add_triangle(soup, 6, 7, n);
  const SurfaceMesh mesh(soup);
  Report report;
  const VecX d =
      quadratic(mesh, point_source(SurfacePoint::at_vertex(12)), {}, report).at_vertices();
  for (int v = 0; v < n; ++v) EXPECT_NEAR(d[v], (mesh.point(v) - mesh.point(12)).norm(), 2e-3) << v;
  EXPECT_FALSE(report.warnings.empty());
}

TEST(QuadraticSolver, ACurveThatEndsOnASideIsKnownInAllTrianglesThere) {
  // Three pages; the curve runs in the first, up to the spine.
  PolygonSoup book;
  book.points.resize(5, 3);
  book.points << 0, 0, 0, 0, 0, 1, 1, 0, 0.5, -1, 0, 0.5, 0, 1, 0.5;
  for (const int v : {2, 3, 4}) test::add_triangle(book, 0, 1, v);
  const SurfaceMesh mesh(book);
  Sources sources;
  sources.curves.emplace_back();
  sources.curves[0].is_signed = false;
  sources.curves[0].nodes = {SurfacePoint::in_face(0, 0.5, 0.1, 0.4),
                             SurfacePoint::in_face(0, 0.7, 0.3, 0)};
  Report report;
  const VecX d = quadratic(mesh, sources, {}, report).at_vertices();
  for (const int v : {3, 4}) EXPECT_LE(d[v], 1.001 * std::hypot(1, 0.2)) << v;
}

TEST(QuadraticSolver, ACurveThatEndsOnASideIsKnownWhereAnotherRuns) {
  PolygonSoup kite;
  kite.points.resize(4, 3);
  kite.points << 0, 0, 0, 1, 0, 0, std::cos(0.5), std::sin(0.5), 0, std::cos(1), std::sin(1), 0;
  test::add_triangle(kite, 0, 1, 2);
  test::add_triangle(kite, 0, 2, 3);
  const SurfaceMesh mesh(kite);
  Sources sources;
  sources.curves.resize(2);
  sources.curves[0].nodes = {SurfacePoint::at_vertex(1), SurfacePoint::in_face(0, 0.4, 0, 0.6)};
  sources.curves[1].nodes = {SurfacePoint::at_vertex(0), SurfacePoint::in_face(1, 0.9, 0.05, 0.05)};
  for (Curve& curve : sources.curves) curve.is_signed = false;
  Report report;
  const VecX d = quadratic(mesh, sources, {}, report).at_vertices();
  const Vec3 end = 0.6 * mesh.point(2);
  EXPECT_LE(d[3], 1.001 * (mesh.point(3) - end).norm());
}

TEST(QuadraticSolver, CancelsAndReportsWhenIterationsRunOut) {
  const SurfaceMesh mesh(test::octasphere_soup(3));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const QuadraticSolver<2> method(std::make_shared<const P2Elements<2>>(p2_elements(T)));
  const auto points = p2_sources(
      mesh, T, place_sources(mesh, point_source(SurfacePoint::at_vertex(0)), report), 0.5);
  CancelToken token;
  int calls = 0;
  Task task(token, [&](double, const std::string&) {
    if (++calls == 6) token.cancel();
  });
  EXPECT_THROW(method.solve(points, {}, task, report), Cancelled);
  Quadratic few;
  few.max_iterations = 3;
  const auto field = method.solve(points, few, {}, report);
  EXPECT_EQ(report.status, "not converged");
  EXPECT_TRUE(field.u.allFinite());
}

TEST(QuadraticSolver, SamplesAreInsertedAtALooseTolerance) {
  PolygonSoup strip = test::grid_soup(5, 1);  // and three thin triangles
  strip.points.conservativeResize(14, 3);
  strip.points.row(12) << -0.57, 0.71, 0.26;
  strip.points.row(13) << 0.3, 0.5, 0;
  test::add_triangle(strip, 4, 11, 12);
  test::add_triangle(strip, 1, 8, 13);
  test::add_triangle(strip, 8, 9, 2);
  const SurfaceMesh mesh(strip);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    Report report;
    Quadratic options;
    options.tolerance = 0.1;
    options.source_radius = 1.46e-7;
    const VecX d =
        test::surface_distance(mesh, Sources(SurfacePoint::at_vertex(v)), options, report);
    EXPECT_TRUE(d.allFinite()) << v;
    EXPECT_LT(d.maxCoeff(), 3) << v;
  }
}

}  // namespace
}  // namespace littoral
