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
#include "spatial/winding_number.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

using test::infinity;

VecX automatic_tets(const TetMesh& mesh, const TetSources& sources, Report& report) {
  return test::tet_mesh_distance(mesh, sources, {}, report);
}
VecX automatic_tets(const TetMesh& mesh, const TetSources& sources) {
  Report report;
  return automatic_tets(mesh, sources, report);
}

/// What of tet_box(n) lies in cells that `keep` wants by their centres.
TetMesh tets_where(int n, const std::function<bool(const Vec3&)>& keep) {
  TetMesh mesh = test::tet_box(n);
  std::vector<int> kept;
  for (int t = 0; t < mesh.n_tets(); ++t) {
    Vec3 low = Vec3::Ones(), high = Vec3::Zero();
    for (int k = 0; k < 4; ++k) {
      low = low.cwiseMin(mesh.points.row(mesh.tets(t, k)).transpose());
      high = high.cwiseMax(mesh.points.row(mesh.tets(t, k)).transpose());
    }
    if (keep((low + high) / 2)) kept.push_back(t);
  }
  mesh.tets = Rows<int, 4>(mesh.tets(kept, Eigen::all));
  return mesh;
}

std::vector<char> used_vertices(const TetMesh& mesh) {
  std::vector<char> used(static_cast<std::size_t>(mesh.n_vertices()), 0);
  for (const int v : mesh.tets.reshaped()) used[static_cast<std::size_t>(v)] = 1;
  return used;
}

int tet_vertex_at(const TetMesh& mesh, const Vec3& x) {
  Eigen::Index v = 0;
  (mesh.points.rowwise() - x.transpose()).rowwise().squaredNorm().minCoeff(&v);
  return static_cast<int>(v);
}

/// Largest and mean error where there is a mesh.
struct TetErrors {
  double largest = 0, mean = 0;
};
TetErrors tet_errors(const TetMesh& mesh, const VecX& phi,
                     const std::function<double(const Vec3&)>& exact) {
  TetErrors out;
  int n = 0;
  const std::vector<char> used = used_vertices(mesh);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    if (used[static_cast<std::size_t>(v)] == 0) continue;
    const double error = std::abs(phi[v] - exact(mesh.points.row(v)));
    out.largest = std::isnan(error) ? infinity : std::max(out.largest, error);
    out.mean += error;
    ++n;
  }
  out.mean /= n;
  return out;
}

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
  EXPECT_NEAR(phi[tet_vertex_at(mesh, {0.875, 0.25, 1})], std::hypot(length, 0.5), 0.01);
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

TEST(AutomaticThroughTets, TurnsRoundACurvedHoleAsOftenAsItMust) {
  // Round a cylinder: from one side of it to the other the way follows its boundary.
  const double radius = 0.25;
  for (const int n : {8, 16}) {
    TetMesh mesh = tets_where(
        n, [&](const Vec3& x) { return (x.head<2>().array() - 0.5).abs().maxCoeff() > radius; });
    for (auto p : mesh.points.rowwise()) {  // squares to circles
      const Eigen::RowVector2d d = p.head<2>().array() - 0.5;
      const double square = d.cwiseAbs().maxCoeff();
      if (square > 0) p.head<2>() = (d / d.norm() * square).array() + 0.5;
    }
    const Vec3 from(0.5 - 0.5, 0.5, 0.5);
    const VecX phi = automatic_tets(mesh, {{}, {tet_vertex_at(mesh, from)}});
    const auto exact = [&](const Vec3& x) {
      const Eigen::Vector2d a = from.head<2>().array() - 0.5, b = x.head<2>().array() - 0.5;
      const double free =
          std::acos(std::min(1.0, radius / a.norm())) + std::acos(std::min(1.0, radius / b.norm()));
      const double angle = std::acos(std::clamp(a.dot(b) / a.norm() / b.norm(), -1.0, 1.0));
      if (angle <= free) return (x - from).norm();
      const double flat = std::sqrt(a.squaredNorm() - radius * radius) +
                          std::sqrt(std::max(0.0, b.squaredNorm() - radius * radius)) +
                          radius * (angle - free);
      return std::hypot(flat, x[2] - from[2]);
    };
    const TetErrors errors = tet_errors(mesh, phi, exact);
    EXPECT_LT(errors.mean, 0.001);
    EXPECT_LT(errors.largest, 0.05);
  }
}

PolygonSoup ball_in_cube(double radius, int level = 3) {
  PolygonSoup ball = test::octasphere_soup(level);
  ball.points = (radius * ball.points).rowwise() + Eigen::RowVector3d(0.5, 0.45, 0.55);
  return ball;
}

/// Faces for which `keep` says so by their number and first corner; the others reversed or left
/// out.
PolygonSoup damaged(const PolygonSoup& whole, bool reversed,
                    const std::function<bool(int, const Vec3&)>& keep) {
  PolygonSoup out;
  out.points = whole.points;
  for (int f = 0; f < whole.n_faces(); ++f) {
    std::vector<int> face(whole.face(f).begin(), whole.face(f).end());
    const bool good = keep(f, whole.points.row(face[0]));
    if (!good && !reversed) continue;
    if (!good) std::swap(face[1], face[2]);
    out.add_face(face);
  }
  return out;
}

TEST(AutomaticThroughTets, AClosedSurfaceHasAnInsideHoweverThin) {
  const TetMesh mesh = test::tet_box(8);
  PolygonSoup thin = ball_in_cube(0.35);
  thin.points.col(2) = (thin.points.col(2).array() - 0.55) * 0.1 + 0.5;
  const VecX phi = automatic_tets(mesh, {thin, {}});
  const MatX3i faces = MatX3i(Eigen::Map<const MatX3i>(thin.corners.data(), thin.n_faces(), 3));
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const Vec3 x = mesh.points.row(v);
    const double winding = winding_number_brute_force(thin.points, faces, x);
    EXPECT_EQ(phi[v]<0, winding> 0.5) << x.transpose();
  }
}

