// The default for distance through tets: straight ways, ways round the boundary, completed sources.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "constants.h"
#include "domain/tet/tet_locator.h"
#include "one_call.h"
#include "space_helpers.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

using test::automatic_tets;
using test::infinity;
using test::tet_errors;
using test::tet_vertex_at;
using test::TetErrors;
using test::tets_where;

TEST(AutomaticThroughTets, IsTheDefault) {
  const TetMesh mesh = test::tet_box(2);
  Report report;
  automatic_tets(mesh, {{}, {0}}, report);
  EXPECT_EQ(report.method, "auto");
  EXPECT_EQ(report.status, "converged");
  EXPECT_THAT(report.warnings, testing::IsEmpty());
}

TEST(AutomaticThroughTets, IsExactFromTheBoundaryOfThinWalls) {
  for (const double thickness : {1.0, 0.1, 1e-3}) {
    TetMesh plate = test::tet_box(4);
    plate.points.col(2) *= thickness;
    TetSources sources;
    sources.boundary = true;
    const VecX phi = automatic_tets(plate, sources);
    const TetErrors errors = tet_errors(plate, phi, [&](const Vec3& x) {
      return std::min({x[0], 1 - x[0], x[1], 1 - x[1], x[2], thickness - x[2]});
    });
    EXPECT_LT(errors.largest, 1e-12) << thickness;
  }
}

TEST(AutomaticThroughTets, FromTheBoundaryOfAHollowCubeSeesBothSkins) {
  const TetMesh shell =
      tets_where(8, [](const Vec3& x) { return (x.array() - 0.5).abs().maxCoeff() > 0.25; });
  TetSources sources;
  sources.boundary = true;
  const VecX phi = automatic_tets(shell, sources);
  const TetErrors errors = tet_errors(shell, phi, [](const Vec3& x) {
    const Vec3 from_hole = ((x.array() - 0.5).abs() - 0.25).max(0.0);
    return std::min({x.minCoeff(), 1 - x.maxCoeff(), from_hole.norm()});
  });
  EXPECT_LT(errors.largest, 1e-12);
}

TEST(AutomaticThroughTets, BoundaryAndVerticesTogetherAreTheNearerOfBoth) {
  const TetMesh mesh = test::tet_box(4);
  TetSources both;
  both.boundary = true;
  both.vertices = {tet_vertex_at(mesh, Vec3::Constant(0.5))};
  const VecX phi = automatic_tets(mesh, both);
  EXPECT_EQ(phi[both.vertices[0]], 0);
  EXPECT_NEAR(phi[tet_vertex_at(mesh, {0.5, 0.5, 0.25})], 0.25, 1e-12);
  EXPECT_EQ(phi.maxCoeff(), 0.25);
}

TEST(AutomaticThroughTets, IsExactFromASheetAcrossTheMesh) {
  TetMesh mesh = test::tet_box(6);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-0.03, 0.03);
  for (auto p : mesh.points.rowwise())
    if (p.minCoeff() > 0 && p.maxCoeff() < 1)
      for (double& x : p) x += u(random);
  for (const double at : {0.5, 0.43})
    for (const bool flip : {false, true}) {
      TetSources sources{test::square_at(at, 5), {}};
      sources.flip = flip;
      Report report;
      const VecX phi = automatic_tets(mesh, sources, report);
      const double sign = flip ? -1 : 1;
      const auto exact = [&](const Vec3& x) { return sign * (x[0] - at); };
      EXPECT_LT(tet_errors(mesh, phi, exact).largest, 1e-12) << at << flip;
      EXPECT_EQ(report.status, "converged");
      EXPECT_THAT(report.warnings, testing::IsEmpty());
    }
}

TEST(AutomaticThroughTets, FromAVertexIsTheStraightLineInConvexMeshes) {
  const TetMesh mesh = test::tet_box(5);
  for (const int v : {0, 77, 215}) {
    const Vec3 from = mesh.points.row(v);
    const VecX phi = automatic_tets(mesh, {{}, {v}});
    const auto exact = [&](const Vec3& x) { return (x - from).norm(); };
    EXPECT_LT(tet_errors(mesh, phi, exact).largest, 1e-12);
  }
}

