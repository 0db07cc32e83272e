// Domains and sources that programs usually do not survive, and the far field.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "constants.h"
#include "heat_helpers.h"
#include "io/read.h"
#include "littoral/error.h"
#include "one_call.h"
#include "shared_data.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::infinity;

void append(PolygonSoup& soup, const PolygonSoup& more, const Vec3& shift) {
  const int n = soup.n_vertices();
  soup.points.conservativeResize(n + more.n_vertices(), 3);
  soup.points.bottomRows(more.n_vertices()) = more.points.rowwise() + shift.transpose();
  for (int f = 0; f < more.n_faces(); ++f) {
    const auto c = more.face(f);
    test::add_triangle(soup, c[0] + n, c[1] + n, c[2] + n);
  }
}

bool finite_or_infinite(const VecX& phi) {
  return std::all_of(phi.begin(), phi.end(),
                     [](double v) { return std::isfinite(v) || v == infinity; });
}

Curve vertex_curve(std::initializer_list<int> vertices, bool is_signed = true) {
  Curve curve;
  for (int v : vertices) curve.nodes.push_back(SurfacePoint::at_vertex(v));
  curve.is_signed = is_signed;
  return curve;
}

MatX3 segment(double x0, double y0, double x1, double y1) {
  MatX3 line(2, 3);
  line << x0, y0, 0, x1, y1, 0;
  return line;
}

SignedHeat zero_set(double time_scale = 1) { return {time_scale, Constraint::zero_set}; }

TEST(HeatDomains, BookOfThreePages) {
  // Three unit squares glued along x = 0: distance to the spine is the distance in each page.
  const int n = 16;
  PolygonSoup page = test::grid_soup(n, n, 1), book = page;
  for (int k : {1, 2}) {
    const double a = k * 2 * std::acos(-0.5) / 2;
    const int base = book.n_vertices();
    std::vector<int> name(page.n_vertices());
    book.points.conservativeResize(base + n * (n + 1), 3);
    int next = base;
    for (int v = 0; v < page.n_vertices(); ++v) {
      if (v % (n + 1) == 0) {
        name[v] = v;
        continue;
      }
      const Vec3 p = page.points.row(v);
      book.points.row(next) << p.x() * std::cos(a), p.y(), p.x() * std::sin(a);
      name[v] = next++;
    }
    for (int f = 0; f < page.n_faces(); ++f) {
      const auto c = page.face(f);
      test::add_triangle(book, name[c[0]], name[c[1]], name[c[2]]);
    }
  }
  const SurfaceMesh mesh(book);
  Sources sources;
  sources.curves.push_back(vertex_curve({0, n * (n + 1)}, false));
  Report report;
  const VecX u = test::unsigned_heat(mesh, sources, report);
  for (int v = 0; v < mesh.n_vertices(); ++v)
    EXPECT_NEAR(u[v], std::hypot(mesh.point(v).x(), mesh.point(v).z()), 0.03);
}

TEST(HeatDomains, DistanceContinuesAcrossASharedVertex) {
  // Two squares sharing the corner (1, 1) only; the source is a point in the first.
  const int n = 12;
  const PolygonSoup square = test::grid_soup(n, n, 1);
  PolygonSoup soup = square;
  const int shared = square.n_vertices() - 1, base = square.n_vertices();
  soup.points.conservativeResize(2 * base - 1, 3);
  for (int v = 1; v < base; ++v)
    soup.points.row(base + v - 1) = square.points.row(v) + Eigen::RowVector3d(1, 1, 0);
  auto name = [&](int v) { return v == 0 ? shared : base + v - 1; };
  for (int f = 0; f < square.n_faces(); ++f) {
    const auto c = square.face(f);
    test::add_triangle(soup, name(c[0]), name(c[1]), name(c[2]));
  }
  const SurfaceMesh mesh(soup);
  Report report;
  const VecX phi = test::signed_heat(mesh, test::vertex_points({0}), zero_set(16), report);
  ASSERT_TRUE(phi.allFinite());
  for (int v = base; v < mesh.n_vertices(); ++v) {
    const Vec3 p = mesh.point(v);
    const double exact = std::sqrt(2.0) + std::hypot(p.x() - 1, p.y() - 1);
    EXPECT_NEAR(phi[v], exact, 0.2);
  }
}