TEST(AutomaticThroughTets, PartsThatOverlapAreOneInside) {
  const TetMesh mesh = test::tet_box(10);
  PolygonSoup two = ball_in_cube(0.3);
  PolygonSoup other = two;
  other.points.col(0).array() += 0.2;
  const int n = two.n_vertices();
  two.points.conservativeResize(2 * n, 3);
  two.points.bottomRows(n) = other.points;
  for (int f = 0; f < other.n_faces(); ++f) {
    std::vector<int> face(other.face(f).begin(), other.face(f).end());
    for (int& v : face) v += n;
    two.add_face(face);
  }
  const VecX phi = automatic_tets(mesh, {two, {}});
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const Vec3 x = mesh.points.row(v);
    const double r =
        std::min((x - Vec3(0.5, 0.45, 0.55)).norm(), (x - Vec3(0.7, 0.45, 0.55)).norm());
    if (std::abs(r - 0.3) > 0.01) {
      EXPECT_EQ(phi[v] < 0, r < 0.3);
    }
  }
}

TEST(AutomaticThroughTets, ABrokenSurfaceIsCompleted) {
  const int n = 10;
  const TetMesh mesh = test::tet_box(n);
  const PolygonSoup whole = ball_in_cube(0.3, 4);
  const Vec3 centre(0.5, 0.45, 0.55);
  const auto signed_distance = [&](const Vec3& x) { return (x - centre).norm() - 0.3; };
  const auto check = [&](const PolygonSoup& broken, double worst, double mean) {
    Report report, ignored;
    const VecX phi = automatic_tets(mesh, {broken, {}}, report);
    const VecX heat =
        test::tet_mesh_distance(mesh, {broken, {}}, AnyMethod::named("signed-heat"), ignored);
    const TetErrors errors = tet_errors(mesh, phi, signed_distance);
    const TetErrors before = tet_errors(mesh, heat, signed_distance);
    EXPECT_LT(errors.largest, worst);
    EXPECT_LT(errors.mean, mean);
    EXPECT_LT(errors.mean, 0.6 * before.mean);
    int wrong = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v)
      wrong += std::abs(signed_distance(mesh.points.row(v))) > 0.03 &&
               (phi[v] < 0) != (signed_distance(mesh.points.row(v)) < 0);
    EXPECT_LE(wrong, 2);
    return report;
  };
  // A cap is missing.
  const Report report =
      check(damaged(whole, false, [&](int, const Vec3& x) { return x[2] - centre[2] < 0.24; }),
            0.08, 0.006);
  EXPECT_THAT(report.sizes, testing::Contains(testing::Key("completed share of the zero set")));
  // A quarter of the faces, here and there, is missing or reversed.
  check(damaged(whole, false, [](int f, const Vec3&) { return f % 4 != 1; }), 0.03, 0.003);
  check(damaged(whole, true, [&](int, const Vec3& x) { return x[2] - centre[2] < 0.2; }), 0.03,
        0.003);
}

TEST(AutomaticThroughTets, ASheetThatEndsWithinIsContinued) {
  const int n = 8;
  const TetMesh mesh = test::tet_box(n);
  PolygonSoup half = test::square_at(0.5, 8);
  half.points.col(1) *= 0.6;
  const VecX phi = automatic_tets(mesh, {half, {}});
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (std::abs(mesh.points(v, 0) - 0.5) > 0.1) {
      EXPECT_EQ(phi[v] < 0, mesh.points(v, 0) < 0.5);
    }
  const auto exact = [](const Vec3& x) { return x[0] - 0.5; };
  EXPECT_LT(tet_errors(mesh, phi, exact).largest, 0.08);
}

TEST(AutomaticThroughTets, OfASurfaceOnlyWhatLiesInTheTetsCounts) {
  // A ball half in the cube: its pole outside is nearest to the edges beside, and not in sight.
  const TetMesh mesh = test::tet_box(6);
  PolygonSoup ball = test::octasphere_soup(4);
  ball.points = (0.25 * ball.points).rowwise() + Eigen::RowVector3d(0.5, 0.5, 1.1);
  Report report;
  const VecX phi = automatic_tets(mesh, {ball, {}}, report);
  EXPECT_THAT(report.warnings.front().code, "sources-outside");
  const double rim = std::sqrt(0.25 * 0.25 - 0.1 * 0.1);  // of the hole in the top
  const TetErrors errors = tet_errors(mesh, phi, [&](const Vec3& x) {
    const Vec3 d = x - Vec3(0.5, 0.5, 1.1);
    const double flat = d.head<2>().norm();
    if (d.norm() < 0.25 || flat * 0.1 < -d[2] * rim) return d.norm() - 0.25;
    return std::hypot(flat - rim, d[2] + 0.1);
  });
  EXPECT_LT(errors.largest, 0.003);  // the octasphere is not round
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

TEST(AutomaticThroughTets, ACloudWithNormalsIsASurface) {
  const TetMesh mesh = test::tet_box(10);
  PolygonSoup cloud;
  const PolygonSoup ball = test::octasphere_soup(4);
  cloud.normals = ball.points;
  cloud.points = ball_in_cube(0.3, 4).points;
  const VecX phi = automatic_tets(mesh, {cloud, {}});
  const TetErrors errors =
      tet_errors(mesh, phi, [](const Vec3& x) { return (x - Vec3(0.5, 0.45, 0.55)).norm() - 0.3; });
  EXPECT_LT(errors.mean, 0.005);
  EXPECT_LT(errors.largest, 0.03);
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
