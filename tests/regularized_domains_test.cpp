// Regularized distance on everything that has operators: tets, quadratic elements, polygon meshes,
// point clouds, voxel surfaces; and from the boundary.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "domain/volume/voxels.h"
#include "littoral/error.h"
#include "one_call.h"
#include "operators/tet_operators.h"
#include "regularized_helpers.h"
#include "sources/curves/boundary_curves.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::solve;
using test::with_alpha;

/// Quads on the unit square.
PolygonSoup quads(int n) {
  const PolygonSoup triangles = test::grid_soup(n, n);
  PolygonSoup soup;
  soup.points = triangles.points;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = i + j * (n + 1);
      soup.add_face(std::array{a, a + 1, a + n + 2, a + n + 1});
    }
  return soup;
}

/// Every vertex of the side x = 0.
Sources left_side(const SurfaceMesh& mesh) {
  Sources sources;
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (mesh.point(v).x() == 0) sources.points.push_back(SurfacePoint::at_vertex(v));
  return sources;
}

VecX by_name(const SurfaceMesh& mesh, const Sources& sources, OptionValues options,
             const MatX3* normals = nullptr, const char* tolerance = "1e-4") {
  options.emplace_back("tolerance", tolerance);
  Report report;
  VecX u = test::surface_distance(mesh, sources, AnyMethod::named("regularized", options), report,
                                  normals);
  EXPECT_EQ(report.status, "converged");
  return u;
}

TEST(RegularizedDomains, IntervalOnTrianglesQuadsAndQuadraticElements) {
  const double alpha = 0.4;  // the area is 1, so alpha-hat is alpha
  for (const bool polygons : {false, true})
    for (const char* elements : {"linear", "quadratic"}) {
      if (polygons && *elements == 'q') continue;
      const SurfaceMesh mesh(polygons ? quads(16) : test::grid_soup(16, 16, 1));
      const VecX u = by_name(mesh, left_side(mesh), {{"alpha", "0.4"}, {"elements", elements}});
      for (int v = 0; v < mesh.n_vertices(); ++v)
        EXPECT_NEAR(u[v], test::from_one_end(mesh.point(v).x(), alpha), 4e-3) << elements << v;
    }
}

TEST(RegularizedDomains, IntervalOnTets) {
  // Figure 13: the same class on three numbers a cell.
  const TetMesh mesh = test::tet_box(8);
  auto ops = std::make_shared<Operators>();
  ops->scalar = tet_calculus(std::make_shared<const TetOperators>(tet_operators(mesh)));
  KnownDistances side;
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (mesh.points(v, 0) == 0) side.emplace(v, 0);
  const RegularizedSolver method(ops, Regularizer::dirichlet, {}, {});
  for (const double alpha : {0.0, 0.3}) {
    Report report;
    const VecX u = method.solve(side, with_alpha(alpha), {}, report);
    EXPECT_EQ(report.status, "converged");
    for (int v = 0; v < mesh.n_vertices(); ++v)
      EXPECT_NEAR(u[v], test::from_one_end(mesh.points(v, 0), alpha), 0.02) << alpha << " " << v;
  }
}

TEST(RegularizedDomains, TetsTendToTheDistance) {
  const TetMesh mesh = test::tet_box(8);
  auto ops = std::make_shared<Operators>();
  ops->scalar = tet_calculus(std::make_shared<const TetOperators>(tet_operators(mesh)));
  const KnownDistances corner = {{0, 0}};  // of the cube
  const RegularizedSolver method(ops, Regularizer::dirichlet, {}, {});
  double before = 1e9;
  for (const double alpha : {0.4, 0.1, 0.0}) {
    Report report;
    const VecX u = method.solve(corner, with_alpha(alpha, 1e-3), {}, report);
    double worst = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v)
      worst = std::max(worst, std::abs(u[v] - mesh.points.row(v).norm()));
    EXPECT_LT(worst, before);
    before = worst;
  }
  EXPECT_LT(before, 0.2);  // first order in edges of 1/8 at a point
}

/// A circle of radius 0.3 about the middle of the unit square, between vertices.
Sources circle_in_the_square() {
  return test::space_curve(test::circle(0.5, 0.5, 0, 0.3, 200), false);
}
double from_circle(const Vec3& x) { return std::abs((x - Vec3(0.5, 0.5, 0)).norm() - 0.3); }