/// An L along z: the unit cube without x > 1/2, y > 1/2.
TetMesh tet_corner(int n) {
  return tets_where(n, [](const Vec3& x) { return x[0] < 0.5 || x[1] < 0.5; });
}

/// The way from `from`, where x > 1/2, round the edge of that mesh.
double round_the_edge(const Vec3& from, const Vec3& x) {
  const Eigen::Vector2d a = from.head<2>().array() - 0.5, b = x.head<2>().array() - 0.5;
  const bool blocked = b[1] > 0 && a[0] * b[1] - a[1] * b[0] > 0;
  if (!blocked) return (x - from).norm();
  return std::hypot(a.norm() + b.norm(), x[2] - from[2]);
}

TEST(AutomaticThroughTets, GoesRoundAStraightEdgeExactly) {
  for (const int n : {4, 8, 12}) {
    const TetMesh mesh = tet_corner(n);
    for (const Vec3& from : {Vec3(1, 0.25, 0.25), Vec3(1, 0.5, 0.5), Vec3(0.75, 0, 1)}) {
      Report report;
      const VecX phi = automatic_tets(mesh, {{}, {tet_vertex_at(mesh, from)}}, report);
      const auto exact = [&](const Vec3& x) { return round_the_edge(from, x); };
      const TetErrors errors = tet_errors(mesh, phi, exact);
      EXPECT_LT(errors.largest, 1e-9) << n;
      EXPECT_EQ(report.sizes.back().first, "share of vertices out of sight");
      EXPECT_GT(report.sizes.back().second, 0.05);
    }
  }
}

TEST(AutomaticThroughTets, GoesFromASheetRoundAnEdgeAndKeepsItsSide) {
  const TetMesh mesh = tet_corner(8);
  PolygonSoup sheet = test::square_at(0.8, 4);  // across the arm
  sheet.points.col(1) *= 0.5;
  for (const bool flip : {false, true}) {
    TetSources sources{sheet, {}};
    sources.flip = flip;
    const VecX phi = automatic_tets(mesh, sources);
    const TetErrors errors = tet_errors(mesh, phi, [&](const Vec3& x) {
      const double sign = flip ? -1 : 1;
      if (x[1] <= 0.5) return sign * (x[0] - 0.8);
      return -sign * (0.3 + std::hypot(x[0] - 0.5, x[1] - 0.5));
    });
    EXPECT_LT(errors.largest, 1e-9);
  }
}

TEST(AutomaticThroughTets, GoesRoundTwoEdges) {
  // A U: the slot 3/8 < x < 5/8 is open at y < 3/4.
  const TetMesh mesh =
      tets_where(8, [](const Vec3& x) { return x[0] < 0.375 || x[0] > 0.625 || x[1] > 0.75; });
  const VecX phi = automatic_tets(mesh, {{}, {tet_vertex_at(mesh, {0.125, 0.25, 0.5})}});
  const double arm = std::hypot(0.25, 0.5), length = 2 * arm + 0.25;
  EXPECT_NEAR(phi[tet_vertex_at(mesh, {0.875, 0.25, 0.5})], length, 1e-9);
  EXPECT_NEAR(phi[tet_vertex_at(mesh, {0.875, 0.25, 1})], std::hypot(length, 0.5), 1e-9);
}

TEST(AutomaticThroughTets, WhatTouchesWithoutBeingJoinedIsAWall) {
  // Two halves of a cube, joined at y < 1/2 only: vertices on the slit x = 1/2, y > 1/2 are double.
  const int n = 6;
  TetMesh mesh = test::tet_box(n);
  const int nv = mesh.n_vertices();
  mesh.points.conservativeResize(2 * nv, 3);
  mesh.points.bottomRows(nv) = mesh.points.topRows(nv).eval();
  for (int t = 0; t < mesh.n_tets(); ++t) {
    double middle = 0;
    for (int k = 0; k < 4; ++k) middle += mesh.points(mesh.tets(t, k), 0) / 4;
    for (int k = 0; k < 4; ++k)
      if (const Vec3 p = mesh.points.row(mesh.tets(t, k));
          middle > 0.5 && p[0] == 0.5 && p[1] > 0.5)
        mesh.tets(t, k) += nv;
  }
  const Vec3 from(1, 1, 0.5);
  const VecX phi = automatic_tets(mesh, {{}, {tet_vertex_at(mesh, from)}});
  const int behind = tet_vertex_at(mesh, {0, 1, 0.5});
  EXPECT_NEAR(phi[behind], 2 * std::hypot(0.5, 0.5), 1e-9);
}

