// Distances from many points at once are those from one at a time.

#include "methods/heat/heat_strips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "api/solve_many.h"
#include "api/surface/pairs.h"
#include "base/parallel.h"
#include "base/platform/memory.h"
#include "domain_shapes.h"
#include "littoral/error.h"
#include "methods/heat/cell_field.h"
#include "one_call.h"
#include "operators/triangles.h"
#include "subdivided_meshes.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using OnSurface = std::shared_ptr<const Solver<SurfaceDomain>>;

OnSurface prepared(const SurfaceDomain& domain, const AnyMethod& method) {
  Report report;
  return prepare(method, domain, SolveHint::many_rhs, Task(), report);
}

std::vector<SurfacePoint> vertices(const SurfaceMesh& mesh, int n) {
  std::vector<SurfacePoint> out;
  for (int i = 0; i < n; ++i)
    out.push_back(SurfacePoint::at_vertex(static_cast<int>((i * 7919L) % mesh.n_vertices())));
  return out;
}

/// Largest difference of two matrices over the largest finite entry; infinite where only one is.
double difference(const MatX& a, const MatX& b) {
  double most = 0, largest = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (a.data()[i] == b.data()[i]) continue;
    most = std::max(most, std::abs(a.data()[i] - b.data()[i]));
  }
  for (Eigen::Index i = 0; i < b.size(); ++i)
    if (std::isfinite(b.data()[i])) largest = std::max(largest, std::abs(b.data()[i]));
  return largest > 0 ? most / largest : most;
}

std::vector<Sources> each(const std::vector<SurfacePoint>& points) {
  return {points.begin(), points.end()};
}

/// How many of them the solver finds several at once.
long found_together(const OnSurface& solver, const std::vector<SurfacePoint>& points) {
  const std::vector<Sources> sources = each(points);
  std::vector<Report> reports(sources.size());
  const auto answers = solver->solve_together(sources, Task(), reports);
  return std::count_if(answers.begin(), answers.end(), [](const auto& a) { return a.has_value(); });
}

/// The matrix by both ways is the same, and the fast one was taken.
void expect_rows_of_the_loop(const SurfaceDomain& domain, const std::vector<SurfacePoint>& points,
                             const AnyMethod& method, double tolerance = 1e-10) {
  const OnSurface solver = prepared(domain, method);
  ASSERT_EQ(solver->at_once().sources, std::size_t{strip_width});
  solver->solve(Sources(points[0]), Task(), *std::make_unique<Report>());
  const auto some = std::min<std::size_t>(points.size(), strip_width);
  EXPECT_EQ(found_together(solver, {points.begin(), points.begin() + index(some)}), index(some));
  Report a, b;
  const MatX together = distance_rows(*solver, domain, points, Task(), a);
  const MatX loop = distance_rows(test::OneByOne(solver), domain, points, Task(), b);
  EXPECT_LT(difference(together, loop), tolerance);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.options, b.options);
  EXPECT_EQ(a.sizes, b.sizes);
  EXPECT_EQ(a.warnings.size(), b.warnings.size());
}

std::vector<AnyMethod> heat_methods_for_points() {
  return {UnsignedHeat{}, UnsignedHeat{.time_scale = 3}, SignedHeat{},
          SignedHeat{.constraint = Constraint::none},
          SignedHeat{.constraint = Constraint::level_sets}};
}

TEST(HeatStrips, RowsOfTheLoopOnAClosedSurface) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  for (const AnyMethod& method : heat_methods_for_points())
    expect_rows_of_the_loop(domain_of(mesh), vertices(mesh, 37), method);
}

TEST(HeatStrips, RowsOfTheLoopWithABoundary) {
  const SurfaceMesh mesh(test::jittered_grid_soup(24, 17, 0.2));
  for (const AnyMethod& method : heat_methods_for_points())
    expect_rows_of_the_loop(domain_of(mesh), vertices(mesh, 20), method);
}

TEST(HeatStrips, RowsOfTheLoopFromPointsAnywhere) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  std::vector<SurfacePoint> points = vertices(mesh, 5);
  std::mt19937 random(5);
  for (int i = 0; i < 30; ++i) {
    const int face = static_cast<int>(random() % static_cast<unsigned>(mesh.n_faces()));
    points.push_back(SurfacePoint::in_face(face, 0.6, 0.3, 0.1));
    points.push_back(SurfacePoint::on_edge(mesh.side_edge(face, 0), 0.3));
  }
  for (const AnyMethod& method : {AnyMethod(UnsignedHeat{}), AnyMethod(SignedHeat{})})
    expect_rows_of_the_loop(domain_of(mesh), points, method);
}