TEST(RegularizedDomains, ACurveBetweenNodesHasItsDistanceOnBothSides) {
  // Were the interpolated value 0 along the curve, the inside would be 0.4 to 0.7 h too near.
  for (const int n : {12, 24}) {
    const SurfaceMesh triangles(test::jittered_grid_soup(n, n, 0.2)), squares(quads(n));
    for (const auto& [mesh, elements] :
         {std::pair(&triangles, "linear"), {&triangles, "quadratic"}, {&squares, "linear"}}) {
      const VecX u = by_name(*mesh, circle_in_the_square(),
                             {{"alpha", "0"}, {"elements", elements}}, nullptr, "1e-3");
      for (const bool inside : {true, false}) {
        const double error = test::mean_error(
            mesh->points(), u, from_circle,
            [inside](const Vec3& x) { return ((x - Vec3(0.5, 0.5, 0)).norm() < 0.3) == inside; });
        EXPECT_LT(error * n, *elements == 'q' ? 0.26 : 0.2) << elements << n << inside;
      }
    }
  }
}

TEST(RegularizedDomains, ALineThroughFacesIsExact) {
  // Of gradient at most 1 and at most the distance at the corners of the faces that it crosses,
  // nothing is larger than the distance; and on these faces that is allowed.
  const SurfaceMesh mesh(test::grid_soup(12, 12, 1));
  MatX3 line(2, 3);
  line << 0, 0.53, 0, 1, 0.53, 0;
  for (const Regularizer regularizer :
       {Regularizer::dirichlet, Regularizer::hessian, Regularizer::max_norm}) {
    const VecX u = solve(mesh, test::space_curve(line, false), with_alpha(0, 1e-5), regularizer).u;
    for (int v = 0; v < mesh.n_vertices(); ++v)
      EXPECT_NEAR(u[v], std::abs(mesh.point(v).y() - 0.53), 2e-3) << v;
  }
}

TEST(RegularizedDomains, SmoothingIsTheSameHoweverAlphaEnters) {
  // From a line along edges by Alg. 1 and from one just beside it, whose nodes have bounds.
  const SurfaceMesh mesh(test::grid_soup(12, 12, 1));
  const double alpha = 0.3;
  for (const double x : {0.0, 0.02}) {
    MatX3 line(2, 3);
    line << x, 0, 0, x, 1, 0;
    const VecX u = solve(mesh, test::space_curve(line, false), with_alpha(alpha, 1e-5)).u;
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const double y = mesh.point(v).x();
      EXPECT_NEAR(u[v], y < x ? x - y : test::from_one_end(y, alpha) - x, 6e-3) << x << " " << v;
    }
  }
}

TEST(RegularizedDomains, QuadraticElementsAreRounder) {
  // Figure S6: from a point of a coarse mesh, linear functions have polygons for isolines.
  const SurfaceMesh mesh(test::octasphere_soup(2));
  auto error = [&](const char* elements) {
    const VecX u =
        by_name(mesh, test::vertex_points({4}), {{"alpha", "0"}, {"elements", elements}});
    double sum = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v)
      sum += std::abs(u[v] - std::acos(std::clamp(mesh.point(v).z(), -1., 1.)));
    return sum / mesh.n_vertices();
  };
  EXPECT_LT(error("quadratic"), 0.6 * error("linear"));
}

TEST(RegularizedDomains, GradientsAtCornersOfQuadraticElementsAreReported) {
  for (const double scale : {1.0, 1e3}) {
    PolygonSoup soup = test::octasphere_soup(2);
    soup.points *= scale;
    Report report;
    test::surface_answer(SurfaceMesh(soup), test::vertex_points({4}),
                         Regularized{.elements = Elements::quadratic}, report);
    const double between = test::residual(report, "largest gradient over 1");
    const double corners = test::residual(report, "largest gradient over 1, at corners");
    EXPECT_LT(between, 0.2);
    EXPECT_GT(corners, between);
    EXPECT_LT(corners, 3);
  }
}

TEST(RegularizedDomains, QuadraticElementsShowWhatIsBetween) {
  const SurfaceMesh mesh(test::octasphere_soup(1));
  Report report;
  const SurfaceAnswer result =
      test::surface_answer(mesh, test::vertex_points({0}),
                           Regularized{.elements = Elements::quadratic, .subdivide = 3}, report);
  ASSERT_TRUE(result.shown);
  EXPECT_EQ(result.shown->n_faces(), 9 * mesh.n_faces());
  const VecX& d = result.shown->scalars.at("distance");
  EXPECT_TRUE(d.allFinite());
  EXPECT_GE(d.minCoeff(), 0);
  EXPECT_EQ((d.head(mesh.n_vertices()) - result.values).cwiseAbs().maxCoeff(), 0);
}