TEST(HeatDomains, ComponentsWithoutASourceAreInfiniteAndListed) {
  PolygonSoup soup = test::octasphere_soup(2);
  const int n = soup.n_vertices();
  append(soup, test::octasphere_soup(1), Vec3(5, 0, 0));
  const SurfaceMesh mesh(soup);
  for (bool is_signed : {true, false}) {
    Report report;
    const auto sources = test::vertex_points({0});
    const VecX phi = is_signed ? test::signed_heat(mesh, sources, zero_set(16), report)
                               : test::unsigned_heat(mesh, sources, report);
    EXPECT_TRUE(phi.head(n).allFinite());
    for (int v = n; v < mesh.n_vertices(); ++v) EXPECT_EQ(phi[v], infinity);
    EXPECT_THAT(report.unreachable_components, testing::ElementsAre(1));
  }
}

TEST(HeatDomains, DegenerateAndRepeatedFacesDoNotMatterMuch) {
  const PolygonSoup clean = test::grid_soup(12, 12, 1);
  PolygonSoup broken = clean;
  test::add_triangle(broken, 0, 1, 2);   // collinear
  test::add_triangle(broken, 5, 5, 30);  // repeats a vertex
  test::add_triangle(broken, 60, 61, 61);
  const auto first = clean.face(100);
  test::add_triangle(broken, first[0], first[1], first[2]);  // the same face twice
  const auto line = test::space_curve(segment(0.4, 0, 0.4, 1));
  Report report;
  const VecX phi = test::signed_heat(SurfaceMesh(clean), line, zero_set(), report);
  const VecX psi = test::signed_heat(SurfaceMesh(broken), line, zero_set(), report);
  ASSERT_TRUE(psi.allFinite());
  EXPECT_LE((phi - psi).cwiseAbs().maxCoeff(), 0.05);
}

