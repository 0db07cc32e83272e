// Winding numbers on intrinsic Delaunay triangles that keep the edges of the curve.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
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

/// n x m quads in the plane, sheared to needles.
SurfaceMesh sheared_grid(int n, int m, double by) {
  PolygonSoup soup = test::grid_soup(n, m, 1);
  soup.points.col(0) += by * soup.points.col(1);
  return SurfaceMesh(soup);
}

TEST(DelaunayWinding, OfCurvesThroughFacesRegionsStay) {
  const SurfaceMesh mesh = sheared_grid(24, 24, 3);
  Sources sources;
  MatX3 ring(61, 3);
  const Vec3 middle(2, 0.5, 0);
  for (int i = 0; i <= 60; ++i) {
    const double a = 2 * winding_pi * (i % 60) / 60;
    ring.row(i) = middle + 0.3 * Vec3(std::cos(a), std::sin(a), 0);
  }
  sources.space_curves.push_back({ring, true, "ring"});
  Report report;
  const WindingAnswer plain = test::surface_winding(mesh, sources),
                      better = test::surface_winding(
                          mesh, sources, SurfaceWinding{.intrinsic_delaunay = true}, report);
  EXPECT_GT(flips_of(report), 100);
  EXPECT_EQ(better.numbers.region, plain.numbers.region);
  EXPECT_LT(wrong_jump(better.cut.mesh, better), 1e-9);
  const SurfaceMesh& cut = better.cut.mesh;
  for (int f = 0; f < cut.n_faces(); ++f) {
    const auto c = cut.face(f);
    const Vec3 at = (cut.point(c[0]) + cut.point(c[1]) + cut.point(c[2])) / 3;
    if (std::abs((at - middle).norm() - 0.3) < 0.01) continue;
    const int t = better.triangle_of_face[f];
    EXPECT_EQ(better.numbers.region[t], (at - middle).norm() < 0.3 ? 1 : 0);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(better.numbers.w.u(t, k), better.numbers.region[t], 1e-8);
  }
}

/// The unit disk, its vertices turned about the middle the further the further out: needles.
SurfaceMesh wound_disk(int n, double turn) {
  PolygonSoup soup = test::grid_soup(n, n, 1);
  for (auto p : soup.points.rowwise()) {
    const double x = 2 * p[0] - 1, y = 2 * p[1] - 1, r = std::max(std::abs(x), std::abs(y));
    const double a = std::atan2(y, x) + turn * r;
    p << r * std::cos(a), r * std::sin(a), 0;
  }
  return SurfaceMesh(soup);
}

TEST(DelaunayWinding, WithAFreeBoundaryItIsNearTheAngle) {
  const int n = 32;
  const SurfaceMesh mesh = wound_disk(n, 2.5);
  std::vector<int> line;
  for (int j = 10; j <= 20; ++j) line.push_back(j * (n + 1) + 13);
  std::vector<char> on_line(static_cast<std::size_t>(mesh.n_vertices()), 0);
  for (const int v : line) on_line[v] = 1;
  // RMS difference from the angle under which the line is seen, up to a constant.
  const auto error = [&](BoundaryCondition boundary, bool delaunay) {
    Report report;
    const WindingAnswer answer = test::surface_winding(
        mesh, through(line),
        SurfaceWinding{.boundary_condition = boundary, .intrinsic_delaunay = delaunay}, report);
    if (delaunay) {
      EXPECT_GT(flips_of(report), 300);
    }
    double sum = 0, squares = 0;
    int count = 0;
    for (int f = 0; f < mesh.n_faces(); ++f)
      for (int k = 0; k < 3; ++k) {
        const int v = mesh.face(f)[k];
        if (on_line[v] != 0) continue;
        double angle = 0;
        for (std::size_t i = 1; i < line.size(); ++i) {
          const Vec3 a = mesh.point(line[i - 1]) - mesh.point(v);
          const Vec3 b = mesh.point(line[i]) - mesh.point(v);
          angle += std::atan2(a.cross(b).z(), a.dot(b)) / (2 * winding_pi);
        }
        const double d = answer.numbers.w.u(f, k) - angle;
        sum += d;
        squares += d * d;
        ++count;
      }
    return std::sqrt(squares / count - sum / count * (sum / count));
  };
  const double better = error(BoundaryCondition::free, true);
  EXPECT_LT(better, 0.5 * error(BoundaryCondition::free, false));
  EXPECT_LT(better, 0.25 * error(BoundaryCondition::natural, true));
}

/// A band of n x m quads, its ends joined, turned over or not.
struct Band {
  int n, m;
  bool twisted;

  int at(int i, int j) const { return i % n * (m + 1) + (twisted && i >= n ? m - j : j); }
  SurfaceMesh mesh() const {
    PolygonSoup soup;
    soup.points.resize(n * (m + 1), 3);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= m; ++j) {
        const double a = 2 * winding_pi * i / n, half = twisted ? a / 2 : 0;
        const Vec3 out(std::cos(a), std::sin(a), 0);
        const Vec3 across = std::cos(half) * Vec3::UnitZ() + std::sin(half) * out;
        soup.points.row(at(i, j)) = 3 * out + (2.0 * j / m - 1) * across;
      }
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < m; ++j) {
        test::add_triangle(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1));
        test::add_triangle(soup, at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
    return SurfaceMesh(soup);
  }
};

TEST(DelaunayWinding, OnAMoebiusBandRegionsStay) {
  const Band band{16, 16, true};
  const SurfaceMesh mesh = band.mesh();
  // Round a patch that lies across the place where the band is joined: 6 x 5 quads.
  std::vector<int> loop;
  for (int i = band.n - 3; i < band.n + 3; ++i) loop.push_back(band.at(i, 4));
  for (int j = 4; j < 9; ++j) loop.push_back(band.at(band.n + 3, j));
  for (int i = band.n + 3; i > band.n - 3; --i) loop.push_back(band.at(i, 9));
  for (int j = 9; j >= 4; --j) loop.push_back(band.at(band.n - 3, j));
  // Once round the middle: it has one side only, which is said.
  std::vector<int> core;
  for (int i = 0; i <= band.n; ++i) core.push_back(band.at(i, band.m / 2));
  for (const std::vector<int>& curve : {loop, core}) {
    Report report, plain_report;
    const WindingAnswer plain = test::surface_winding(mesh, through(curve), {}, plain_report),
                        better = test::surface_winding(mesh, through(curve),
                                                       SurfaceWinding{.intrinsic_delaunay = true},
                                                       report);
    EXPECT_GT(flips_of(report), 100);
    EXPECT_EQ(better.region, plain.region);
    EXPECT_EQ(report.warnings.size(), plain_report.warnings.size());
    const bool is_loop = curve == loop;
    if (is_loop) {
      EXPECT_EQ(better.region.sum(), 2 * 6 * 5);
      EXPECT_EQ(better.region.cwiseAbs().sum(), 2 * 6 * 5);
    }
    const auto said =
        std::count_if(report.warnings.begin(), report.warnings.end(), [](const Warning& warning) {
          return warning.text.find("its sides exchanged") != std::string::npos;
        });
    EXPECT_EQ(said, is_loop ? 0 : 1);
  }
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
