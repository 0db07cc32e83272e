// The unsigned baseline where heat methods are known to err: at the boundary.

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace littoral
