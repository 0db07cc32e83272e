// Triangles cut into smaller ones, for functions that bend inside them.

#include "api/surface/subdivided.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "test_meshes.h"

namespace littoral {
namespace {

double signed_area(const SurfaceMesh& mesh, int f) {
  const Vec3 a = mesh.point(mesh.face(f)[0]);
  const Vec3 u = mesh.point(mesh.face(f)[1]) - a, v = mesh.point(mesh.face(f)[2]) - a;
  return 0.5 * u.cross(v)[2];  // in the plane, with the sense of the corners
}

TEST(Subdivided, PartsAreAlikeAndMeetAlongSides) {
  const SurfaceMesh mesh(test::jittered_grid_soup(3, 2, 0.2, 1));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const auto height = [](const Vec3& x) { return 1 + 2 * x[0] - 3 * x[1]; };
  VecX at_vertices(mesh.n_vertices());
  for (int v = 0; v < mesh.n_vertices(); ++v) at_vertices[v] = height(mesh.point(v));
  for (const int n : {1, 2, 3, 4, 7}) {
    const SurfaceMesh fine(subdivided(mesh, T, n, at_vertices, [&](int t, const Vec3& b) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) sum += b[k] * at_vertices[T.faces(t, k)];
      return sum;
    }));
    ASSERT_EQ(fine.n_faces(), n * n * mesh.n_faces());
    EXPECT_EQ(fine.n_vertices() - fine.n_edges() + fine.n_faces(), 1);  // one disc, nothing torn
    for (int f = 0; f < fine.n_faces(); ++f)
      EXPECT_NEAR(signed_area(fine, f), signed_area(mesh, f / (n * n)) / (n * n), 1e-12) << n;
    const VecX& values = fine.soup().scalars.at("distance");
    for (int v = 0; v < fine.n_vertices(); ++v) {
      EXPECT_NEAR(values[v], height(fine.point(v)), 1e-12);
      if (v < mesh.n_vertices()) {
        EXPECT_EQ(fine.point(v), mesh.point(v));
      }
    }
  }
}

}  // namespace
}  // namespace littoral
