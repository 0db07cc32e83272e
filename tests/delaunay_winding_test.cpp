// Winding numbers on intrinsic Delaunay triangles that keep the edges of the curve.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "api/surface/discretization.h"
#include "littoral/error.h"
#include "methods/winding/jump_laplace.h"
#include "one_call.h"
#include "test_meshes.h"

namespace littoral {
namespace {

constexpr double winding_pi = std::numbers::pi;

const SurfaceWinding on_delaunay{.keep_nonbounding = true, .intrinsic_delaunay = true};
const SurfaceWinding as_is{.keep_nonbounding = true};

double flips_of(const Report& report) {
  for (const auto& [name, value] : report.sizes)
    if (name == "intrinsic_flips") return value;
  return -1;
}

/// Largest difference between the jumps of the solution and the curve.
double wrong_jump(const SurfaceMesh& mesh, const WindingAnswer& answer) {
  Report report;
  const JumpSurface on(mesh, report);
  return (jump_derivative(*on.J, answer.numbers.u.u) - answer.numbers.curve).cwiseAbs().maxCoeff();
}

Sources through(std::vector<int> vertices) {
  Curve curve;
  for (const int v : vertices) curve.nodes.push_back(SurfacePoint::at_vertex(v));
  return Sources().add(std::move(curve));
}

/// A ring 1 <= r <= 2 whose columns of vertices wind round it: needles.
struct WoundRing {
  static constexpr int columns = 96, rows = 24;
  static constexpr double turn = 1.5;  // radians from the inner circle to the outer

  SurfaceMesh mesh{[] {
    PolygonSoup soup;
    soup.points.resize(columns * (rows + 1), 3);
    for (int i = 0; i <= rows; ++i)
      for (int j = 0; j < columns; ++j) {
        const double r = 1 + double(i) / rows, a = angle(i, j);
        soup.points.row(i * columns + j) << r * std::cos(a), r * std::sin(a), 0;
      }
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) {
        const int l = (j + 1) % columns, a = i * columns + j, b = i * columns + l;
        test::add_triangle(soup, a, a + columns, b + columns);
        test::add_triangle(soup, a, b + columns, b);
      }
    return soup;
  }()};

  static double angle(int i, int j) { return 2 * winding_pi * j / columns + turn * i / rows; }

  /// Outwards along a column.
  static Sources column(int j) {
    std::vector<int> vertices;
    for (int i = 0; i <= rows; ++i) vertices.push_back(i * columns + j);
    return through(vertices);
  }
  /// Largest deviation from the angle, counted from the column on, over a full turn.
  double error(const WindingAnswer& answer) const {
    double low = 1e300, high = -1e300;
    for (int f = 0; f < mesh.n_faces(); ++f)
      for (int k = 0; k < 3; ++k) {
        const int v = mesh.face(f)[k], i = v / columns;
        int j = v % columns;
        const int first = mesh.face(f)[0] % columns;
        if (j == 0 && first == columns - 1) j = columns;  // the end of the last column of quads
        const double deviation = answer.numbers.u.u(f, k) + angle(i, j) / (2 * winding_pi);
        low = std::min(low, deviation);
        high = std::max(high, deviation);
      }
    return 0.5 * (high - low);
  }
};

TEST(DelaunayWinding, TheAngleRoundARingOfNeedles) {
  // Harmonic, level across no boundary, and it jumps by one turn at a cut from circle to circle.
  const WoundRing ring;
  Report report;
  const double plain = ring.error(test::surface_winding(ring.mesh, WoundRing::column(0), as_is)),
               better = ring.error(
                   test::surface_winding(ring.mesh, WoundRing::column(0), on_delaunay, report));
  EXPECT_GT(flips_of(report), 1000);
  EXPECT_LT(better, 2e-3);
  EXPECT_LT(better, 0.25 * plain);
}

TEST(DelaunayWinding, JumpsAreTheCurvesAndRegionsStay) {
  const WoundRing ring;
  const Sources reversed = WoundRing::column(5).reversed();
  EXPECT_LT(wrong_jump(ring.mesh, test::surface_winding(ring.mesh, reversed, on_delaunay)), 1e-12);
  // Round four columns of the ring's inner half: integers, whatever the triangles.
  std::vector<int> loop;
  const auto at = [](int i, int j) { return i * WoundRing::columns + j; };
  for (int i = 2; i < 12; ++i) loop.push_back(at(i, 30));
  for (int j = 30; j < 34; ++j) loop.push_back(at(12, j));
  for (int i = 12; i > 2; --i) loop.push_back(at(i, 34));
  for (int j = 34; j >= 30; --j) loop.push_back(at(2, j));
  const WindingAnswer plain = test::surface_winding(ring.mesh, through(loop)),
                      better = test::surface_winding(ring.mesh, through(loop),
                                                     SurfaceWinding{.intrinsic_delaunay = true});
  EXPECT_EQ(better.region, plain.region);
  EXPECT_EQ(better.region.cwiseAbs().sum(), 2 * 10 * 4);
  EXPECT_LT((better.numbers.w.u - plain.numbers.w.u).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(DelaunayWinding, ADelaunayMeshGivesTheSame) {
  Report report;
  const SurfaceMesh square(test::grid_soup(8, 8, 1));
  const Sources one = through({30, 31, 32, 41});
  const WindingAnswer a = test::surface_winding(square, one, as_is),
                      b = test::surface_winding(square, one, on_delaunay, report);
  EXPECT_EQ(flips_of(report), 0);
  EXPECT_LT((a.numbers.u.u - b.numbers.u.u).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(DelaunayWinding, WhereFansTouchAndFacesAreFlipped) {
  // Two needled grids that share one vertex, and every third face written the other way round.
  PolygonSoup soup = test::jittered_grid_soup(20, 4, 0.2);
  for (int v = 0; v < soup.n_vertices(); ++v) soup.points(v, 0) += 2.5 * soup.points(v, 1);
  const int n = soup.n_vertices(), faces = soup.n_faces();
  const SurfaceMesh first(soup);
  soup.points.conservativeResize(2 * n, 3);
  const int shared = 2 * 21 + 10;  // inside the first, a corner of the second
  for (int v = 0; v < n; ++v)
    soup.points.row(n + v) = soup.points.row(shared) + soup.points.row(v) - soup.points.row(0);
  for (int f = 0; f < faces; ++f) {
    const auto c = first.face(f);
    const auto there = [&](int v) { return v == 0 ? shared : n + v; };
    test::add_triangle(soup, there(c[0]), there(c[1]), there(c[2]));
  }
  for (int f = 0; f < soup.n_faces(); f += 3)
    std::swap(soup.corners[3 * f], soup.corners[3 * f + 1]);
  const SurfaceMesh mesh(soup);
  std::vector<int> row(21);  // of the first, from side to side
  std::iota(row.begin(), row.end(), shared - 10);
  const Sources sources = through(row);
  Report report;
  const WindingAnswer answer = test::surface_winding(mesh, sources, on_delaunay, report);
  EXPECT_GT(flips_of(report), 20);
  EXPECT_LT(wrong_jump(mesh, answer), 1e-12);
}

TEST(DelaunayWinding, OtherFormulationsRefuseIt) {
  const WoundRing ring;
  for (const Formulation formulation : {Formulation::dual, Formulation::nonconforming})
    EXPECT_THROW(test::surface_winding(
                     ring.mesh, WoundRing::column(0),
                     SurfaceWinding{.formulation = formulation, .intrinsic_delaunay = true}),
                 UnsupportedError);
}

}  // namespace
}  // namespace littoral
