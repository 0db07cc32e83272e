// The unsigned baseline where heat methods are known to err: at the boundary.

#include <gtest/gtest.h>

#include "dense_solves.h"
#include "heat_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(UnsignedHeatSolver, TheBoundaryIsAsAccurateAsTheInterior) {
  const int n = 40;
  const SurfaceMesh mesh(test::grid_soup(n, n, 1));
  Report report;
  const int source = 20 + 13 * (n + 1);
  const VecX u = test::unsigned_heat(mesh, test::vertex_points({source}), report);
  double inside = 0, boundary = 0;
  int n_inside = 0, n_boundary = 0;
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const double error = std::abs(u[v] - (mesh.point(v) - mesh.point(source)).norm());
    const int i = v % (n + 1), j = v / (n + 1);
    const bool edge = i == 0 || j == 0 || i == n || j == n;
    (edge ? boundary : inside) += error;
    ++(edge ? n_boundary : n_inside);
  }
  EXPECT_LT(boundary / n_boundary, 0.02);
  EXPECT_LT(boundary / n_boundary, 2 * inside / n_inside);
}

// A point on an edge that ends at the boundary, most of whose weight is a boundary vertex's: zero
// Dirichlet values leave less of it, and the mean must take both solutions in the same units.
TEST(ScalarHeat, TheMeanOfBothBoundaryValuesIsInOneUnit) {
  const int n = 8;
  const SurfaceMesh mesh(test::grid_soup(n, n, 1));
  Report report;
  const test::Problem p =
      test::problem(mesh, test::vertex_points({0}), report);  // for its operators
  const Calculus& C = p.ops->scalar;
  const double t = 0.05;
  const int nodes = mesh.n_vertices(), inner = 1 + (n + 1), outer = 1;  // of one face

  SourceSystem system;
  system.u0.resize(nodes, 1);
  system.u0.insert(outer, 0) = 0.95;
  system.u0.insert(inner, 0) = 0.05;
  system.batch_of_points = {1};
  system.batch_value = VecX::Zero(1);

  // Both solutions by dense matrices.
  const VecX u0 = VecX(system.u0.col(0));
  const Eigen::MatrixXd L(C.L);
  Eigen::MatrixXd A = t * Eigen::MatrixXd(L.selfadjointView<Eigen::Lower>());
  A.diagonal() += C.M;
  VecX mean = test::dense_solve(A, u0);
  VecX inside = u0;
  for (int v = 0; v < nodes; ++v) {
    if (!C.boundary[v]) continue;
    A.row(v).setZero();
    A.col(v).setZero();
    A(v, v) = 1;
    inside[v] = 0;
  }
  ASSERT_EQ(inside.norm(), 0.05);
  mean = 0.5 * (mean + test::dense_solve(A, inside));
  const VecX expected = normalize(-C.G.apply(mean));

  CellField field = no_field(expected.size() / 2);
  ScalarHeat(C, t, {}, {}, {}, {}).add_nearest(C, system, 1, field, {}, report);
  EXPECT_LT((field.Y - expected).cwiseAbs().maxCoeff(), 1e-9);
}

// Nodes without mass and on the boundary keep their places in the matrices, so that heat and
// distance have factors of one structure.
TEST(ScalarHeat, OnTheStructureOfTheLaplacianItIsTheSame) {
  PolygonSoup soup = test::grid_soup(9, 7, 1);
  soup.points.conservativeResize(soup.points.rows() + 1, 3);
  soup.points.bottomRows(1).setZero();  // in no face
  Report report;
  const test::Problem p =
      test::problem(SurfaceMesh(std::move(soup)), test::vertex_points({34}), report);
  const Calculus& C = p.ops->scalar;
  ASSERT_EQ(C.M[C.M.size() - 1], 0);
  const double t = 0.02;
  const Poisson poisson(C.L, C.component, C.n_components, {});
  const auto order = std::make_shared<const Ordering>(dissection(C.L, {}));
  const ScalarHeat own(C, t, {}, order, nullptr, {});
  const ScalarHeat shared(C, t, {}, order, poisson.structure(), {});
  ASSERT_TRUE(shared.kept()->neumann->factor() && shared.kept()->dirichlet->factor());
  EXPECT_EQ(shared.kept()->neumann->factor()->structure(), poisson.structure());
  EXPECT_EQ(shared.kept()->dirichlet->factor()->structure(), poisson.structure());
  EXPECT_NE(own.kept()->neumann->factor()->structure(), poisson.structure());

  SourceSystem system;
  system.u0.resize(C.M.size(), 1);
  system.u0.insert(34, 0) = 1;
  system.batch_of_points = {1};
  system.batch_value = VecX::Zero(1);
  CellField field = no_field(C.A.size()), expected = no_field(C.A.size());
  own.add_nearest(C, system, 1, expected, {}, report);
  shared.add_nearest(C, system, 1, field, {}, report);
  EXPECT_GT(expected.Y.norm(), 1);
  EXPECT_LT((field.Y - expected.Y).cwiseAbs().maxCoeff(), 1e-12);

  // By dense matrices, whose boundary nodes are the identity's.
  Eigen::MatrixXd L(C.L), A = t * Eigen::MatrixXd(L.selfadjointView<Eigen::Lower>());
  A.diagonal() += C.M;
  for (Eigen::Index v = 0; v < A.rows(); ++v) {
    if (C.M[v] > 0 && !C.boundary[v]) continue;
    A.row(v).setZero();
    A.col(v).setZero();
    A(v, v) = 1;
  }
  const Eigen::MatrixXd lower(shared.kept()->dirichlet->lower());
  EXPECT_LT((Eigen::MatrixXd(lower.selfadjointView<Eigen::Lower>()) - A).norm(), 1e-15);
}

}  // namespace
}  // namespace littoral