TEST(RegularizedDomains, CloudsAndVoxelsTendToTheDistance) {
  PolygonSoup cloud = test::octasphere_soup(3);
  cloud.normals = cloud.points;
  PolygonSoup points;
  points.points = cloud.points;
  points.normals = cloud.normals;
  const SurfaceMesh sphere(points);
  double before = 1e9;
  for (const char* alpha : {"0.4", "0.1", "0"}) {
    const VecX u = by_name(sphere, test::vertex_points({4}), {{"alpha", alpha}});
    double worst = 0;
    for (int v = 0; v < sphere.n_vertices(); ++v)
      worst = std::max(worst, std::abs(u[v] - std::acos(std::clamp(sphere.point(v).z(), -1., 1.))));
    EXPECT_LT(worst, before);
    before = worst;
  }
  EXPECT_LT(before, 0.3);

  Grid grid;
  grid.n = {12, 12, 12};
  grid.origin.setZero();
  grid.spacing.setOnes();
  std::vector<unsigned char> inside(static_cast<std::size_t>(grid.n_nodes()), 0);
  for (int k = 1; k < 11; ++k)
    for (int j = 1; j < 11; ++j)
      for (int i = 1; i < 11; ++i) inside[grid.node(i, j, k)] = 1;
  const VoxelSurface box = boundary_of_voxels(grid, inside);
  const VecX u = by_name(box.mesh, test::vertex_points({0}), {{"alpha", "0"}}, &box.face_normals);
  for (int v = 0; v < box.mesh.n_vertices(); ++v) {
    const Vec3 d = (box.mesh.point(v) - box.mesh.point(0)).cwiseAbs();
    EXPECT_GT(u[v], 0.7 * d.norm() - 1);
    EXPECT_LT(u[v], 1.2 * d.sum() + 1);
  }
}

TEST(RegularizedDomains, SaysWhatADomainDoesNotHave) {
  Report report;
  const SurfaceMesh mesh(quads(3)), triangles(test::grid_soup(3, 3));
  const auto asked = [&](const SurfaceMesh& on, const OptionValues& options) {
    return test::surface_distance(on, test::vertex_points({0}),
                                  AnyMethod::named("regularized", options), report);
  };
  EXPECT_THROW(asked(mesh, {{"regularizer", "hessian"}}), UnsupportedError);
  EXPECT_THROW(asked(mesh, {{"regularizer", "max-norm"}}), UnsupportedError);
  EXPECT_THROW(asked(mesh, {{"elements", "quadratic"}}), UnsupportedError);
  EXPECT_THROW(asked(triangles, {{"elements", "quadratic"}, {"regularizer", "hessian"}}),
               UnsupportedError);
  EXPECT_THROW(asked(triangles, {{"elements", "cubic"}}), InputError);
}

TEST(RegularizedDomains, PairsWithQuadraticElements) {
  const SurfaceMesh mesh(test::octasphere_soup(1));
  Report report;
  const Regularized options{.tolerance = 1e-4, .elements = Elements::quadratic};
  const MatX rows = test::pair_distances(mesh, {3}, options, report).distances;
  const VecX alone = by_name(mesh, test::vertex_points({3}), {{"elements", "quadratic"}});
  EXPECT_LT((rows.row(0).transpose() - alone).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(BoundaryCurves, LoopsAreClosedAndDistanceGrowsInward) {
  const SurfaceMesh mesh(test::jittered_grid_soup(12, 12, 0.2));
  const std::vector<Curve> loops = boundary_curves(mesh);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].nodes.size(), 49U);
  EXPECT_EQ(loops[0].nodes.front().element, loops[0].nodes.back().element);
  EXPECT_FALSE(loops[0].is_signed);
  Sources boundary;
  boundary.curves = loops;
  for (const char* method : {"regularized", "exact", "fast-marching"}) {
    Report report;
    OptionValues options;
    if (*method == 'r') options = {{"alpha", "0"}, {"tolerance", "1e-4"}};
    const VecX u =
        test::surface_distance(mesh, boundary, AnyMethod::named(method, options), report);
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const Vec3 p = mesh.point(v);
      const double d = std::min({p.x(), p.y(), 1 - p.x(), 1 - p.y()});
      EXPECT_NEAR(u[v], d, 0.025) << method << v;
    }
  }
  EXPECT_TRUE(boundary_curves(SurfaceMesh(test::octasphere_soup(1))).empty());
  EXPECT_EQ(boundary_curves(test::ring(12, 2, 0.1)).size(), 2U);
}

