// Quadratic elements: exact on quadratics, exact integrals, one calculus with the linear ones.

#include "operators/p2.h"

#include <gtest/gtest.h>

#include "littoral/error.h"
#include "methods/quadratic/quadratic_program.h"
#include "test_meshes.h"

namespace littoral {
namespace {

P2Elements<2> elements(const SurfaceMesh& mesh) {
  Report report;
  return p2_elements(intrinsic_triangulation(mesh, report));
}

/// Nodal values of a function of the position.
VecX nodal(const SurfaceMesh& mesh, const P2Elements<2>& E,
           const std::function<double(const Vec3&)>& f) {
  VecX u(E.n_nodes());
  for (int v = 0; v < mesh.n_vertices(); ++v) u[v] = f(mesh.point(v));
  for (int e = 0; e < mesh.n_edges(); ++e)
    u[mesh.n_vertices() + e] =
        f(0.5 * (mesh.point(mesh.edges()(e, 0)) + mesh.point(mesh.edges()(e, 1))));
  return u;
}

double quadratic(const Vec3& p) { return 3 + p[0] - 2 * p[1] + p[0] * p[0] - p[0] * p[1]; }

TEST(P2, ReproducesQuadraticsAndTheirGradients) {
  const SurfaceMesh mesh(test::jittered_grid_soup(4, 3, 0.2));
  const P2Elements<2> E = elements(mesh);
  const VecX u = nodal(mesh, E, quadratic);
  const P2Shape<2>::Point b(0.2, 0.5, 0.3);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const Vec3 p = mesh.position(SurfacePoint::in_face(f, b[0], b[1], b[2]));
    EXPECT_NEAR(E.value(u, f, b), quadratic(p), 1e-13);
    const double squared = std::pow(1 + 2 * p[0] - p[1], 2) + std::pow(-2 - p[0], 2);
    EXPECT_NEAR(E.gradient(u, f, b).squaredNorm() / std::pow(E.unit, 2), squared, 1e-11);
  }
}

TEST(P2, IntegratesQuadraticsAndProductsExactly) {
  const SurfaceMesh mesh(test::jittered_grid_soup(3, 3, 0.2));
  const P2Elements<2> E = elements(mesh);
  const double unit = std::pow(E.unit, 2);
  const VecX one = VecX::Ones(E.n_nodes());
  const VecX x2 = nodal(mesh, E, [](const Vec3& p) { return p[0] * p[0]; });
  const VecX xy = nodal(mesh, E, [](const Vec3& p) { return p[0] * p[1]; });
  EXPECT_NEAR(E.integral().dot(x2) * unit, 1.0 / 3, 1e-14);
  EXPECT_NEAR(one.dot(E.mass() * one) * unit, 1, 1e-14);
  EXPECT_NEAR(x2.dot(E.mass() * xy) * unit, 1.0 / 8, 1e-14);  // x^3 y
  EXPECT_NEAR((E.mass() * one - E.integral()).norm(), 0, 1e-14);
}

TEST(P2, MassMatrixOfOneTriangleIsThePapers) {
  PolygonSoup soup;
  soup.points.resize(3, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  test::add_triangle(soup, 0, 1, 2);
  const SurfaceMesh mesh(soup);
  const P2Elements<2> E = elements(mesh);
  // Node order 200, 020, 002, 110, 011, 101 (appendix B.1).
  Eigen::Matrix<double, 6, 6> M;
  M << 6, -1, -1, 0, -4, 0, -1, 6, -1, 0, 0, -4, -1, -1, 6, -4, 0, 0, 0, 0, -4, 32, 16, 16, -4, 0,
      0, 16, 32, 16, 0, -4, 0, 16, 16, 32;
  EXPECT_NEAR((Eigen::MatrixXd(E.mass()) - E.measure[0] / 180 * M).norm(), 0, 1e-15);
}

TEST(P2, CalculusIsConsistent) {
  const SurfaceMesh mesh(test::octasphere_soup(2));
  const P2Elements<2> E = elements(mesh);
  const Calculus C = p2_calculus(E);
  const VecX u = nodal(mesh, E, quadratic), v = nodal(mesh, E, [](const Vec3&p) { return p[2]; });
  const VecX Lu = C.L.selfadjointView<Eigen::Lower>() * u;
  EXPECT_NEAR((C.divergence(C.G.apply(u)) - Lu).norm(), 0, 1e-11 * Lu.norm());
  EXPECT_NEAR(C.G.apply(VecX::Ones(u.size())).norm(), 0, 1e-11);
  const VecX Gu = C.G.apply(u);
  EXPECT_LE((C.G.matrix() * u - Gu).norm(), 1e-12 * Gu.norm());
  EXPECT_NEAR(Gu.dot(C.G.apply(v)), v.dot(C.G.adjoint(Gu)), 1e-9);
  EXPECT_NEAR(C.M.sum(), C.A.sum(), 1e-12);
  EXPECT_GT(C.M.minCoeff(), 0);
}

TEST(P2, NodesOnTheBoundaryAreMarkedAndMassesAreThoseOfTheirElements) {
  const SurfaceMesh mesh(test::jittered_grid_soup(4, 3, 0.2));
  const P2Elements<2> E = elements(mesh);
  const Calculus C = p2_calculus(E);
  VecX x(E.n_nodes()), y(E.n_nodes());
  x = nodal(mesh, E, [](const Vec3& p) { return p[0]; });
  y = nodal(mesh, E, [](const Vec3& p) { return p[1]; });
  int on_boundary = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const bool at_end =
        x[i] < 1e-12 || x[i] > x.maxCoeff() - 1e-12 || y[i] < 1e-12 || y[i] > y.maxCoeff() - 1e-12;
    EXPECT_EQ(C.boundary[static_cast<std::size_t>(i)] != 0, at_end) << x[i] << " " << y[i];
    on_boundary += at_end;
  }
  EXPECT_EQ(on_boundary, 2 * (2 * 4 + 2 * 3));
  const SurfaceMesh closed(test::octasphere_soup(1));
  for (const char b : p2_calculus(elements(closed)).boundary) EXPECT_EQ(b, 0);
}

TEST(P2, TetrahedraIntegrateAndReproduceQuadraticsToo) {
  P2Elements<3> E;
  E.n_vertices = 4;
  E.n_edges = 6;
  E.node.push_back({0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  E.grad.emplace_back();
  E.grad[0] << -1, 1, 0, 0, -1, 0, 1, 0, -1, 0, 0, 1;
  E.measure = VecX::Constant(1, 1.0 / 6);
  const MatX3 corner = (MatX3(4, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1).finished();
  const auto f = [](const Vec3& p) { return p[0] * p[1] + p[2] * p[2] - p[0]; };
  VecX u(10);
  for (int i = 0; i < 4; ++i) u[i] = f(corner.row(i));
  for (int k = 0; k < 6; ++k) {
    const auto [i, j] = P2Shape<3>::edge(k);
    u[4 + k] = f(0.5 * (corner.row(i) + corner.row(j)));
  }
  const P2Shape<3>::Point b(0.1, 0.2, 0.3, 0.4);
  EXPECT_NEAR(E.value(u, 0, b), f({0.2, 0.3, 0.4}), 1e-15);
  EXPECT_NEAR((E.gradient(u, 0, b) - Vec3(0.3 - 1, 0.2, 0.8)).norm(), 0, 1e-14);
  EXPECT_NEAR(E.integral().dot(u), 1.0 / 120 + 1.0 / 60 - 1.0 / 24, 1e-15);
  EXPECT_NEAR((E.mass() * VecX::Ones(10) - E.integral()).norm(), 0, 1e-15);
}

TEST(P2, MinimumOfAQuadraticOnATriangle) {
  // (x - 0.3)^2 + (y - 0.2)^2 - 0.01 with x, y the second and third barycentrics.
  const auto s = [](const P2Shape<2>::Point& b) {
    return std::pow(b[1] - 0.3, 2) + std::pow(b[2] - 0.2, 2) - 0.01;
  };
  P2Shape<2>::Values values;
  for (int i = 0; i < 3; ++i) {
    values[i] = s(P2Shape<2>::corner(i));
    values[3 + i] = s(P2Shape<2>::middle(i));
  }
  const auto [least, b] = p2_minimum<2>(values);
  EXPECT_NEAR(least, -0.01, 1e-14);
  EXPECT_NEAR((b - P2Shape<2>::Point(0.5, 0.3, 0.2)).norm(), 0, 1e-12);
  for (int i = 0; i < 3; ++i) values[3 + i] = 0.5 * (values[i] + values[(i + 1) % 3]);  // linear
  EXPECT_EQ(p2_minimum<2>(values).first, values.head<3>().minCoeff());
}

}  // namespace
}  // namespace littoral
