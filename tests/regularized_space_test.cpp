// Regularized distance through tets and on grids (section 7.4), by name.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "api/space/sdf.h"
#include "littoral/error.h"
#include "one_call.h"
#include "regularized_helpers.h"
#include "space_helpers.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

VecX through_tets(const TetMesh& mesh, const TetSources& sources, OptionValues options,
                  Report& report, const std::string& method = "regularized") {
  options.emplace_back("tolerance", "5e-4");
  return test::tet_mesh_distance(mesh, sources, AnyMethod::named(method, std::move(options)),
                                 report);
}

TEST(RegularizedInSpace, IntervalFromVertices) {
  const TetMesh mesh = test::tet_box(8);
  TetSources side;
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (mesh.points(v, 0) == 0) side.vertices.push_back(v);
  Report report;
  for (const double alpha : {0.0, 0.3}) {
    const OptionValues options = {{"alpha", std::to_string(alpha)}};
    const VecX u = through_tets(mesh, side, options, report);
    EXPECT_EQ(report.status, "converged");
    for (int v = 0; v < mesh.n_vertices(); ++v)
      EXPECT_NEAR(u[v], test::from_one_end(mesh.points(v, 0), alpha), 0.02) << alpha << " " << v;
  }
}

TEST(RegularizedInSpace, ASurfaceBetweenVerticesHasItsDistanceOnBothSides) {
  // Through the middle of the cells: were the interpolated value 0 there, one side or both would be
  // up to an edge too near.
  const int n = 8;
  const TetMesh mesh = test::tet_box(n);
  TetSources square;
  for (const double at : {0.3, 0.5 / n, 0.4375}) {
    square.surface = test::square_at(at, n);
    Report report;
    const VecX u = through_tets(mesh, square, {{"alpha", "0"}}, report);
    EXPECT_EQ(report.status, "converged");
    for (int v = 0; v < mesh.n_vertices(); ++v)
      EXPECT_NEAR(u[v], std::abs(mesh.points(v, 0) - at), 0.02 / n) << at << " " << v;
  }
}

TEST(RegularizedInSpace, ASphereBetweenVerticesHasItsDistanceOnBothSides) {
  const Vec3 centre(0.51, 0.49, 0.5);
  PolygonSoup sphere = test::octasphere_soup(3);
  sphere.points = (0.3 * sphere.points).rowwise() + centre.transpose();
  const auto exact = [&](const Vec3& x) { return (x - centre).norm() - 0.3; };
  const auto unsigned_exact = [&](const Vec3& x) { return std::abs(exact(x)); };
  const int n = 8;
  const TetMesh mesh = test::tet_box(n);
  Report report;
  const VecX u = through_tets(mesh, {sphere}, {{"alpha", "0"}}, report);
  Grid grid;
  grid.n = {n + 1, n + 1, n + 1};
  grid.spacing.setConstant(1.0 / n);
  MatX3 nodes(grid.n_nodes(), 3);
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        nodes.row(static_cast<Eigen::Index>(grid.node(i, j, k))) = grid.point(i, j, k);
  const SpaceRequest request{SpaceRegularized{.alpha = 0, .tolerance = 1e-3}};
  const VecX phi = grid_distance(sphere, grid, request, {}, report);
  for (const bool inside : {true, false}) {
    const auto part = [&](const Vec3& x) { return (exact(x) < 0) == inside; };
    EXPECT_LT(n * test::mean_error(mesh.points, u, unsigned_exact, part), 0.12) << inside;
    EXPECT_LT(n * test::mean_error(nodes, phi, exact, part), 0.12) << inside;
  }
}

TEST(RegularizedInSpace, PartsOfASurfaceOutsideTheTetsAreLeftOut) {
  // A square within the cube, and a sheet that lies on top of the cube, just outside.
  const int n = 4;
  const TetMesh mesh = test::tet_box(n);
  TetSources sources;
  sources.surface = test::square_at(0.45, n);
  PolygonSoup& surface = sources.surface;
  const int first = static_cast<int>(surface.points.rows());
  surface.points.conservativeResize(first + 4, 3);
  surface.points.bottomRows(4) << 0.2, 1.001, 0, 0.45, 1.001, 0, 0.45, 1.001, 1, 0.2, 1.001, 1;
  surface.add_face(std::array{first, first + 1, first + 2, first + 3});
  for (const char* method : {"belyaev-fayolle", "quadratic"}) {
    Report report;
    const VecX u = test::tet_mesh_distance(mesh, sources, AnyMethod::named(method), report);
    EXPECT_FALSE(report.warnings.empty());
    for (int v = 0; v < mesh.n_vertices(); ++v)
      EXPECT_NEAR(u[v], std::abs(mesh.points(v, 0) - 0.45), 0.01) << method << v;
  }
}