TEST(AutomaticThroughTets, EachComponentHasItsOwnSources) {
  const int n = 4;
  const TetMesh one = test::tet_box(n);
  TetMesh three = test::copies(one, 3, {1, 0, 0});  // they touch, but share no vertex
  const int nv = one.n_vertices();
  three.points.middleRows(2 * nv, nv).array() += 4;
  const PolygonSoup source = test::square_at(0.75, n);
  Report report;
  const VecX phi = automatic_tets(three, {source, {}}, report);
  EXPECT_LT((phi.head(nv) - (one.points.col(0).array() - 0.75).matrix()).cwiseAbs().maxCoeff(),
            1e-12);
  for (int v = nv; v < 3 * nv; ++v) EXPECT_EQ(phi[v], infinity);
  EXPECT_EQ(report.unreachable_components, (std::vector<int>{1, 2}));
  // Of one vertex in each, at very different scales, the answers are those of the parts alone.
  three.points.bottomRows(nv) = 1e-6 * one.points;
  const VecX both = automatic_tets(three, {{}, {0, 2 * nv}});
  EXPECT_LT((both.head(nv) - one.points.rowwise().norm()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((both.tail(nv) - 1e-6 * one.points.rowwise().norm()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(both[nv], infinity);
}

TEST(AutomaticThroughTets, FlatAndInvertedTetsChangeNothing) {
  const TetMesh mesh = tet_corner(6);
  const int from = tet_vertex_at(mesh, {1, 0, 0.5});
  const VecX phi = automatic_tets(mesh, {{}, {from}});
  TetMesh worse = mesh;
  for (int t = 0; t < mesh.n_tets(); t += 2) std::swap(worse.tets(t, 1), worse.tets(t, 2));
  // A flat tet at every tenth: its first face, a vertex doubled.
  for (int t = 0; t < mesh.n_tets(); t += 10) {
    worse.tets.conservativeResize(worse.tets.rows() + 1, 4);
    worse.tets.bottomRows(1) << mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 2);
  }
  const VecX other = automatic_tets(worse, {{}, {from}});
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (std::isfinite(phi[v])) {
      EXPECT_NEAR(other[v], phi[v], 1e-9);
    }
}

TEST(AutomaticThroughTets, SaysWhatIsWrong) {
  const TetMesh mesh = test::tet_box(2);
  const PolygonSoup square = test::square_at(0.5, 2);
  PolygonSoup far = square;
  far.points.array() += 5;
  const auto message = [&](const TetMesh& on, const TetSources& sources) {
    return test::message_of([&] { automatic_tets(on, sources); });
  };
  using testing::HasSubstr;
  EXPECT_THAT(message(mesh, {far, {}}), HasSubstr("no source lies within the tets"));
  EXPECT_THAT(message(mesh, {square, {1}}), HasSubstr("not both"));
  EXPECT_THAT(message(mesh, {{}, {27}}), HasSubstr("there is no vertex 27"));
  TetMesh loose = mesh;
  loose.points.conservativeResize(28, 3);
  loose.points.row(27).setConstant(3);
  EXPECT_THAT(message(loose, {{}, {27}}), HasSubstr("no source vertex belongs to a tet"));
  PolygonSoup broken = square;
  broken.points(3, 0) = std::nan("");
  EXPECT_THAT(message(mesh, {broken, {}}), HasSubstr("not finite"));
}

}  // namespace
}  // namespace littoral
