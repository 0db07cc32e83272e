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

TEST(RegularizedInSpace, IntervalFromVerticesAndFromASurfaceBetweenThem) {
  const int n = 8;
  const TetMesh mesh = test::tet_box(n);
  TetSources side, square;
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (mesh.points(v, 0) == 0) side.vertices.push_back(v);
  square.surface = test::square_at(1e-9, n);  // not at vertices: rows of many unknowns
  Report report;
  for (const double alpha : {0.0, 0.3}) {
    const OptionValues options = {{"alpha", std::to_string(alpha)}};
    const VecX u = through_tets(mesh, side, options, report);
    const VecX w = through_tets(mesh, square, options, report);
    EXPECT_EQ(report.status, "converged");
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      EXPECT_NEAR(u[v], test::from_one_end(mesh.points(v, 0), alpha), 0.02) << alpha << " " << v;
      EXPECT_NEAR(w[v], u[v], 0.02) << alpha << " " << v;
    }
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