TEST(RegularizedInSpace, SameWhateverTheUnitThoughAlphaIsALength) {
  TetMesh mesh = test::tet_box(4), larger = mesh;
  larger.points *= 1000;
  const TetSources corner{{}, {0}};
  Report report;
  const VecX u = through_tets(mesh, corner, {{"alpha", "0.2"}}, report);
  const VecX w = through_tets(larger, corner, {{"alpha", "0.2"}}, report);
  EXPECT_LT((w / 1000 - u).cwiseAbs().maxCoeff(), 0.01 * u.maxCoeff());
}

TEST(RegularizedInSpace, FromTheBoundaryTheMiddleOfACubeIsHalfWay) {
  const TetMesh mesh = test::tet_box(8);
  TetSources boundary;
  boundary.boundary = true;
  Report report;
  const VecX u = through_tets(mesh, boundary, {}, report, "belyaev-fayolle");
  // Next to a corner of the cube unit gradient allows h / sqrt(3), not h = 1/8.
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const Vec3 x = mesh.points.row(v);
    EXPECT_NEAR(u[v], std::min(x.minCoeff(), 1 - x.maxCoeff()), 0.055) << v;
  }
  const VecX smooth = through_tets(mesh, boundary, {{"alpha", "0.1"}}, report);
  EXPECT_LT(smooth.maxCoeff(), u.maxCoeff() - 0.05);
}

TEST(RegularizedInSpace, ComponentsWithoutASourceAreInfiniteAndOptionsAreChecked) {
  const TetMesh mesh = test::copies(test::tet_box(2), 2, {5, 5, 5});
  const int n = mesh.n_vertices() / 2;
  Report report;
  const VecX u = through_tets(mesh, {{}, {3}}, {}, report);
  EXPECT_TRUE(u.head(n).allFinite());
  EXPECT_TRUE((u.tail(n).array() == std::numeric_limits<double>::infinity()).all());
  EXPECT_EQ(report.unreachable_components.size(), 1U);
  for (const auto& option : OptionValues{{"regularizer", "hessian"}, {"elements", "quadratic"}})
    EXPECT_THROW(through_tets(mesh, {{}, {3}}, {option}, report), InputError);
  EXPECT_THROW(through_tets(mesh, {{}, {3}}, {{"alpha", "-1"}}, report), InputError);
  EXPECT_THROW(through_tets(mesh, {{}, {-1}}, {}, report), InputError);
}

TEST(RegularizedInSpaceSlow, BallOnAGrid) {
  // From the sphere of radius 1, inside: unit gradient down to r = 3 alpha, where 3 alpha u' = -r
  // begins.
  const Grid grid = test::cube_grid(19, 1.2);
  const double length = 19.0 / 18 * 2.4;  // the cube root of the volume of the nodes
  for (const double alpha : {0.0, 0.15}) {
    const SpaceRequest request{SpaceRegularized{.alpha = alpha / length, .tolerance = 1e-3}};
    Report report;
    const VecX phi = grid_distance(test::octasphere_soup(4), grid, request, {}, report);
    EXPECT_EQ(report.status, "converged");
    double sum = 0, count = 0;
    for (int k = 0; k < 19; ++k)
      for (int j = 0; j < 19; ++j)
        for (int i = 0; i < 19; ++i) {
          const double r = grid.point(i, j, k).norm();
          if (r > 0.9) continue;
          const double inner = 3 * alpha;
          const double u = r >= inner ? 1 - r : 1 - inner + (inner * inner - r * r) / (6 * alpha);
          sum += std::abs(phi[static_cast<Eigen::Index>(grid.node(i, j, k))] + u);
          ++count;
        }
    EXPECT_LT(sum / count, 0.05) << alpha;  // spacing 0.133
  }
}

}  // namespace
}  // namespace littoral