TEST(HeatStrips, RowsOfTheLoopThroughManyLayers) {
  // 1300 cells long: heat at time scale 1 falls over more than the range of a double, twice.
  PolygonSoup soup = test::grid_soup(1300, 4);
  soup.points.col(0) *= 1300 / 4;
  const SurfaceMesh strip(soup);
  std::vector<SurfacePoint> points = vertices(strip, 20);
  points.push_back(SurfacePoint::at_vertex(0));
  points.push_back(SurfacePoint::in_face(77, 0.2, 0.3, 0.5));
  expect_rows_of_the_loop(domain_of(strip), points, UnsignedHeat{}, 1e-8);
}

TEST(HeatStrips, RowsOfTheLoopOnBetterTriangles) {
  const SurfaceMesh mesh(test::jittered_grid_soup(16, 16, 0.4));
  expect_rows_of_the_loop(domain_of(mesh), vertices(mesh, 20),
                          UnsignedHeat{.intrinsic_delaunay = true});
  expect_rows_of_the_loop(domain_of(mesh), vertices(mesh, 20),
                          SignedHeat{.intrinsic_delaunay = true});
}

class HeatStripsOnEveryDomain : public testing::TestWithParam<test::Domain> {};

TEST_P(HeatStripsOnEveryDomain, RowsOfTheLoop) {
  const test::Shape sphere = test::sphere(GetParam(), 12);
  const SurfaceMesh mesh(sphere.soup);
  const SurfaceDomain domain =
      domain_of(mesh, sphere.face_normals.rows() ? &sphere.face_normals : nullptr);
  for (const AnyMethod& method : {AnyMethod(UnsignedHeat{}), AnyMethod(SignedHeat{})})
    expect_rows_of_the_loop(domain, vertices(mesh, 20), method);
}

INSTANTIATE_TEST_SUITE_P(Domains, HeatStripsOnEveryDomain,
                         testing::Values(test::Domain::triangles, test::Domain::polygons,
                                         test::Domain::points, test::Domain::voxels));

/// Two spheres and a vertex in no face.
PolygonSoup two_spheres() {
  PolygonSoup soup = test::octasphere_soup(3);
  const PolygonSoup other = test::octasphere_soup(2);
  const int n = soup.n_vertices(), m = other.n_vertices();
  soup.points.conservativeResize(n + m + 1, 3);
  for (int v = 0; v < m; ++v)
    soup.points.row(n + v) = 1e-3 * other.points.row(v) + Vec3(5, 0, 0).transpose();
  soup.points.row(n + m).setZero();
  for (int f = 0; f < other.n_faces(); ++f)
    test::add_triangle(soup, n + other.face(f)[0], n + other.face(f)[1], n + other.face(f)[2]);
  return soup;
}

TEST(HeatStrips, ComponentsWithoutTheSourceAreInfinite) {
  const SurfaceMesh mesh(two_spheres());
  const std::vector<SurfacePoint> points = vertices(mesh, 60);
  std::vector<SurfacePoint> in_faces = points;
  std::erase_if(in_faces,
                [&](const SurfacePoint& p) { return mesh.vertex_component()[p.element] < 0; });
  expect_rows_of_the_loop(domain_of(mesh), in_faces, UnsignedHeat{});
  Report report;
  std::vector<int> all;
  for (int v = 0; v < mesh.n_vertices(); ++v) all.push_back(v);
  const MatX D = test::pair_distances(mesh, all, UnsignedHeat{}, report).distances;
  const auto component = mesh.vertex_component();
  for (int a = 0; a < D.rows(); ++a)
    for (int b = 0; b < D.cols(); ++b)
      EXPECT_EQ(std::isfinite(D(a, b)),
                a == b || (component[a] >= 0 && component[a] == component[b]))
          << a << " " << b;
}

