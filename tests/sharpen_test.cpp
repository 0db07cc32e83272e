// Sharpened signed distance: unit gradient, the signs it had, nearer to exact.

#include "methods/heat/sharpen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "api/space/sdf.h"
#include "heat_helpers.h"
#include "littoral/error.h"
#include "one_call.h"
#include "operators/grid.h"
#include "operators/tet_operators.h"
#include "space_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

struct Sharpened {
  VecX before, after;
  test::Problem problem;
  Report report;
};

Sharpened sharpened(const SurfaceMesh& mesh, const Sources& sources, double time_scale,
                    SharpenOptions how = {}) {
  Sharpened s;
  s.problem = test::problem(mesh, sources, s.report);
  SignedHeat options;
  options.time_scale = time_scale;
  s.before = test::signed_heat(mesh, sources, options, s.report);
  s.after = sharpen(*s.problem.ops, s.problem.terms, s.before, how, {}, s.report);
  EXPECT_EQ(s.report.status, "converged");
  return s;
}

double longest_gradient(const Sharpened& s) {
  const VecX g = s.problem.ops->scalar.G.apply(s.after) / s.problem.ops->unit;
  double longest = 0;
  for (Eigen::Index c = 0; c < g.size() / 2; ++c)
    longest = std::max(longest, g.segment<2>(2 * c).norm());
  return longest;
}

/// Mean error against the signed distance of the circle about (1/2, 1/2) of radius 0.3.
double circle_error(const SurfaceMesh& mesh, const VecX& phi) {
  double sum = 0;
  for (int v = 0; v < mesh.n_vertices(); ++v)
    sum += std::abs(phi[v] - (0.3 - (mesh.point(v) - Vec3(0.5, 0.5, 0)).norm()));
  return sum / mesh.n_vertices();
}

TEST(Sharpen, EveryComponentIsAProblemOfItsOwn) {
  // The same square twice, one a thousand times smaller: both as each alone.
  const double small = 1e-3;
  const PolygonSoup one = test::jittered_grid_soup(12, 12, 0.3);
  const int n = one.n_vertices();
  PolygonSoup both = one;
  both.points.conservativeResize(2 * n, 3);
  both.points.bottomRows(n) = small * one.points;
  both.points.bottomRows(n).col(0).array() += 3;
  for (const int v : one.corners) both.corners.push_back(v + n);
  for (int f = 0; f < one.n_faces(); ++f) both.face_offsets.push_back(both.face_offsets.back() + 3);
  const SurfaceMesh mesh(both), alone(one);
  Sources sources, own;
  for (const int first : {0, n}) {
    Curve& curve = sources.curves.emplace_back();
    for (int j = 0; j <= 12; ++j)
      curve.nodes.push_back(SurfacePoint::at_vertex(first + 6 + 13 * j));
  }
  own.curves = {sources.curves[0]};
  const SignedHeat method{.sharpen = Sharpening::on};
  Report report, other;
  const VecX phi = test::surface_distance(mesh, sources, method, report);
  const VecX expected = test::surface_distance(alone, own, method, other);
  const double range = expected.cwiseAbs().maxCoeff();
  EXPECT_GT(range, 0.4);
  EXPECT_LT((phi.head(n) - expected).cwiseAbs().maxCoeff(), 0.03 * range);
  EXPECT_LT((phi.tail(n) / small - expected).cwiseAbs().maxCoeff(), 0.1 * range);
  EXPECT_EQ(report.status, "converged");
}

TEST(Sharpen, StrongDiffusionEndsAtSlopeOne) {
  // Figure 15: t = 100 h^2.
  const SurfaceMesh mesh(test::jittered_grid_soup(24, 24, 0.3));
  const auto circle = test::space_curve(test::circle(0.5, 0.5, 0, 0.3, 100));
  const Sharpened s = sharpened(mesh, circle, 400);
  EXPECT_LT(circle_error(mesh, s.after), 0.004);  // edges of 1/24
  EXPECT_LT(longest_gradient(s), 1.03);
  EXPECT_GE((s.before.cwiseProduct(s.after)).minCoeff(), 0);
}

TEST(Sharpen, BrokenCurvesKeepTheirSigns) {
  const SurfaceMesh mesh(test::jittered_grid_soup(24, 24, 0.3));
  const MatX3 circle = test::circle(0.5, 0.5, 0, 0.3, 100);
  const Sharpened s = sharpened(mesh, test::space_curve(circle.topRows(85)), 100);
  EXPECT_GE((s.before.cwiseProduct(s.after)).minCoeff(), 0);
  EXPECT_LT(circle_error(mesh, s.after), circle_error(mesh, s.before));
}