TEST(RegularizedDomains, TrianglesWithoutAreaLeaveTheHessianDefinite) {
  PolygonSoup soup = test::grid_soup(5, 5);
  for (int v = 0; v < soup.n_vertices(); ++v)
    soup.points(v, 2) = 0.25 + 0.2 * std::sin(7.0 * v + 0.1 * v * v);
  soup.points.row(15) = soup.points.row(14);
  const SurfaceMesh mesh(soup);
  Report report;
  const VecX u = test::surface_distance(
      mesh, test::vertex_points({0}),
      AnyMethod::named("regularized", {{"regularizer", "hessian"}, {"alpha", "0.001"}}), report);
  const VecX d = test::exact(mesh, test::vertex_points({0}));
  EXPECT_LT((u - d).cwiseAbs().mean(), 0.05 * d.maxCoeff());
}

TEST(RegularizedDomains, SaddlesLeaveTheHessianAMinimumAtAnyAlpha) {
  PolygonSoup soup = test::grid_soup(14, 14);
  for (auto p : soup.points.rowwise()) {
    p.head<2>() = 2 * p.head<2>().array() - 1;
    p[2] = 1.5 * (p[0] * p[0] - p[1] * p[1]);
  }
  const SurfaceMesh mesh(soup);
  const VecX d = test::exact(mesh, test::vertex_points({0}));
  double last = d.mean();
  for (const std::string alpha : {"0.1", "1", "100"}) {
    Report report;
    const VecX u = test::surface_distance(
        mesh, test::vertex_points({0}),
        AnyMethod::named("regularized", {{"regularizer", "hessian"}, {"alpha", alpha}}), report);
    EXPECT_EQ(report.status, "converged") << alpha;
    EXPECT_EQ(report.warnings.size(), alpha == "0.1" ? 0U : 1U) << alpha;
    EXPECT_GE(u.minCoeff(), 0) << alpha;
    EXPECT_LE((u - 1.02 * d).maxCoeff(), 1e-9) << alpha;
    EXPECT_LT(u.mean(), 1.01 * last) << alpha;  // the more smoothing, the less
    last = u.mean();
  }
  EXPECT_GT(last, 1e-3 * d.mean());
}

TEST(RegularizedDomains, PolygonsWithoutAreaAreAsLongAsTheyAre) {
  // The second polygon is a segment: its corners are at two places.
  PolygonSoup soup;
  soup.points.resize(10, 3);
  soup.points << 0, 0, 0.026, 1, 0, 0.198, 0, 1. / 3, 0.121, 0, 1. / 3, 0.121, 0, 2. / 3, 0.163, 0,
      2. / 3, 0.163, 0, 1, 0.085, 1, 1, 0.024, 0, 0.7, 0.155, 0.848, 0.934, 0.404;
  for (const std::vector<int>& corners :
       {std::vector<int>{0, 1, 3, 2}, {2, 3, 5, 4}, {4, 5, 7, 6, 8}, {0, 1, 9}})
    soup.add_face(corners);
  const SurfaceMesh mesh(soup);
  for (const int from : {4, 5}) {
    Report report;
    const VecX u = test::surface_distance(mesh, test::vertex_points({from}),
                                          BelyaevFayolle{.tolerance = 1e-4}, report);
    EXPECT_EQ(report.status, "converged");
    EXPECT_NEAR(u[4], u[5], 1e-5);
    EXPECT_NEAR(u[2], u[3], 1e-5);
    const double length = (mesh.point(2) - mesh.point(4)).norm();
    EXPECT_NEAR(u[2], length, 1e-3 * length);
    EXPECT_TRUE(u.allFinite());
  }
}

TEST(BoundaryCurves, LoopsThatTouchAndFacesThatRepeatAVertex) {
  PolygonSoup soup = test::grid_soup(2, 1);
  soup.points.conservativeResize(soup.points.rows() + 2, 3);
  soup.points.bottomRows(2) << -1, 0, 0, -1, 1, 0;
  test::add_triangle(soup, 0, 6, 7);  // touches in vertex 0
  test::add_triangle(soup, 1, 1, 2);
  const SurfaceMesh mesh(soup);
  int edges = 0, seen = 0;
  for (int e = 0; e < mesh.n_edges(); ++e)
    edges += mesh.edge_faces(e).size() == 1 && mesh.edges()(e, 0) != mesh.edges()(e, 1);
  for (const Curve& curve : boundary_curves(mesh)) seen += static_cast<int>(curve.nodes.size()) - 1;
  EXPECT_EQ(seen, edges);
}

}  // namespace
}  // namespace littoral