/// The report of each of many solves says what its own solve says. Returns how many time scales
/// were raised.
int expect_reports_of_single_solves(const OnSurface& solver,
                                    const std::vector<SurfacePoint>& points) {
  const std::vector<Sources> sources = each(points);
  std::vector<Report> of(sources.size());
  solve_many<SurfaceDomain>(*solver, sources, 0, Task(),
                            [&](std::size_t first, std::vector<Solved<SurfaceDomain>>& some) {
                              for (std::size_t i = 0; i < some.size(); ++i)
                                of[first + i] = some[i].report;
                            });
  int raised = 0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    Report alone;
    solver->solve(sources[i], Task(), alone);
    EXPECT_EQ(of[i].method, alone.method);
    EXPECT_EQ(of[i].domain, alone.domain);
    EXPECT_EQ(of[i].status, alone.status);
    EXPECT_EQ(of[i].options, alone.options);
    EXPECT_EQ(of[i].sizes, alone.sizes);
    EXPECT_EQ(of[i].iterations, alone.iterations);
    EXPECT_EQ(of[i].unreachable_components, alone.unreachable_components);
    EXPECT_EQ(of[i].warnings.size(), alone.warnings.size());
    for (std::size_t w = 0; w < std::min(of[i].warnings.size(), alone.warnings.size()); ++w) {
      EXPECT_EQ(of[i].warnings[w].text, alone.warnings[w].text);
      raised += alone.warnings[w].code == "time-scale-raised";
    }
    EXPECT_EQ(of[i].residuals.size(), alone.residuals.size());
    for (std::size_t r = 0; r < std::min(of[i].residuals.size(), alone.residuals.size()); ++r) {
      EXPECT_EQ(of[i].residuals[r].first, alone.residuals[r].first);
      EXPECT_NEAR(of[i].residuals[r].second, alone.residuals[r].second, 1e-9);
    }
  }
  return raised;
}

TEST(HeatStrips, KernelsGiveTheSameBitsOnAnyProcessor) {
  Report report;
  const SurfaceMesh mesh(test::jittered_grid_soup(13, 9, 0.3));
  const Operators ops = triangle_operators(intrinsic_triangulation(mesh, report));
  const Eigen::Index n = ops.scalar.M.size();
  std::vector<int> row_of(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) row_of[static_cast<std::size_t>(i)] = static_cast<int>((i * 11) % n);
  const StripCells cells(ops.scalar, row_of);
  std::vector<char> apart(cells.area.size(), 0);
  apart[5] = 1;
  std::srand(1);
  const Strip u = 1e-200 * Strip::Random(n, strip_width), phi = Strip::Random(n, strip_width);
  Strip b[2] = {phi, phi};
  std::array<double, 4 * strip_width> sums[2] = {};
  for (int k = 0; k < 2; ++k) {
    const StripCellKernels& kernels = k ? strip_cell_kernels() : plain_strip_cell_kernels;
    kernels.divergence(cells, 0, cells.size(), apart.data(), u.data(), b[k].data(), sums[k].data());
    kernels.shares(cells, 0, cells.size(), apart.data(), u.data(), phi.data(),
                   sums[k].data() + strip_width);
  }
  EXPECT_EQ(b[0], b[1]);
  EXPECT_EQ(sums[0], sums[1]);
  // And what they are: column 3 by the operators themselves.
  VecX Y = -ops.scalar.G.apply([&] {
    VecX of(n);
    for (int i = 0; i < n; ++i) of[i] = 1e200 * u(row_of[static_cast<std::size_t>(i)], 3);
    return of;
  }());
  Y = normalize(Y);
  const auto left_out = std::find(cells.place.begin(), cells.place.end(), 5) - cells.place.begin();
  Y.segment<2>(2 * left_out).setZero();
  const VecX expected = ops.scalar.divergence(Y);
  for (int i = 0; i < n; ++i) {
    const int row = row_of[static_cast<std::size_t>(i)];
    EXPECT_NEAR(b[0](row, 3) - phi(row, 3), expected[i], 1e-12);
  }
}

TEST(HeatStrips, ReportsOfEachAreThoseOfSingleSolves) {
  const SurfaceMesh mesh(two_spheres());
  std::vector<SurfacePoint> points;
  for (int v = 0; v < 40; ++v) points.push_back(SurfacePoint::at_vertex(5 * v));
  for (const AnyMethod& method : {AnyMethod(UnsignedHeat{}), AnyMethod(SignedHeat{})})
    expect_reports_of_single_solves(prepared(domain_of(mesh), method), points);
}

TEST(HeatStrips, CornersOfTheOctahedronAreAsFarAsTheyAre) {
  const SurfaceMesh mesh(test::octasphere_soup(5));
  std::vector<int> corners = {0, 1, 2, 3, 4, 5};
  Report report;
  for (const AnyMethod& method : {AnyMethod(UnsignedHeat{}), AnyMethod(SignedHeat{})}) {
    const MatX D = test::pair_distances(mesh, corners, method, report).distances.leftCols(6);
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b) {
        const double right_angles = a == b ? 0 : a / 2 == b / 2 ? 2 : 1;
        EXPECT_NEAR(D(a, b), right_angles * std::numbers::pi / 2, 0.02 * std::numbers::pi);
        EXPECT_NEAR(D(a, b), D(b, a), 1e-9);  // the mesh has the symmetry of the octahedron
      }
  }
}