TEST(Sharpen, StraightLineOnThePlaneIsExactByBothSolvers) {
  const SurfaceMesh mesh(test::grid_soup(12, 12, 1));
  Sources line;
  Curve curve;
  for (int i = 0; i <= 12; ++i) curve.nodes.push_back(SurfacePoint::at_vertex(6 * 13 + i));
  line.curves.push_back(curve);
  SharpenOptions how;
  for (const SharpenSolver solver : {SharpenSolver::admm, SharpenSolver::pdhg}) {
    how.solver = solver;
    const Sharpened s = sharpened(mesh, line, 16, how);
    for (int v = 0; v < mesh.n_vertices(); ++v)
      EXPECT_NEAR(s.after[v], mesh.point(v).y() - 0.5, 5e-3) << v;
  }
}

TEST(Sharpen, SolversAgreeAndScaleDoesNotMatter) {
  PolygonSoup soup = test::torus_soup(20, 12);
  const auto source = test::vertex_points({3});
  const VecX u = sharpened(SurfaceMesh(soup), source, 16).after;
  SharpenOptions how;
  how.solver = SharpenSolver::pdhg;
  const VecX w = sharpened(SurfaceMesh(soup), source, 16, how).after;
  EXPECT_LT((u - w).cwiseAbs().maxCoeff(), 0.02 * u.maxCoeff());
  soup.points *= 1e3;
  const VecX scaled = sharpened(SurfaceMesh(soup), source, 16).after;
  EXPECT_LT((scaled / 1e3 - u).cwiseAbs().maxCoeff(), 1e-6 * u.maxCoeff());
}

TEST(Sharpen, ComponentsWithoutASourceStayInfinite) {
  PolygonSoup soup = test::grid_soup(4, 4);
  const int n = soup.n_vertices();
  const PolygonSoup other = test::octasphere_soup(1);
  soup.points.conservativeResize(n + other.n_vertices(), 3);
  soup.points.bottomRows(other.n_vertices()) = other.points.array() + 5;
  for (int f = 0; f < other.n_faces(); ++f)
    test::add_triangle(soup, n + other.face(f)[0], n + other.face(f)[1], n + other.face(f)[2]);
  const Sharpened s = sharpened(SurfaceMesh(soup), test::vertex_points({0}), 16);
  EXPECT_TRUE(s.after.head(n).allFinite());
  EXPECT_TRUE((s.after.tail(other.n_vertices()).array() > 1e300).all());
}

TEST(Sharpen, TetsFromAPlane) {
  const TetMesh mesh = test::tet_box(4);  // distance to the plane x = 0.5
  Operators ops;
  ops.scalar = tet_calculus(std::make_shared<const TetOperators>(tet_operators(mesh)));
  const Eigen::Index nv = mesh.n_vertices();
  SourceSystem terms;
  terms.reached = {1};
  Triplets rows;
  VecX phi0(nv);
  for (Eigen::Index v = 0; v < nv; ++v) {
    phi0[v] = std::pow(mesh.points(v, 0) - 0.5, 3);
    if (phi0[v] == 0) rows.emplace_back(static_cast<int>(rows.size()), static_cast<int>(v), 1);
  }
  terms.A.resize(static_cast<Eigen::Index>(rows.size()), nv);
  terms.A.setFromTriplets(rows.begin(), rows.end());
  Report report;
  const VecX phi = sharpen(ops, terms, phi0, {}, {}, report);
  EXPECT_EQ(report.status, "converged");
  for (Eigen::Index v = 0; v < nv; ++v) EXPECT_NEAR(phi[v], mesh.points(v, 0) - 0.5, 5e-3) << v;
}

/// Operators of triangles in the plane.
Operators plane_operators(const std::vector<Vec2>& x,
                          const std::vector<std::array<int, 3>>& faces) {
  Operators ops;
  Calculus& C = ops.scalar;
  const auto n = static_cast<Eigen::Index>(x.size()), m = static_cast<Eigen::Index>(faces.size());
  C.A.resize(m);
  C.M = VecX::Zero(n);
  Triplets entries;
  for (int f = 0; f < m; ++f)
    for (int k = 0; k < 3; ++k) {
      const Vec2 &a = x[faces[f][k]], &b = x[faces[f][(k + 1) % 3]], &c = x[faces[f][(k + 2) % 3]];
      const double twice = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
      C.A[f] = twice / 2;
      C.M[faces[f][k]] += twice / 6;
      entries.emplace_back(2 * f, faces[f][k], (b - c).y() / twice);
      entries.emplace_back(2 * f + 1, faces[f][k], (c - b).x() / twice);
    }
  SpRows G(2 * m, n);
  G.setFromTriplets(entries.begin(), entries.end());
  VecX weight(2 * m);
  for (int f = 0; f < m; ++f) weight[2 * f] = weight[2 * f + 1] = C.A[f];
  const MatX L = MatX(G).transpose() * weight.asDiagonal() * MatX(G);
  C.L = SpMat(MatX(L.triangularView<Eigen::Lower>()).sparseView());
  C.G.rows = 2 * m;
  C.G.cols = n;
  C.G.apply = [G](const VecX& u) { return VecX(G * u); };
  C.G.matrix = [G] { return G; };
  C.h = 1;
  C.component.assign(x.size(), 0);
  C.n_components = 1;
  return ops;
}

