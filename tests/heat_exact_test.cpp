// Signed heat distance against distances known in closed form.

#include <gtest/gtest.h>

#include "heat_helpers.h"
#include "sources/surface/pieces.h"
#include "test_meshes.h"

namespace littoral {
namespace {

struct Accuracy {
  double h = 0, mean = 0;
  int wrong_signs = 0;
};

Accuracy measure(const PolygonSoup& soup, const MatX3& curve,
                 const std::function<double(const Vec3&)>& exact, Constraint constraint) {
  const SurfaceMesh mesh(soup);
  Report report;
  const VecX phi = test::signed_heat(mesh, test::space_curve(curve), {16, constraint}, report);
  Accuracy a;
  for (int e = 0; e < mesh.n_edges(); ++e)
    a.h += (mesh.point(mesh.edges()(e, 0)) - mesh.point(mesh.edges()(e, 1))).norm();
  a.h /= mesh.n_edges();
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const double d = exact(mesh.point(v));
    a.mean += std::abs(phi[v] - d) / mesh.n_vertices();
    if (std::abs(d) > a.h && phi[v] * d <= 0) ++a.wrong_signs;
  }
  return a;
}

/// Slope of log(mean error) over log(h) between the coarsest and the finest mesh.
void expect_order(const std::function<PolygonSoup(int)>& family, std::vector<int> sizes,
                  const MatX3& curve, const std::function<double(const Vec3&)>& exact,
                  double lowest_order, double finest_error) {
  for (const Constraint constraint : {Constraint::zero_set, Constraint::none}) {
    std::vector<Accuracy> all;
    for (int n : sizes) all.push_back(measure(family(n), curve, exact, constraint));
    for (const Accuracy& a : all) EXPECT_EQ(a.wrong_signs, 0) << "at h = " << a.h;
    const double order =
        std::log(all.front().mean / all.back().mean) / std::log(all.front().h / all.back().h);
    EXPECT_GT(order, lowest_order) << "constraint " << static_cast<int>(constraint);
    EXPECT_LT(all.back().mean, finest_error) << "constraint " << static_cast<int>(constraint);
  }
}

double circle_distance(const Vec3& p) { return std::hypot(p.x() - 0.5, p.y() - 0.5) - 0.3; }

MatX3 clockwise_circle() { return test::circle(0.5, 0.5, 0, 0.3, 256).colwise().reverse(); }

MatX3 straight_line() {
  MatX3 line(2, 3);
  line << 0.4, 0, 0, 0.4, 1, 0;  // upwards: the left, where phi > 0, is x < 0.4
  return line;
}

double line_distance(const Vec3& p) { return 0.4 - p.x(); }

TEST(HeatExact, StraightLineOnGrids) {
  for (int diagonal : {0, 1}) {
    const auto grid = [&](int n) { return test::grid_soup(n, n, diagonal); };
    for (Constraint constraint : {Constraint::zero_set, Constraint::none})
      for (int n : {10, 20}) {
        const Accuracy a = measure(grid(n), straight_line(), line_distance, constraint);
        EXPECT_EQ(a.wrong_signs, 0);
        EXPECT_LT(a.mean, 0.15 * a.h);
      }
  }
}

TEST(HeatExact, CircleOnGridsIsFirstOrder) {
  expect_order([](int n) { return test::grid_soup(n, n, 0); }, {12, 24, 48}, clockwise_circle(),
               circle_distance, 0.7, 0.01);
  expect_order([](int n) { return test::grid_soup(n, n, 1); }, {12, 24, 48}, clockwise_circle(),
               circle_distance, 0.7, 0.01);
}

TEST(HeatExact, CircleOnJitteredGridsIsFirstOrder) {
  expect_order([](int n) { return test::jittered_grid_soup(n, n, 0.3); }, {12, 24, 48},
               clockwise_circle(), circle_distance, 0.7, 0.01);
}

TEST(HeatExact, CircleOnStretchedTriangles) {
  expect_order([](int n) { return test::grid_soup(n, 8 * n, 0); }, {6, 12, 24}, clockwise_circle(),
               circle_distance, 0.7, 0.02);
}

TEST(HeatExact, LatitudeOnSpheres) {
  // Loops of latitude on the sphere z = 0.5; geodesic distance is the difference of latitudes. The
  // direction error at t = h^2 stalls with refinement on octaspheres, so only the level of the
  // error is asserted, not its order.
  const double latitude = std::asin(0.5), radius = std::cos(latitude);
  const auto exact = [&](const Vec3& p) {
    return std::asin(std::clamp(p.z(), -1.0, 1.0)) - latitude;
  };
  for (Constraint constraint : {Constraint::zero_set, Constraint::none})
    for (int level : {3, 4, 5}) {
      const Accuracy a = measure(test::octasphere_soup(level), test::circle(0, 0, 0.5, radius, 512),
                                 exact, constraint);
      EXPECT_EQ(a.wrong_signs, 0) << level;
      EXPECT_LT(a.mean, level == 3 ? 0.05 : 0.025) << level;
    }
}

/// How far values along curves are from 0 or, `by_curve`, from each curve's mean: root mean square
/// and largest.
std::pair<double, double> off_level(const SurfaceMesh& mesh, const Sources& sources,
                                    const VecX& phi, bool by_curve) {
  Report report;
  const PlacedSources placed = place_sources(mesh, sources, report);
  VecX value(static_cast<Eigen::Index>(placed.pieces.size())), length = value, off = value;
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    const CurvePiece& piece = placed.pieces[i];
    value[i] = 0;
    length[i] = piece.length;
    for (std::size_t k = 0; k < 3; ++k)
      value[i] += phi[mesh.face(piece.face)[k]] * (piece.a[k] + piece.b[k]) / 2;
  }
  off = value;
  for (int c = 0; c < placed.n_curves && by_curve; ++c) {
    double sum = 0, total = 0;
    const auto on = [&](Eigen::Index i) { return placed.pieces[i].curve == c; };
    for (Eigen::Index i = 0; i < value.size(); ++i)
      if (on(i)) {
        sum += length[i] * value[i];
        total += length[i];
      }
    for (Eigen::Index i = 0; i < value.size(); ++i)
      if (on(i)) off[i] -= sum / total;
  }
  return {std::sqrt(length.dot(off.cwiseAbs2()) / length.sum()), off.cwiseAbs().maxCoeff()};
}

// Rows hold means over stretches of a curve through faces. Between them a linear function cannot
// follow the curve; what is left is of second order.
TEST(HeatExact, ValuesAlongCurvesThroughFacesAreHeldToSecondOrder) {
  Sources circles = test::space_curve(test::circle(0.5, 0.5, 0, 0.15, 256));
  circles.add(test::space_curve(test::circle(0.5, 0.5, 0, 0.3, 256)));
  const Sources circle = test::space_curve(test::circle(0.5, 0.5, 0, 0.3, 256));
  for (const bool levels : {false, true}) {
    std::vector<double> rms;
    for (const int n : {12, 24, 48, 96}) {
      const SurfaceMesh mesh(test::jittered_grid_soup(n, n, 0.3));
      const Sources& sources = levels ? circles : circle;
      const Constraint constraint = levels ? Constraint::level_sets : Constraint::zero_set;
      Report report;
      const VecX phi = test::signed_heat(mesh, sources, {16, constraint}, report);
      const auto [mean, largest] = off_level(mesh, sources, phi, levels);
      EXPECT_LT(largest, 0.1 / n);
      rms.push_back(mean);
    }
    EXPECT_GT(std::log2(rms.front() / rms.back()) / 3, 1.8) << levels;
  }
}

}  // namespace
}  // namespace littoral
