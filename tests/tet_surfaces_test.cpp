// The default for distance through tets, from surfaces: their sides, gaps and ends.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "one_call.h"
#include "space_helpers.h"
#include "spatial/winding_number.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

using test::automatic_tets;
using test::tet_errors;
using test::TetErrors;

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

TEST(SurfacesThroughTets, AClosedSurfaceHasAnInsideHoweverThin) {
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

TEST(SurfacesThroughTets, PartsThatOverlapAreOneInside) {
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

TEST(SurfacesThroughTets, ABrokenSurfaceIsCompleted) {
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

TEST(SurfacesThroughTets, ASheetThatEndsWithinIsContinued) {
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

TEST(SurfacesThroughTets, OfASurfaceOnlyWhatLiesInTheTetsCounts) {
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

TEST(SurfacesThroughTets, ACloudWithNormalsIsASurface) {
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

}  // namespace
}  // namespace littoral