TEST(Sharpen, NodesOnTheZeroSetHoldWhatIsBesideThem) {
  // The zero set goes through node 1, near node 0, and leaves the other triangle far from that.
  const Operators ops =
      plane_operators({{0, 0}, {0.2, 0}, {0, 2}, {-2, 0}}, {{0, 1, 2}, {3, 0, 2}});
  const VecX phi0 = Eigen::Vector4d(0.1, 0, -0.1, 0.1);
  SourceSystem terms;
  terms.reached = {1};
  terms.A.resize(1, 4);
  terms.A.insert(0, 1) = 1;
  Report report;
  const VecX phi = sharpen(ops, terms, phi0, {}, {}, report);
  EXPECT_EQ(report.status, "converged");
  EXPECT_EQ(phi[1], 0);
  EXPECT_GT(phi[0], 0);
  EXPECT_LT(phi[0], 0.205);
  EXPECT_GT(phi[3], 0.5);
}

TEST(Sharpen, NodesWithoutASignStayZero) {
  // Node 4 lies far from the zero set and has a value of the size of rounding.
  const Operators ops = plane_operators({{0, 0}, {0.2, 0}, {0, 2}, {-2, 0}, {-3, -1}},
                                        {{0, 1, 2}, {3, 0, 2}, {4, 0, 3}});
  SourceSystem terms;
  terms.reached = {1};
  terms.A.resize(1, 5);
  terms.A.insert(0, 1) = 1;
  VecX phi0(5);
  for (const double value : {1e-12, 0.1}) {
    phi0 << 0.1, 0, -0.1, 0.1, value;
    Report report;
    const VecX phi = sharpen(ops, terms, phi0, {}, {}, report);
    EXPECT_GT(phi[3], 0.5);
    if (value < 0.1)
      EXPECT_EQ(phi[4], 0);
    else
      EXPECT_GT(phi[4], 0.5);
  }
}

TEST(Sharpen, GridAroundASphere) {
  Grid grid;
  grid.n = {17, 17, 17};
  grid.origin.setConstant(-1);
  grid.spacing.setConstant(0.125);
  Operators ops;
  ops.scalar = grid_calculus(grid);
  // Flattened far away, steepened near: only the zero set is right, r = 0.6.
  VecX phi0(static_cast<Eigen::Index>(grid.n_nodes())), r(phi0.size());
  for (int k = 0; k < 17; ++k)
    for (int j = 0; j < 17; ++j)
      for (int i = 0; i < 17; ++i) {
        const auto node = static_cast<Eigen::Index>(grid.node(i, j, k));
        r[node] = grid.point(i, j, k).norm();
        phi0[node] = std::tanh(3 * (r[node] - 0.6)) / 3;
      }
  PolygonSoup sphere = test::octasphere_soup(3);
  const MatX3 on_it = 0.6 * sphere.points;
  const SpMat rows = grid_rows(grid, on_it, VecX::Ones(on_it.rows())).A;
  for (const SharpenSolver solver : {SharpenSolver::pdhg, SharpenSolver::admm}) {
    Report report;
    const VecX phi = sharpen_in_space(ops, rows, phi0, solver, {}, report);
    EXPECT_EQ(report.status, "converged");
    EXPECT_GE(phi.cwiseProduct(phi0).minCoeff(), 0);
    double before = 0, after = 0;
    for (Eigen::Index v = 0; v < phi.size(); ++v) {
      before += std::abs(phi0[v] - (r[v] - 0.6));
      after += std::abs(phi[v] - (r[v] - 0.6));
    }
    EXPECT_LT(after, 0.25 * before);
    EXPECT_LT(after / static_cast<double>(phi.size()), 0.03);  // a quarter of the spacing
  }
}