TEST(HeatStrips, WhatNeedsLongerDiffusionGetsIt) {
  // As in heat_time_scale_test: large obtuse cells, where scale 1 leaves wrong directions.
  PolygonSoup soup = test::octasphere_soup(3);
  soup.points.col(0) += 6 * soup.points.col(2);
  soup.points.col(2) *= 4;
  const SurfaceMesh mesh(test::quartered(test::quartered(soup)));
  const std::vector<SurfacePoint> points = vertices(mesh, 40);
  expect_rows_of_the_loop(domain_of(mesh), points, UnsignedHeat{});
  const int raised =
      expect_reports_of_single_solves(prepared(domain_of(mesh), UnsignedHeat{}), points);
  EXPECT_GT(raised, 0);
  EXPECT_EQ(expect_reports_of_single_solves(
                prepared(domain_of(mesh), UnsignedHeat{.time_scale = 1}), points),
            0);
}

TEST(HeatStrips, SourcesThatAreNotSinglePointsGoOneByOne) {
  const SurfaceMesh mesh(test::octasphere_soup(3));
  const OnSurface solver = prepared(domain_of(mesh), UnsignedHeat{});
  Sources two(SurfacePoint::at_vertex(3)), valued(SurfacePoint::at_vertex(9));
  two.points.push_back(SurfacePoint::at_vertex(60));
  valued.point_values.push_back(2);
  const std::vector<Sources> sources = {two, Sources(SurfacePoint::at_vertex(7)), valued};
  std::vector<VecX> values(sources.size());
  solve_many<SurfaceDomain>(*solver, sources, 0, Task(),
                            [&](std::size_t first, std::vector<Solved<SurfaceDomain>>& some) {
                              for (std::size_t i = 0; i < some.size(); ++i)
                                values[first + i] = some[i].answer.values;
                            });
  for (std::size_t i = 0; i < sources.size(); ++i) {
    Report report;
    EXPECT_LT((values[i] - solver->solve(sources[i], Task(), report).values).cwiseAbs().maxCoeff(),
              1e-10);
  }
}

TEST(HeatStrips, SameBitsOnAnyNumberOfThreads) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  const SurfaceDomain domain = domain_of(mesh);
  const OnSurface solver = prepared(domain, UnsignedHeat{});
  Report report;
  MatX of[2];
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    of[threads / 3] = distance_rows(*solver, domain, vertices(mesh, 90), Task(), report);
  }
  set_thread_count(0);
  EXPECT_EQ(of[0], of[1]);
}

TEST(HeatStrips, NothingGivenIsNothingFound) {
  const SurfaceMesh mesh(test::octasphere_soup(2));
  Report report;
  const MatX none = distance_rows(*prepared(domain_of(mesh), UnsignedHeat{}), domain_of(mesh), {},
                                  Task(), report);
  EXPECT_EQ(none.rows(), 0);
  EXPECT_EQ(none.cols(), mesh.n_vertices());
}

TEST(HeatStrips, StopsBetweenAndInsideStrips) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  const SurfaceDomain domain = domain_of(mesh);
  const OnSurface solver = prepared(domain, UnsignedHeat{});
  Report report;
  const CancelToken cancel;
  int calls = 0;
  const Task stopped(cancel, [&](double fraction, const std::string&) {
    if (fraction > 0.3) cancel.cancel();
    ++calls;
  });
  EXPECT_THROW(distance_rows(*solver, domain, vertices(mesh, 200), stopped, report), Cancelled);
  EXPECT_GT(calls, 2);
  const std::vector<Sources> sources = each(vertices(mesh, strip_width));
  std::vector<Report> reports(sources.size());
  EXPECT_THROW(solver->solve_together(sources, Task(cancel), reports), Cancelled);
}

TEST(HeatStrips, OneByOneWhereThereIsNoMemoryForMore) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  const SurfaceDomain domain = domain_of(mesh);
  const OnSurface solver = prepared(domain, UnsignedHeat{});
  const std::vector<SurfacePoint> points = vertices(mesh, 40);
  Report report;
  const MatX free = distance_rows(*solver, domain, points, Task(), report);
  const double matrix = 8.0 * double(free.size()), strip = solver->at_once().bytes;
  const MatX loop = distance_rows(test::OneByOne(solver), domain, points, Task(), report);
  for (const double room : {0.5, 1.5, 2.5}) {
    set_memory_limit(matrix + room * strip);
    EXPECT_EQ(distance_rows(*solver, domain, points, Task(), report), room < 1 ? loop : free);
  }
  set_memory_limit(0.9 * matrix);
  EXPECT_THROW(distance_rows(*solver, domain, points, Task(), report), IoError);
  set_memory_limit(0);
}

}  // namespace
}  // namespace littoral
