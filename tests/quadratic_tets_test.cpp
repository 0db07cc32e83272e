// Quadratic-order distance through tets: exact in convex domains, whatever the tets.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "littoral/error.h"
#include "methods/quadratic/quadratic.h"
#include "one_call.h"
#include "operators/p2_tets.h"
#include "test_meshes.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

/// The unit cube in tets whose inner vertices were moved at random.
TetMesh jittered_box(int n, unsigned seed) {
  TetMesh mesh = test::tet_box(n);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-0.2 / n, 0.2 / n);
  for (Eigen::Index v = 0; v < mesh.points.rows(); ++v)
    for (int d = 0; d < 3; ++d) {
      const double by = u(random);
      if (mesh.points(v, d) > 0 && mesh.points(v, d) < 1) mesh.points(v, d) += by;
    }
  return mesh;
}

TEST(QuadraticTets, ConvexDomainsAreExactFromAnyPoint) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    const TetMesh mesh = jittered_box(3, seed);
    const P2Tets P = p2_elements(mesh, tet_operators(mesh));
    const int tet = 20 + 17 * static_cast<int>(seed);
    P2Shape<3>::Point b(0.4, 0.3, 0.2, 0.1);
    if (seed % 3 == 1) b = P2Shape<3>::corner(1);
    if (seed % 3 == 2) b = P2Shape<3>::corner(0) * 0.7 + P2Shape<3>::corner(2) * 0.3;
    Vec3 source = Vec3::Zero();
    for (int k = 0; k < 4; ++k) source += b[k] * mesh.points.row(mesh.tets(tet, k));
    P2Source<3> at;
    for (int e = 0; e < mesh.n_tets(); ++e) {  // every tet around an edge or a corner
      P2Shape<3>::Point inside = P2Shape<3>::Point::Zero();
      double found = 0;
      for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k)
          if (b[i] > 0 && mesh.tets(tet, i) == mesh.tets(e, k)) inside[k] = b[i], found += b[i];
      if (found > 1 - 1e-12) at.where.push_back({e, inside});
    }
    Quadratic options;
    options.tolerance = 1e-6;
    Report report;
    const QuadraticSolver<3> method(std::make_shared<const P2Elements<3>>(P.elements));
    const VecX d = method.solve({at}, options, {}, report).at_vertices();
    EXPECT_EQ(report.status, "converged");
    for (int v = 0; v < mesh.n_vertices(); ++v)
      EXPECT_NEAR(d[v], (Vec3(mesh.points.row(v)) - source).norm(), 2e-4) << seed << " " << v;
  }
}

TEST(QuadraticTets, FromAVertexAndFromAPlaneThroughTheFrontDoor) {
  TetMesh mesh = jittered_box(3, 1);
  const AnyMethod method = AnyMethod::named("quadratic", {{"tolerance", "1e-6"}});
  for (const double scale : {1.0, 1e3}) {
    TetMesh scaled = mesh;
    scaled.points *= scale;
    TetSources sources;
    sources.vertices = {0};
    Report report;
    const VecX d = test::tet_mesh_distance(scaled, sources, method, report);
    for (int v = 0; v < mesh.n_vertices(); ++v)
      EXPECT_NEAR(d[v], scaled.points.row(v).norm(), 2e-4 * scale) << v;
    TetSources plane;
    plane.surface = test::square_at(0.42, 3);
    plane.surface.points *= scale;
    const VecX from_plane = test::tet_mesh_distance(scaled, plane, method, report);
    for (int v = 0; v < mesh.n_vertices(); ++v)
      EXPECT_NEAR(from_plane[v], std::abs(scaled.points(v, 0) - 0.42 * scale), 2e-4 * scale) << v;
  }
}

TEST(QuadraticTets, ComponentsWithoutASourceAreInfiniteAndCloudsRefused) {
  const TetMesh mesh = test::copies(test::tet_box(1), 2, {3, 3, 3});
  const int n = mesh.n_vertices() / 2;
  TetSources sources;
  sources.vertices = {0};
  Report report;
  const VecX d = test::tet_mesh_distance(mesh, sources, AnyMethod::named("quadratic"), report);
  EXPECT_TRUE(d.head(n).allFinite());
  EXPECT_TRUE((d.tail(n).array() > 1e300).all());
  EXPECT_EQ(report.unreachable_components, std::vector<int>{1});
  const AnyMethod subdivided = AnyMethod::named("quadratic", {{"subdivide", "3"}});
  EXPECT_THROW(test::tet_mesh_distance(mesh, sources, subdivided, report), InputError);
  TetSources cloud;
  cloud.surface.points = (MatX3(3, 3) << 0.5, 0.5, 0.5, 0.6, 0.5, 0.5, 0.5, 0.6, 0.5).finished();
  cloud.surface.normals = (MatX3(3, 3) << 0, 0, 1, 0, 0, 1, 0, 0, 1).finished();
  EXPECT_THROW(test::tet_mesh_distance(mesh, cloud, AnyMethod::named("quadratic"), report),
               UnsupportedError);
}

}  // namespace
}  // namespace littoral