TEST(HeatDomains, PolygonsThatComeBackToACornerAreCut) {
  PolygonSoup soup;  // two squares, and on the diagonal of one a flap out to vertex 6 and back
  soup.points.resize(7, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0, 0.5, 0.5, 1;
  soup.add_face(std::vector<int>{0, 1, 2, 3});
  soup.add_face(std::vector<int>{1, 4, 5, 2});
  PolygonSoup cut = soup;
  soup.add_face(std::vector<int>{0, 6, 2, 6});
  test::add_triangle(cut, 0, 6, 2);
  test::add_triangle(cut, 0, 2, 6);
  const auto source = test::vertex_points({0});
  Report report, ignored;
  const VecX phi = test::surface_distance(SurfaceMesh(soup), source, UnsignedHeat{}, report);
  EXPECT_TRUE(phi.allFinite());
  const VecX same = test::surface_distance(SurfaceMesh(cut), source, UnsignedHeat{}, ignored);
  EXPECT_LT((phi - same).norm(), 0.02);  // its mean edge, and so the time, is not quite the same
  EXPECT_EQ(std::ranges::count(report.warnings, "polygons-cut", &Warning::code), 1);
  EXPECT_TRUE(test::surface_distance(SurfaceMesh(soup), source, SignedHeat{}, ignored).allFinite());
}

TEST(HeatDomains, ACurveAndItsReverseCancel) {
  const SurfaceMesh mesh(test::grid_soup(8, 8));
  Sources sources;
  sources.curves.push_back(vertex_curve({36, 37, 38, 39}));
  sources.curves.push_back(vertex_curve({39, 38, 37, 36}));
  Report report;
  const VecX phi = test::signed_heat(mesh, sources, zero_set(), report);
  EXPECT_LE(phi.cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_FALSE(report.warnings.empty());
}

TEST(HeatDomains, ACurveDrawnTwiceIsTheCurve) {
  const SurfaceMesh mesh(test::jittered_grid_soup(12, 12, 0.3));
  Sources once = test::space_curve(segment(0.3, 0.2, 0.6, 0.8)), twice = once;
  twice.space_curves.push_back(once.space_curves[0]);
  Report report;
  const VecX phi = test::signed_heat(mesh, once, zero_set(), report);
  const VecX psi = test::signed_heat(mesh, twice, zero_set(), report);
  EXPECT_LE((phi - psi).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(HeatDomains, CrossingAndMixedSourcesStayFinite) {
  const SurfaceMesh mesh(test::jittered_grid_soup(14, 14, 0.3));
  Sources sources = test::space_curve(segment(0.1, 0.1, 0.9, 0.85));
  sources.space_curves.push_back({segment(0.1, 0.9, 0.9, 0.12), true, "test"});
  sources.space_curves.push_back({segment(0.5, 0.05, 0.8, 0.1), false, "test"});
  sources.space_curves.push_back({test::circle(0.2, 0.5, 0, 0.1, 32), true, "test"});
  sources.points.push_back(SurfacePoint::in_face(3, 0.2, 0.3, 0.5));
  for (Constraint c : {Constraint::none, Constraint::zero_set, Constraint::level_sets}) {
    Report report;
    const VecX phi = test::signed_heat(mesh, sources, {1, c}, report);
    EXPECT_TRUE(phi.allFinite());
    EXPECT_LE(phi.cwiseAbs().maxCoeff(), 2);
  }
  Report report;
  const VecX u = test::unsigned_heat(mesh, sources, report);
  EXPECT_TRUE(u.allFinite());
  EXPECT_GE(u.minCoeff(), 0);
}

TEST(HeatDomains, PointsAtVerticesOnEdgesAndInFacesAgree) {
  const SurfaceMesh mesh(test::grid_soup(24, 24, 1));
  Report report;
  for (const SurfacePoint& p :
       {SurfacePoint::at_vertex(12 + 12 * 25), SurfacePoint::on_edge(mesh.find_edge(312, 313), 0.4),
        SurfacePoint::in_face(600, 0.3, 0.3, 0.4)}) {
    Sources sources;
    sources.points.push_back(p);
    const Vec3 at = mesh.position(p);
    const VecX phi = test::signed_heat(mesh, sources, zero_set(16), report);
    const VecX u = test::unsigned_heat(mesh, sources, report);
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      EXPECT_NEAR(phi[v], (mesh.point(v) - at).norm(), 0.12);
      EXPECT_NEAR(u[v], (mesh.point(v) - at).norm(), 0.08);
    }
  }
}

TEST(HeatDomains, UnsignedCurvesInsideFacesAndAlongEdgesAgree) {
  const SurfaceMesh mesh(test::grid_soup(24, 24, 1));
  Report report;
  for (double x : {0.5, 0.5 + 0.4 / 24}) {  // along edges; through faces
    const auto line = test::space_curve(segment(x, 0, x, 1), false);
    const VecX phi = test::signed_heat(mesh, line, zero_set(), report);
    for (int v = 0; v < mesh.n_vertices(); ++v)
      EXPECT_NEAR(phi[v], std::abs(mesh.point(v).x() - x), 0.06);
  }
}

TEST(HeatDomainsSlow, FarEndOfAStrip) {
  // 4000 cells long: e^-4000 is far below the smallest double.
  PolygonSoup strip = test::grid_soup(4000, 2);
  strip.points.col(0) *= 4000;
  strip.points.col(1) *= 2;
  const SurfaceMesh mesh(strip);
  Sources sources;
  sources.curves.push_back(vertex_curve({4001 * 2, 4001, 0}));  // down the left end: phi = x
  Report report;
  const VecX phi = test::signed_heat(mesh, sources, zero_set(), report);
  const VecX u = test::unsigned_heat(mesh, sources, report);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const double x = mesh.point(v).x();
    ASSERT_NEAR(phi[v], x, 0.01 * x + 1);
    ASSERT_NEAR(u[v], x, 0.01 * x + 1);
  }
}

TEST(HeatDomainsSlow, BrokenMeshesGiveDistancesOrTypedErrors) {
  LITTORAL_NEEDS_SHARED("data/generated");
  int solved = 0;
  for (const char* folder : {"geometry", "analytic"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(test::shared() / "data/generated" / folder)) {
      if (entry.path().extension() != ".obj") continue;
      SCOPED_TRACE(entry.path().filename());
      try {
        const SurfaceMesh mesh(io::read_surface(entry.path()));
        if (!mesh.is_triangle_mesh() || mesh.n_faces() == 0 || mesh.n_faces() > 20000) continue;
        const Sources sources = test::vertex_points({mesh.face(mesh.n_faces() / 2)[0]});
        Report report;
        EXPECT_TRUE(finite_or_infinite(test::signed_heat(mesh, sources, zero_set(16), report)));
        EXPECT_TRUE(finite_or_infinite(test::unsigned_heat(mesh, sources, report)));
        ++solved;
      } catch (const Error& error) {
        EXPECT_STRNE(error.what(), "");
      }
    }
  }
  EXPECT_GT(solved, 30);
}

}  // namespace
}  // namespace littoral
