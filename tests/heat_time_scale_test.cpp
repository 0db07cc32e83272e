// Directions far from the source on meshes of large obtuse cells: what goes wrong there is noticed,
// and a longer diffusion puts it right.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "api/surface/beside_marching.h"
#include "base/parallel.h"
#include "heat_helpers.h"
#include "methods/geodesic/exact_polyhedral.h"
#include "methods/geodesic/fast_marching.h"
#include "methods/heat/discontinuous.h"
#include "methods/heat/time_scale.h"
#include "one_call.h"
#include "operators/jump_calculus.h"
#include "sources/surface/triangle_sources.h"
#include "subdivided_meshes.h"

namespace littoral {
namespace {

/// A sphere, stretched and sheared so that many of its large triangles are obtuse.
PolygonSoup sheared_ellipsoid() {
  PolygonSoup soup = test::octasphere_soup(3);
  soup.points.col(0) += 6 * soup.points.col(2);
  soup.points.col(2) *= 4;
  return soup;
}

/// Each triangle in 16.
SurfaceMesh refined(const PolygonSoup& soup, std::vector<int>* curve = nullptr) {
  return SurfaceMesh(test::quartered(test::quartered(soup, curve), curve));
}

VecX exact(const SurfaceMesh& mesh, const Sources& sources) {
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  return exact_polyhedral(T, triangle_sources(mesh, T, place_sources(mesh, sources, report)), {},
                          report)
      .distance;
}

/// Mean error over the largest distance.
double mean_error(const VecX& phi, const VecX& truth) {
  return (phi.cwiseAbs() - truth).cwiseAbs().mean() / truth.maxCoeff();
}

bool raised(const Report& report) {
  return std::any_of(report.warnings.begin(), report.warnings.end(),
                     [](const std::string& w) { return w.find("raised") != std::string::npos; });
}

std::string used(const Report& report, const std::string& option) {
  for (const auto& [name, value] : report.options)
    if (name == option) return value;
  return "";
}

constexpr int pole = 4;  // a vertex of the octasphere

TEST(HeatTimeScale, RisesWhereLargeObtuseCellsNeedIt) {
  const SurfaceMesh mesh = refined(sheared_ellipsoid());
  const Sources sources = test::vertex_points({pole});
  const VecX truth = exact(mesh, sources);
  for (const char* method : {"signed-heat", "unsigned-heat"}) {
    SCOPED_TRACE(method);
    Report given, chosen;
    const std::string small = method == std::string("signed-heat") ? "16" : "1";
    const VecX wrong = test::surface_distance(
        mesh, sources, AnyMethod::named(method, {{"time-scale", small}}), given);
    const VecX right = test::surface_distance(mesh, sources, AnyMethod::named(method), chosen);
    EXPECT_GT(mean_error(wrong, truth), 0.2);
    EXPECT_LT(mean_error(right, truth), 0.02);
    EXPECT_GT(misaligned_fraction(given), tolerable_share);
    EXPECT_LT(misaligned_fraction(chosen), tolerable_share);
    EXPECT_FALSE(raised(given));
    EXPECT_FALSE(given.warnings.empty());
    EXPECT_TRUE(raised(chosen));
    EXPECT_GT(std::stod(used(chosen, "time-scale")), std::stod(small));
  }
}

TEST(HeatTimeScale, RisesForCurvesToo) {
  const PolygonSoup coarse = sheared_ellipsoid();
  const VecX from_pole = exact(SurfaceMesh(coarse), test::vertex_points({pole}));
  std::vector<int> loop = test::loop_at(coarse, from_pole, 0.15 * from_pole.maxCoeff());
  const SurfaceMesh mesh = refined(coarse, &loop);
  Sources sources;
  Curve curve;
  for (int v : loop) curve.nodes.push_back(SurfacePoint::at_vertex(v));
  sources.curves.push_back(curve);
  const VecX truth = exact(mesh, sources);
  Report given, chosen;
  const VecX wrong = test::surface_distance(mesh, sources, SignedHeat{.time_scale = 1}, given);
  const VecX right = test::surface_distance(mesh, sources, SignedHeat{}, chosen);
  EXPECT_GT(mean_error(wrong, truth), 0.2);
  EXPECT_LT(mean_error(right, truth), 0.02);
  EXPECT_TRUE(raised(chosen));
}

TEST(HeatTimeScale, StaysWhereCellsAreEven) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  Report report;
  test::surface_distance(mesh, test::vertex_points({pole}), SignedHeat{}, report);
  EXPECT_LT(misaligned_fraction(report), tolerable_share);
  EXPECT_EQ(used(report, "time-scale"), "16");
  EXPECT_TRUE(report.warnings.empty());
}

TEST(HeatTimeScale, ShareOfCellsAgainstTheirDirections) {
  const SurfaceMesh mesh(test::grid_soup(4, 4));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const Calculus C = triangle_operators(T).scalar;
  const VecX x = mesh.points().col(0) / T.unit;
  VecX Y = C.G.apply(x);
  EXPECT_EQ(misaligned_fraction(C, x, Y), 0);
  EXPECT_EQ(misaligned_fraction(C, -x, Y), 1);
  Y.segment<2>(0) *= -1;  // one of 32 equal cells
  EXPECT_NEAR(misaligned_fraction(C, x, Y), 1.0 / 32, 1e-12);
  Y.segment<2>(0).setZero();  // not reached: not counted
  EXPECT_EQ(misaligned_fraction(C, x, Y), 0);
}

TEST(HeatTimeScale, ShareOfCellsAgainstTheirDirectionsOfFunctionsThatJump) {
  // x plus another constant in each triangle; the directions of every third are against it, and
  // every fifth has none.
  const SurfaceMesh mesh(test::jittered_grid_soup(5, 4, 0.3));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const JumpCalculus J = jump_calculus(T);
  MatX3 phi(J.n_faces, 3);
  VecX Y = VecX::Zero(2 * J.n_faces);
  double all = 0, against = 0;
  for (int f = 0; f < J.n_faces; ++f) {
    for (int k = 0; k < 3; ++k) phi(f, k) = mesh.point(T.faces(f, k)).x() / T.unit + 7 * (f % 4);
    Eigen::Matrix2d sides;
    for (int k = 0; k < 2; ++k) sides.row(k) << J.side[f][k].real(), J.side[f][k].imag();
    const Eigen::Vector2d along =
        sides.inverse() * Eigen::Vector2d(phi(f, 1) - phi(f, 0), phi(f, 2) - phi(f, 1));
    EXPECT_NEAR(along.norm(), 1, 1e-9);
    if (f % 5 == 0) continue;
    Y.segment<2>(2 * f) = f % 3 == 0 ? -along : along;
    all += T.shape(f).area;
    if (f % 3 == 0) against += T.shape(f).area;
  }
  EXPECT_NEAR(misaligned_fraction(J, phi, Y), against / all, 1e-12);
  EXPECT_NEAR(misaligned_fraction(J, -phi, Y), 1 - against / all, 1e-12);
  EXPECT_EQ(misaligned_fraction(J, phi, VecX::Zero(Y.size())), 0);
}

TEST(HeatTimeScale, ShareOfCellsWhoseGradientIsNoUnitVector) {
  const SurfaceMesh mesh(test::grid_soup(4, 4));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const Calculus C = triangle_operators(T).scalar;
  const VecX x = mesh.points().col(0) / T.unit;
  const VecX Y = C.G.apply(x);
  const auto share = [&](double slope) {
    Report said;
    report_gradient(C, slope * x, Y, said);
    EXPECT_EQ(said.residuals.back().first, off_unit_area_fraction);
    return said.residuals.back().second;
  };
  EXPECT_EQ(share(1), 0);
  EXPECT_EQ(share(1.2), 0);
  EXPECT_EQ(share(0.7), 1);
  EXPECT_EQ(share(1.3), 1);
  EXPECT_EQ(share(-1), 0);  // the other measure's matter
}

TEST(HeatTimeScale, WarnsWhereTheGradientIsNoUnitVector) {
  // The side of a hexagonal prism, of two triangles a side.
  PolygonSoup side;
  side.points.resize(12, 3);
  for (int i = 0; i < 6; ++i) {
    const double a = std::acos(-1.0) * i / 3;
    side.points.row(i) << std::cos(a), std::sin(a), 0;
    side.points.row(6 + i) << std::cos(a), std::sin(a), 10;
    const int next = (i + 1) % 6;
    test::add_triangle(side, i, next, 6 + next);
    test::add_triangle(side, i, 6 + next, 6 + i);
  }
  const auto warned = [](const Report& report) {
    return std::any_of(report.warnings.begin(), report.warnings.end(), [](const std::string& w) {
      return w.find("off unit length") != std::string::npos;
    });
  };
  const SurfaceMesh needles(side), even(test::octasphere_soup(4));
  const Sources sources = test::vertex_points({0});
  for (const char* method : {"signed-heat", "unsigned-heat"}) {
    SCOPED_TRACE(method);
    Report bad, good;
    const VecX values = test::surface_distance(needles, sources, AnyMethod::named(method), bad);
    EXPECT_GT(mean_error(values, exact(needles, sources)), 0.02);
    EXPECT_TRUE(warned(bad));
    test::surface_distance(even, sources, AnyMethod::named(method), good);
    EXPECT_FALSE(warned(good));
  }
}

double beside_marching(const Report& report) {
  for (const auto& [name, value] : report.residuals)
    if (name == mean_beside_marching) return value;
  return -1;
}

TEST(HeatTimeScale, SaysHowFarItIsFromFastMarching) {
  const SurfaceMesh mesh(test::octasphere_soup(2));
  const Sources sources = test::vertex_points({5});
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const VecX d =
      fast_marching(T, triangle_sources(mesh, T, place_sources(mesh, sources, report)), {}, report);
  for (const char* method : {"signed-heat", "unsigned-heat"}) {
    Report one;
    const VecX u = test::surface_distance(mesh, sources, AnyMethod::named(method), one);
    EXPECT_NEAR(beside_marching(one), (u - d).cwiseAbs().mean() / d.maxCoeff(), 1e-12) << method;
    Report alone;  // without a thread for the march
    set_thread_count(1);
    test::surface_distance(mesh, sources, AnyMethod::named(method), alone);
    set_thread_count(0);
    EXPECT_EQ(beside_marching(alone), beside_marching(one)) << method;
    // Solves that share what they prepare leave it out.
    Report many;
    const auto solver =
        prepare(AnyMethod::named(method), domain_of(mesh), SolveHint::many_rhs, {}, many);
    solver->solve(sources, {}, many);
    EXPECT_EQ(beside_marching(many), -1) << method;
  }
}

TEST(HeatTimeScale, TheWorstComponentSpeaksWhateverItsSize) {
  // A coarse sphere beside a finer one a thousand times as large.
  const PolygonSoup coarse = test::octasphere_soup(1), fine = test::octasphere_soup(4);
  PolygonSoup both = fine;
  const int n = both.n_vertices();
  both.points *= 1000;
  both.points.conservativeResize(n + coarse.n_vertices(), 3);
  both.points.bottomRows(coarse.n_vertices()) =
      coarse.points.rowwise() + Vec3(5000, 0, 0).transpose();
  for (int f = 0; f < coarse.n_faces(); ++f)
    test::add_triangle(both, n + coarse.face(f)[0], n + coarse.face(f)[1], n + coarse.face(f)[2]);
  const AnyMethod march = AnyMethod::named("fast-marching");
  const auto marched = [&](const PolygonSoup& soup, const Sources& from) {
    Report report;
    return test::surface_distance(SurfaceMesh(soup), from, march, report);
  };
  // A tenth of the distance too much on the coarse one alone.
  VecX values = marched(both, test::vertex_points({0, n}));
  values.tail(coarse.n_vertices()) *= 1.1;
  const SurfaceMesh mesh(both);
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const VecX d = marched(coarse, test::vertex_points({0}));
  BesideMarching marching(mesh, T, place_sources(mesh, test::vertex_points({0, n}), report));
  EXPECT_NEAR(marching.report(values, {}, report), 0.1 * d.mean() / d.maxCoeff(), 1e-6);
}

TEST(HeatTimeScale, WarnsWhereFastMarchingDisagrees) {
  for (const auto& [share, warns] : {std::pair(0.019, false), std::pair(0.021, true)}) {
    Report report;
    warn_beside_marching(share, report);
    EXPECT_EQ(!report.warnings.empty(), warns);
  }
  // Broken curves are completed: nearer than the source is no mistake.
  PolygonSoup soup = test::octasphere_soup(3);
  const SurfaceMesh mesh(soup);
  const IntrinsicTriangulation T = [&] {
    Report quiet;
    return intrinsic_triangulation(mesh, quiet);
  }();
  PlacedSources placed;
  {
    Sources sources;
    sources.curves.emplace_back();
    sources.curves[0].nodes = {SurfacePoint::at_vertex(0), SurfacePoint::at_vertex(1)};
    Report quiet;
    placed = place_sources(mesh, sources, quiet);
  }
  Report signed_one, unsigned_one;
  const VecX zero = VecX::Zero(mesh.n_vertices());
  EXPECT_EQ(BesideMarching(mesh, T, placed).report(zero, {}, signed_one), 0);
  for (CurvePiece& piece : placed.pieces) piece.is_signed = false;
  EXPECT_GT(BesideMarching(mesh, T, placed).report(zero, {}, unsigned_one), 0.2);
}

TEST(TimeScale, OfCurvesIsLargerOnFinerMeshesUpToFourTimes) {
  SourceSystem curves, points;
  points.only_points = true;
  const auto automatic = [](const SourceSystem& terms, int cells, bool at_nodes) {
    Operators ops;
    ops.scalar.A = VecX::Zero(cells);
    ops.vector.at_nodes = at_nodes;
    return automatic_time_scale(terms, ops);
  };
  EXPECT_EQ(automatic(curves, 50'000, false), 1);
  EXPECT_EQ(automatic(curves, 100'000, false), 2);
  EXPECT_EQ(automatic(curves, 1'000'000, false), 4);
  EXPECT_EQ(automatic(curves, 1'000'000, true), 1);
  EXPECT_EQ(automatic(points, 1'000'000, false), 16);
}

}  // namespace
}  // namespace littoral
