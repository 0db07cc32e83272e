// Sharpened signed distance: slope 1, the signs it had, nearer to exact.

#include "littoral/methods/sharpen.h"

#include <gtest/gtest.h>

#include <cmath>

#include "heat_helpers.h"
#include "littoral/api/distance.h"
#include "littoral/base/error.h"
#include "littoral/operators/tet_operators.h"
#include "test_meshes.h"

namespace littoral {
namespace {

struct Sharpened {
  VecX before, after;
  test::Problem problem;
  Report report;
};

Sharpened sharpened(const SurfaceMesh& mesh, const SurfaceSources& sources, double time_scale,
                    SharpenOptions how = {}) {
  Sharpened s;
  s.problem = test::problem(mesh, sources, s.report);
  SignedHeatOptions options;
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
  const Sharpened s = sharpened(mesh, test::space_curve(circle.topRows(85)), 1);
  EXPECT_GE((s.before.cwiseProduct(s.after)).minCoeff(), 0);
  EXPECT_LT(circle_error(mesh, s.after), circle_error(mesh, s.before));
}

TEST(Sharpen, StraightLineOnThePlaneIsExactByBothSolvers) {
  const SurfaceMesh mesh(test::grid_soup(12, 12, 1));
  SurfaceSources line;
  SurfaceCurve curve;
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
  // A box of 3^3 cubes, five or six tets each are equally good: distance to the plane x = 0.5.
  const int n = 4;
  TetMesh mesh;
  mesh.points.resize((n + 1) * (n + 1) * (n + 1), 3);
  auto id = [](int i, int j, int k) { return i + 5 * (j + 5 * k); };
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) mesh.points.row(id(i, j, k)) << i / 4., j / 4., k / 4.;
  std::vector<std::array<int, 4>> tets;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = id(i, j, k), h = id(i + 1, j + 1, k + 1);
        const int path[6][2] = {{1, 2}, {1, 4}, {2, 1}, {2, 4}, {4, 1}, {4, 2}};
        auto corner = [&](int bits) {
          return id(i + (bits & 1), j + (bits >> 1 & 1), k + (bits >> 2));
        };
        for (const auto& p : path) tets.push_back({a, corner(p[0]), corner(p[0] | p[1]), h});
      }
  mesh.tets.resize(static_cast<Eigen::Index>(tets.size()), 4);
  for (std::size_t t = 0; t < tets.size(); ++t)
    for (int c = 0; c < 4; ++c) mesh.tets(static_cast<Eigen::Index>(t), c) = tets[t][c];
  const auto tet = std::make_shared<const TetOperators>(tet_operators(mesh));
  Operators ops;
  Calculus& C = ops.scalar;
  const Eigen::Index nt = mesh.tets.rows(), nv = mesh.points.rows();
  C.L = tet->L;
  C.A = tet->volumes;
  C.M = VecX::Zero(nv);
  for (Eigen::Index t = 0; t < nt; ++t)
    for (int c = 0; c < 4; ++c) C.M[mesh.tets(t, c)] += C.A[t] / 4;
  C.G.rows = 3 * nt;
  C.G.cols = nv;
  C.G.apply = [&mesh, tet, nt](const VecX& u) {
    VecX g(3 * nt);
    for (Eigen::Index t = 0; t < nt; ++t) {
      Vec3 sum = Vec3::Zero();
      for (int c = 0; c < 4; ++c) sum += u[mesh.tets(t, c)] * tet->gradients[t].row(c).transpose();
      g.segment<3>(3 * t) = sum;
    }
    return g;
  };
  C.G.adjoint = [&mesh, tet, nt, nv](const VecX& g) {
    VecX u = VecX::Zero(nv);
    for (Eigen::Index t = 0; t < nt; ++t)
      for (int c = 0; c < 4; ++c)
        u[mesh.tets(t, c)] += tet->gradients[t].row(c).dot(g.segment<3>(3 * t));
    return u;
  };
  C.h = 0.25;
  C.component = tet->component;
  C.n_components = tet->n_components;
  SourceTerms terms;
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

TEST(Sharpen, ThroughTheFrontDoor) {
  const SurfaceMesh mesh(test::jittered_grid_soup(12, 12, 0.2));
  const auto circle = test::space_curve(test::circle(0.5, 0.5, 0, 0.3, 60));
  Report report;
  const DistanceRequest plain{"signed-heat", {}, false};
  const DistanceRequest sharp{"signed-heat", {{"sharpen", "on"}}, false};
  const VecX a = surface_distance(mesh, circle, plain, {}, report);
  const VecX b = surface_distance(mesh, circle, sharp, {}, report);
  EXPECT_GT((a - b).cwiseAbs().maxCoeff(), 0);
  EXPECT_GE(a.cwiseProduct(b).minCoeff(), 0);
  EXPECT_THROW(
      surface_distance(mesh, circle,
                       {"signed-heat", {{"sharpen", "on"}, {"discontinuous", "on"}}, false}, {},
                       report),
      InputError);
}

}  // namespace
}  // namespace littoral
