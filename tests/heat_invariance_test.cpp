// What must not change the distance, and what changes it in a known way.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numeric>

#include "base/parallel.h"
#include "heat_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

enum class Kind { none, zero_set, level_sets, soft, unsigned_heat };

class HeatInvariance : public testing::TestWithParam<Kind> {
 protected:
  static PolygonSoup soup() { return test::octasphere_soup(3); }

  /// Two loops of vertices: edges between vertices with z > 0.5 and the rest are awkward to name,
  /// so a chain of vertices found by walking, one signed curve and its vertices' numbers.
  static Sources sources(const std::function<int(int)>& name = [](int v) { return v; }) {
    const SurfaceMesh mesh(soup());
    Sources out;
    Curve curve;
    const int equator[] = {0, 2, 1, 3, 0};  // traced along the great circle
    for (int k = 0; k < 4; ++k) {
      const Vec3 a = mesh.point(equator[k]), b = mesh.point(equator[k + 1]);
      for (int s = 0; s < 8; ++s) {
        const double t = s / 8.0 * std::acos(0.0);
        const Vec3 at = std::cos(t) * a + std::sin(t) * b;
        Eigen::Index nearest = 0;
        (mesh.points().rowwise() - at.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
        curve.nodes.push_back(SurfacePoint::at_vertex(name(static_cast<int>(nearest))));
      }
    }
    curve.nodes.push_back(curve.nodes.front());
    out.curves.push_back(curve);
    return out;
  }

  static VecX solve(const PolygonSoup& s, const Sources& from) {
    const SurfaceMesh mesh(s);
    Report report;
    if (GetParam() == Kind::unsigned_heat) return test::unsigned_heat(mesh, from, report);
    SignedHeat options{1, Constraint::zero_set};
    if (GetParam() == Kind::none) options.constraint = Constraint::none;
    if (GetParam() == Kind::level_sets) options.constraint = Constraint::level_sets;
    if (GetParam() == Kind::soft) options.soft = 100;
    return test::signed_heat(mesh, from, options, report);
  }
  static double sign() { return GetParam() == Kind::unsigned_heat ? 1 : -1; }

  static void expect_near(const VecX& got, const VecX& wanted, double tolerance) {
    ASSERT_EQ(got.size(), wanted.size());
    ASSERT_TRUE(got.allFinite());
    EXPECT_LE((got - wanted).cwiseAbs().maxCoeff(), tolerance * wanted.cwiseAbs().maxCoeff());
  }
};

TEST_P(HeatInvariance, RigidMotion) {
  PolygonSoup moved = soup();
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  moved.points = ((moved.points * R.transpose()).rowwise() + Eigen::RowVector3d(3, -2, 5)).eval();
  expect_near(solve(moved, sources()), solve(soup(), sources()), 1e-9);
}

TEST_P(HeatInvariance, Scale) {
  const VecX phi = solve(soup(), sources());
  for (double s : {1e-3, 1e3}) {
    PolygonSoup scaled = soup();
    scaled.points *= s;
    expect_near(solve(scaled, sources()), s * phi, 1e-9);
  }
  for (double s : {0x1p-20, 0x1p30}) {
    PolygonSoup scaled = soup();
    scaled.points *= s;
    EXPECT_TRUE(solve(scaled, sources()) == s * phi) << "powers of two are exact";
  }
}

TEST_P(HeatInvariance, TranslationByAMillionSizes) {
  PolygonSoup moved = soup();
  moved.points.rowwise() += Eigen::RowVector3d(1e6, -1e6, 2e6);
  expect_near(solve(moved, sources()), solve(soup(), sources()), 1e-6);
}

TEST_P(HeatInvariance, Relabelling) {
  const PolygonSoup before = soup();
  std::mt19937 random(3);
  std::vector<int> vertex(before.n_vertices()), face(before.n_faces());
  std::iota(vertex.begin(), vertex.end(), 0);
  std::iota(face.begin(), face.end(), 0);
  std::shuffle(vertex.begin(), vertex.end(), random);
  std::shuffle(face.begin(), face.end(), random);
  PolygonSoup after;
  after.points.resize(before.n_vertices(), 3);
  for (int v = 0; v < before.n_vertices(); ++v) after.points.row(vertex[v]) = before.points.row(v);
  for (int f : face) {
    const auto c = before.face(f);
    const int turn = static_cast<int>(random() % 3);
    test::add_triangle(after, vertex[c[turn]], vertex[c[(turn + 1) % 3]],
                       vertex[c[(turn + 2) % 3]]);
  }
  const VecX phi = solve(before, sources());
  const VecX psi = solve(after, sources([&](int v) { return vertex[v]; }));
  VecX back(phi.size());
  for (int v = 0; v < before.n_vertices(); ++v) back[v] = psi[vertex[v]];
  expect_near(back, phi, 1e-9);
}

TEST_P(HeatInvariance, FlippingEverything) {
  PolygonSoup flipped = soup();
  for (int f = 0; f < flipped.n_faces(); ++f)
    std::swap(flipped.corners[3 * f], flipped.corners[3 * f + 1]);
  const VecX phi = solve(soup(), sources());
  expect_near(solve(flipped, sources()), sign() * phi, 1e-9);
  expect_near(solve(soup(), sources().reversed()), sign() * phi, 1e-9);
}

TEST_P(HeatInvariance, AFewFlippedFacesChangeNothing) {
  PolygonSoup flipped = soup();
  for (int f = 0; f < flipped.n_faces(); f += 5)
    std::swap(flipped.corners[3 * f], flipped.corners[3 * f + 1]);
  expect_near(solve(flipped, sources()), solve(soup(), sources()), 1e-9);
}

TEST_P(HeatInvariance, UnreferencedVerticesAreInfinite) {
  PolygonSoup more = soup();
  const int n = more.n_vertices();
  more.points.conservativeResize(n + 2, 3);
  more.points.row(n) << 50, 0, 0;
  more.points.row(n + 1) << 0, 0, 0;
  const VecX phi = solve(more, sources());
  expect_near(phi.head(n), solve(soup(), sources()), 1e-9);
  EXPECT_EQ(phi[n], std::numeric_limits<double>::infinity());
  EXPECT_EQ(phi[n + 1], std::numeric_limits<double>::infinity());
}

TEST_P(HeatInvariance, SameBitsForAnyNumberOfThreads) {
  set_thread_count(1);
  const VecX one = solve(soup(), sources());
  for (int threads : {2, 3}) {
    set_thread_count(threads);
    EXPECT_TRUE(solve(soup(), sources()) == one) << threads;
  }
  set_thread_count(0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, HeatInvariance,
                         testing::Values(Kind::none, Kind::zero_set, Kind::level_sets, Kind::soft,
                                         Kind::unsigned_heat));

}  // namespace
}  // namespace littoral