TEST(GridCalculus, FitsTogetherAndIsExactForLinearFunctions) {
  Grid grid;
  grid.n = {5, 4, 3};
  grid.origin << 1, 2, 3;
  grid.spacing << 0.5, 0.25, 1;
  const Calculus C = grid_calculus(grid);
  VecX u(60), v(60), linear(60);
  for (int i = 0; i < 60; ++i) {
    u[i] = std::sin(7.1 * i);
    v[i] = std::cos(3.3 * i);
    linear[i] = Vec3(2, -1, 0.5).dot(grid.point(i % 5, i / 5 % 4, i / 20));
  }
  const VecX Gu = C.G.apply(u);
  EXPECT_LT((C.G.matrix() * u - Gu).norm(), 1e-12);
  const VecX Lu = C.L.selfadjointView<Eigen::Lower>() * u;
  EXPECT_LT((C.divergence(Gu) - Lu).norm(), 1e-12 * Lu.norm());
  EXPECT_NEAR(Gu.dot(C.G.apply(v)), v.dot(C.G.adjoint(Gu)), 1e-10);
  EXPECT_LT((C.G.apply(linear).segment<3>(0) - Vec3(2, -1, 0.5)).norm(), 1e-12);
}

TEST(GridCalculus, NodesOnTheBoxAreItsBoundary) {
  Grid grid;
  grid.n = {5, 4, 3};
  grid.spacing << 0.5, 0.25, 1;
  const Calculus C = grid_calculus(grid);
  EXPECT_EQ(std::count(C.boundary.begin(), C.boundary.end(), 0), 3 * 2 * 1);
  for (int j = 1; j < 3; ++j)
    for (int i = 1; i < 4; ++i) EXPECT_EQ(C.boundary[std::size_t(grid.node(i, j, 1))], 0);
  EXPECT_EQ(C.n_components, 1);
  EXPECT_DOUBLE_EQ(C.M.sum(), 60 * 0.125);
  EXPECT_DOUBLE_EQ(C.h, 1.75 / 3);
}

/// Nodes at most two spacings from the surface whose value is less than a quarter of what it should
/// be, although that is more than a spacing: dents.
int dents(const Grid& grid, const VecX& phi, const std::function<double(const Vec3&)>& exact) {
  int count = 0;
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) {
        const double d = std::abs(exact(grid.point(i, j, k))), h = grid.spacing[0];
        const double u = std::abs(phi[static_cast<Eigen::Index>(grid.node(i, j, k))]);
        if (d > h && d < 2.5 * h && u < 0.25 * d) ++count;
      }
  return count;
}

TEST(SharpenSlow, SpheresAndBoxesOnGridsGetNoDents) {
  const Grid grid = test::cube_grid(19, 1.5);
  const Vec3 half(0.9, 0.7, 0.5);
  const auto ball = [](const Vec3& x) { return x.norm() - 1; };
  const auto box = [half](const Vec3& x) { return test::box_distance(x, half); };
  const std::pair<PolygonSoup, std::function<double(const Vec3&)>> shapes[] = {
      {test::octasphere_soup(4), ball}, {test::box_soup(half), box}};
  for (const auto& [soup, exact] : shapes) {
    Report report;
    const VecX plain = grid_distance(soup, grid, {SpaceSignedHeat{}}, {}, report);
    const VecX sharp = grid_distance(soup, grid, {SpaceSignedHeat{.sharpen = true}}, {}, report);
    EXPECT_EQ(report.status, "converged");
    EXPECT_GE(sharp.cwiseProduct(plain).minCoeff(), 0);
    EXPECT_EQ(dents(grid, sharp, exact), 0);
    EXPECT_LT(test::mean_error(grid, sharp, exact),
              std::max(0.02, 0.85 * test::mean_error(grid, plain, exact)));
  }
}

TEST(Sharpen, ThroughTheFrontDoor) {
  const SurfaceMesh mesh(test::jittered_grid_soup(12, 12, 0.2));
  const auto circle = test::space_curve(test::circle(0.5, 0.5, 0, 0.3, 60));
  Report report;
  const VecX a = test::surface_distance(mesh, circle, SignedHeat{}, report);
  const VecX b =
      test::surface_distance(mesh, circle, SignedHeat{.sharpen = Sharpening::on}, report);
  EXPECT_GT((a - b).cwiseAbs().maxCoeff(), 0);
  EXPECT_GE(a.cwiseProduct(b).minCoeff(), 0);
  EXPECT_THROW(
      test::surface_distance(mesh, circle,
                             SignedHeat{.discontinuous = true, .sharpen = Sharpening::on}, report),
      InputError);
}

}  // namespace
}  // namespace littoral
