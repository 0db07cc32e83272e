// Distances between all pairs of vertices: the symmetric problem, and every source by itself.

#include "methods/regularized/all_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>

#include "api/surface/pairs.h"
#include "base/parallel.h"
#include "base/platform/memory.h"
#include "domain_shapes.h"
#include "geodesic_helpers.h"
#include "littoral/error.h"
#include "one_call.h"
#include "shared_data.h"
#include "test_meshes.h"

namespace littoral {
namespace {

MatX pairs_on(const SurfaceMesh& mesh, Symmetric options, Report& report) {
  return all_pairs(triangle_operators(intrinsic_triangulation(mesh, report)), options, {}, report);
}
MatX pairs_on(const SurfaceMesh& mesh, double alpha, double tolerance = 1e-3) {
  Symmetric options;
  options.alpha = alpha;
  options.tolerance = tolerance;
  Report report;
  const MatX U = pairs_on(mesh, options, report);
  EXPECT_EQ(report.status, "converged");
  return U;
}

PairsAnswer by_method(const SurfaceMesh& mesh, const std::string& method,
                      const std::vector<int>& vertices = {}, const OptionValues& options = {}) {
  Report report;
  return test::pair_distances(mesh, vertices, AnyMethod::named(method, options), report);
}

/// How far rows of several sources and a solve of its own may differ, of the largest distance:
/// round-off, but where an interior point method meets its tolerance from other sides.
double rows_within(const std::string& method) { return method == "quadratic" ? 1e-4 : 1e-9; }

TEST(AllPairs, CircleWithDirichletEnergy) {
  // On the circle U(x, y) = u(x - y), so the two terms of the energy are alike and the product
  // problem is min over u of integral alpha |u'|^2 - u: eq. 5 with 2 alpha for alpha.
  const int n = 60;
  const double height = 2e-3, pi = std::numbers::pi;
  for (const double alpha : {0.3, 0.7}) {
    const double area = 2 * pi * height;
    const MatX U = pairs_on(test::ring(n, 1, height), alpha / std::sqrt(area), 1e-4);
    const double twice = 2 * alpha;
    for (int i = 0; i < n; ++i)
      for (const int j : {0, 7}) {
        const double x = std::abs(2 * pi * (i - j) / n), y = std::min(x, 2 * pi - x);
        const double expected =
            y > pi - twice ? pi - twice / 2 - std::pow(pi - y, 2) / (2 * twice) : y;
        EXPECT_NEAR(U(i, j), expected, 0.03) << "alpha " << alpha << ", column " << i;
      }
  }
}

TEST(AllPairs, StopsWhereNoGradientReachesOneOrAllIsSymmetricByItself) {
  // As above, with 2 alpha > pi: u'' = -1 / (2 alpha), u(0) = 0, u'(pi) = 0, |u'| < 1 throughout.
  const int n = 60;
  const double height = 2e-3, pi = std::numbers::pi, area = 2 * pi * height, alpha = 3;
  const MatX U = pairs_on(test::ring(n, 1, height), alpha / std::sqrt(area), 1e-4);
  for (int i = 0; i < n; ++i) {
    const double x = 2 * pi * i / n;
    EXPECT_NEAR(U(i, 0), x * (2 * pi - x) / (4 * alpha), 0.01) << i;
  }
  PolygonSoup tetrahedron;
  tetrahedron.points.resize(4, 3);
  tetrahedron.points << 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1;
  for (const auto& f : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
    tetrahedron.add_face(f);
  for (const double alpha_hat : {0.05, 2.0})
    for (const PolygonSoup& soup :
         {tetrahedron, test::octasphere_soup(0), test::octasphere_soup(1)}) {
      const MatX D = pairs_on(SurfaceMesh(soup), alpha_hat);
      const double edge = (soup.points.row(0) - soup.points.row(2)).norm();
      EXPECT_GT(D(0, 2), 0.05 * edge);
      EXPECT_LT(D(0, 2), 1.01 * edge);
    }
}

TEST(AllPairs, SymmetricZeroAtHomeAndOfSlopeOne) {
  const SurfaceMesh mesh(test::jittered_grid_soup(5, 5, 0.25));
  const MatX U = pairs_on(mesh, 0.05);
  EXPECT_EQ((U - U.transpose()).cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(U.diagonal().cwiseAbs().maxCoeff(), 0);
  EXPECT_GE(U.minCoeff(), 0);
  for (int e = 0; e < mesh.n_edges(); ++e) {
    const int a = mesh.edges()(e, 0), b = mesh.edges()(e, 1);
    const double length = (mesh.point(a) - mesh.point(b)).norm();
    EXPECT_LE((U.col(a) - U.col(b)).cwiseAbs().maxCoeff(), 1.03 * length);
  }
}

TEST(AllPairs, TendsToTheDistanceAndSmoothingToFewerViolations) {
  const SurfaceMesh mesh(test::octasphere_soup(2));
  double error = 1e9, violations = 0;
  for (const double alpha : {0.2, 0.05, 0.0}) {
    const MatX U = pairs_on(mesh, alpha);
    const PairStatistics statistics = pair_statistics(U, 4 * std::numbers::pi, {});
    EXPECT_GT(statistics.violations, violations) << alpha;
    violations = statistics.violations;
    double worst = 0;
    for (int a = 0; a < mesh.n_vertices(); ++a)
      for (int b = 0; b < mesh.n_vertices(); ++b)
        worst = std::max(
            worst,
            std::abs(U(a, b) - std::acos(std::clamp(mesh.point(a).dot(mesh.point(b)), -1., 1.))));
    EXPECT_LT(worst, error);
    error = worst;
  }
  EXPECT_LT(error, 0.5);  // first order in an edge length of 0.4
  EXPECT_LT(violations, 0.1);
}

TEST(AllPairs, SameWhateverUnitThreadsAndPrecision) {
  const PolygonSoup soup = test::torus_soup(9, 6);
  const MatX U = pairs_on(SurfaceMesh(soup), 0.05);
  for (const double scale : {1e-3, 1e3}) {
    PolygonSoup scaled = soup;
    scaled.points *= scale;
    EXPECT_LT((pairs_on(SurfaceMesh(scaled), 0.05) / scale - U).cwiseAbs().maxCoeff(),
              1e-3 * U.maxCoeff());
  }
  Symmetric options;
  Report report;
  set_thread_count(1);
  const MatX one = pairs_on(SurfaceMesh(soup), options, report);
  set_thread_count(0);
  EXPECT_EQ((one - U).cwiseAbs().maxCoeff(), 0);
  options.storage = Storage::single;
  const MatX single = pairs_on(SurfaceMesh(soup), options, report);
  EXPECT_LT((single - U).cwiseAbs().maxCoeff(), 2e-3 * U.maxCoeff());
  EXPECT_GT((single - U).cwiseAbs().maxCoeff(), 0);
}

TEST(AllPairs, StopsWhereRoundOffIsAboveTheTolerance) {
  // Pages of a book beside a needle a million times as long.
  PolygonSoup soup;
  soup.points.resize(15, 3);
  soup.points << 1, 0, 0, 1, 0, 1e-6, 1.00001, 0, 0, 1.00001, 0, 1e-6, 1.000005, 8.66e-6, 0,
      1.000005, 8.66e-6, 1e-6, 0.999995, 8.66e-6, 0, 0.999995, 8.66e-6, 1e-6, 0.99999, 0, 0,
      0.99999, 0, 1e-6, 0.999995, -8.66e-6, 0, 0.999995, -8.66e-6, 1e-6, 1.000005, -8.66e-6, 0,
      1.000005, -8.66e-6, 1e-6, 0, -0.15, -0.07;
  for (int page = 1; page < 7; ++page) {
    test::add_triangle(soup, 0, 2 * page, 1);
    test::add_triangle(soup, 1, 2 * page, 2 * page + 1);
  }
  test::add_triangle(soup, 0, 4, 14);
  Report report;
  test::pair_distances(
      SurfaceMesh(soup), {},
      AnyMethod::named("symmetric", {{"tolerance", "1e-9"}, {"max-iterations", "300000"}}), report);
  EXPECT_EQ(report.status, "not converged");
  ASSERT_FALSE(report.iterations.empty());
  EXPECT_LT(report.iterations[0].second, 200000);
}

TEST(AllPairs, StopsWhereTheResidualFallsEverMoreSlowly) {
  // A fan of needles among wide triangles: a power of the number of iterations.
  PolygonSoup soup;
  soup.points.resize(12, 3);
  soup.points.row(0).setZero();
  for (int i = 1; i < 12; ++i) {
    const bool wide = i == 3 || i == 4 || (i > 5 && i < 9) || i == 11;
    soup.points.row(i) << (wide ? std::cos(i - 2.) : 1), (wide ? std::sin(i - 2.) : i * 1e-12), 0;
    if (i > 1) test::add_triangle(soup, 0, i - 1, i);
  }
  Report report;
  test::pair_distances(
      SurfaceMesh(soup), {},
      AnyMethod::named("symmetric", {{"tolerance", "1e-10"}, {"max-iterations", "1000000000"}}),
      report);
  EXPECT_EQ(report.status, "not converged");
  ASSERT_FALSE(report.iterations.empty());
  EXPECT_LT(report.iterations[0].second, 50000);
}

TEST(AllPairs, WhatSinglePrecisionCannotHoldTakesFullPrecision) {
  PolygonSoup soup;  // beside a triangle so small that gradients in it are beyond single precision
  soup.points.resize(5, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, -1e-60, 0, 0, 0, -1e-60, 0;
  for (const auto& f : {std::array{0, 1, 2}, {0, 3, 4}, {0, 2, 3}}) soup.add_face(f);
  Symmetric options;
  options.max_iterations = 60;
  Report full, single;
  const MatX U = pairs_on(SurfaceMesh(soup), options, full);
  options.storage = Storage::single;
  EXPECT_EQ(pairs_on(SurfaceMesh(soup), options, single), U);
  const auto told = [](const Report& report) {
    return std::count_if(report.warnings.begin(), report.warnings.end(),
                         [](const Warning& w) { return w.code == "option-without-effect"; });
  };
  EXPECT_EQ(told(single), 1);
  EXPECT_EQ(told(full), 0);
}

TEST(AllPairs, AgreesWithTheAuthors) {
  LITTORAL_NEEDS_SHARED("reference/rgd/allpairs_octa2");
  const auto folder = test::shared() / "reference/rgd/allpairs_octa2";
  const SurfaceMesh mesh = test::one_based_mesh(folder);
  const MatX U = pairs_on(mesh, 0.03, 2e-4);
  MatX theirs(U.rows(), U.cols());
  std::ifstream in(folder / "U_alpha0.03.f64", std::ios::binary);
  ASSERT_TRUE(in.read(reinterpret_cast<char*>(theirs.data()),
                      static_cast<std::streamsize>(sizeof(double) * theirs.size())));
  EXPECT_LT((U - theirs).cwiseAbs().maxCoeff(), 0.02 * theirs.maxCoeff());
}

TEST(AllPairs, MemoryIsForeseen) {
  EXPECT_GE(all_pairs_memory(2000, 4000, 8), 8. * 2000 * 2000 * 8);
  Report report;
  Symmetric options;
  options.max_iterations = 2;
  pairs_on(SurfaceMesh(test::octasphere_soup(1)), options, report);
  EXPECT_EQ(report.status, "not converged");
  bool stated = false;
  for (const auto& [name, value] : report.sizes) stated |= name == "matrices, bytes" && value > 0;
  EXPECT_TRUE(stated);
  set_memory_limit(1e4);
  EXPECT_THROW(pairs_on(SurfaceMesh(test::octasphere_soup(1)), options, report), IoError);
  set_memory_limit(0);
}

TEST(PairStatistics, ExactDistanceIsAMetric) {
  const PairsAnswer exact = by_method(SurfaceMesh(test::jittered_grid_soup(6, 5, 0.3)), "exact");
  ASSERT_TRUE(exact.statistics);
  EXPECT_LT(exact.statistics->largest_asymmetry, 1e-9);
  EXPECT_LT(exact.statistics->largest_violation, 1e-9);
}

TEST(Pairs, SmoothingMakesTheTriangleInequalityHold) {
  // Figure 12, table 3: the share of violations falls as alpha grows.
  const SurfaceMesh mesh(test::octasphere_soup(2));
  double before = 1;
  for (const char* alpha : {"0.02", "0.1", "0.5"}) {
    const auto answer = by_method(mesh, "symmetric", {}, {{"alpha", alpha}});
    EXPECT_EQ(answer.statistics->largest_asymmetry, 0);
    EXPECT_LE(answer.statistics->violations, before);
    before = answer.statistics->violations;
  }
  EXPECT_LT(before, 0.01);
}

TEST(Pairs, EveryMethodGivesTheRowsOfItsSingleSolves) {
  const SurfaceMesh mesh(test::octasphere_soup(2));
  for (const MethodInfo& method : Registry<SurfaceDomain>::instance().infos()) {
    Report report;
    const MatX rows = by_method(mesh, method.name, {5, 17}).distances;
    ASSERT_EQ(rows.rows(), 2);
    const VecX alone = test::surface_distance(mesh, test::vertex_points({17}),
                                              AnyMethod::named(method.name), report);
    const double far = alone.maxCoeff();
    EXPECT_EQ(rows(1, 17), 0) << method.name;
    EXPECT_LT((rows.row(1).transpose() - alone).cwiseAbs().maxCoeff(),
              rows_within(method.name) * far)
        << method.name;
  }
}

/// The rows of two vertices, and the same from solves of their own.
void expect_rows_of_single_solves(const SurfaceDomain& domain, const AnyMethod& method) {
  Report report;
  const MatX rows = pair_distances(domain, {5, 17}, method, {}, report).distances;
  ASSERT_EQ(rows.rows(), 2);
  EXPECT_EQ(rows(1, 17), 0);
  EXPECT_EQ(report.domain, domain.kind());
  const Sources source(SurfacePoint::at_vertex(17));
  VecX alone = solve_once(method, domain, source, {}, report).values;
  alone[17] = 0;  // a mean over corners where jumps end at it
  EXPECT_LT((rows.row(1).transpose() - alone).cwiseAbs().maxCoeff(),
            rows_within(method.name()) * alone.maxCoeff());
}

class PairsOnEveryDomain : public testing::TestWithParam<test::Domain> {};

TEST_P(PairsOnEveryDomain, EveryMethodThatRunsThereGivesRows) {
  const test::Shape sphere = test::sphere(GetParam(), 8);
  const SurfaceMesh mesh(sphere.soup);
  const SurfaceDomain domain =
      domain_of(mesh, sphere.face_normals.rows() ? &sphere.face_normals : nullptr);
  int ran = 0;
  for (const MethodInfo& info : Registry<SurfaceDomain>::instance().infos()) {
    SCOPED_TRACE(info.name);
    const auto& on = info.domains;
    if (std::find(on.begin(), on.end(), domain.kind()) != on.end()) {
      expect_rows_of_single_solves(domain, AnyMethod::named(info.name));
      ++ran;
    } else {
      Report report;
      EXPECT_THROW(pair_distances(domain, {5}, AnyMethod::named(info.name), {}, report),
                   UnsupportedError);
    }
  }
  EXPECT_GE(ran, 4);
  Report report;
  if (domain.kind() != "triangle mesh") {
    EXPECT_THROW(pair_distances(domain, {5}, Symmetric{}, {}, report), UnsupportedError);
  }
}

INSTANTIATE_TEST_SUITE_P(Domains, PairsOnEveryDomain,
                         testing::Values(test::Domain::triangles, test::Domain::polygons,
                                         test::Domain::points, test::Domain::voxels));

TEST(Pairs, OptionsOfSingleSolvesWork) {
  const SurfaceMesh mesh(test::octasphere_soup(2));
  for (const AnyMethod& method : {AnyMethod(SignedHeat{.intrinsic_delaunay = true}),
                                  AnyMethod(SignedHeat{.discontinuous = true}),
                                  AnyMethod(SignedHeat{.sharpen = Sharpening::on}),
                                  AnyMethod(UnsignedHeat{.intrinsic_delaunay = true})})
    expect_rows_of_single_solves(domain_of(mesh), method);
}

TEST(Pairs, ComponentsAndStrayVertices) {
  PolygonSoup soup = test::octasphere_soup(0);
  const PolygonSoup other = test::octasphere_soup(0);
  const int n = soup.n_vertices();
  soup.points.conservativeResize(2 * n + 1, 3);
  for (int v = 0; v < n; ++v)
    soup.points.row(n + v) = other.points.row(v) + Vec3(5, 0, 0).transpose();
  soup.points.row(2 * n).setZero();
  for (int f = 0; f < other.n_faces(); ++f)
    test::add_triangle(soup, n + other.face(f)[0], n + other.face(f)[1], n + other.face(f)[2]);
  const SurfaceMesh mesh(soup);
  for (const char* method : {"symmetric", "exact", "regularized"}) {
    const MatX D = by_method(mesh, method).distances;
    for (int a = 0; a <= 2 * n; ++a)
      for (int b = 0; b <= 2 * n; ++b) {
        if (a == b)
          EXPECT_EQ(D(a, b), 0);
        else
          EXPECT_EQ(std::isfinite(D(a, b)), a < 2 * n && b < 2 * n && a / n == b / n)
              << method << " " << a << " " << b;
      }
  }
}

TEST(Pairs, ReportsTheWorstComponentAndEach) {
  PolygonSoup soup = test::octasphere_soup(1);
  const PolygonSoup other = test::jittered_grid_soup(3, 3, 0.2);
  const int n = soup.n_vertices();
  soup.points.conservativeResize(n + other.n_vertices() + 1, 3);
  for (int v = 0; v < other.n_vertices(); ++v)
    soup.points.row(n + v) = 1e-3 * other.points.row(v) + Vec3(5, 0, 0).transpose();
  for (int f = 0; f < other.n_faces(); ++f)
    test::add_triangle(soup, n + other.face(f)[0], n + other.face(f)[1], n + other.face(f)[2]);
  const int stray = n + other.n_vertices();
  soup.points.row(stray) << 9, 9, 9;
  test::add_triangle(soup, stray, stray, stray);  // no triangle, and no reason to refuse the rest
  Report report;
  test::pair_distances(SurfaceMesh(soup), {}, AnyMethod::named("symmetric", {}), report);
  const auto value = [&](const std::string& name) {
    for (const auto& [key, number] : report.residuals)
      if (key == name) return number;
    return -1.0;
  };
  const std::string name = "all pairs, over what is compared";
  const double first = value(name + ", component 0"), second = value(name + ", component 1");
  EXPECT_GT(first, 0);
  EXPECT_GT(second, 0);
  EXPECT_EQ(value(name), std::max(first, second));
  EXPECT_EQ(report.status, "converged");
}

TEST(Pairs, BadRequestsSayWhatIsWrong) {
  const SurfaceMesh mesh(test::octasphere_soup(0));
  EXPECT_THROW(by_method(mesh, "nonsense"), InputError);
  EXPECT_THROW(by_method(mesh, "symmetric", {6}), InputError);
  EXPECT_THROW(by_method(mesh, "symmetric", {-1}), InputError);
  EXPECT_THROW(by_method(mesh, "symmetric", {}, {{"alpha", "-1"}}), InputError);
  EXPECT_THROW(by_method(mesh, "symmetric", {}, {{"beta", "1"}}), InputError);
  EXPECT_THROW(by_method(mesh, "exact", {}, {{"alpha", "1"}}), InputError);
}

}  // namespace
}  // namespace littoral
