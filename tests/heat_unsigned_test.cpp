// The unsigned baseline where heat methods are known to err: between sources and at the boundary.

#include <gtest/gtest.h>

#include "heat_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(UnsignedHeat, SeveralSourcesAreAllAtZeroAndLowerEachOtherLessWithDistance) {
  const int n = 40;
  const SurfaceMesh mesh(test::grid_soup(n, n, 1));
  const int middle = 20 + 20 * (n + 1);
  Report report;
  double before = 0;
  for (int k : {1, 2, 4, 8}) {  // sources 2 k edges apart
    const VecX u = test::unsigned_heat(mesh, test::vertex_points({middle - k, middle + k}), report);
    EXPECT_NEAR(u[middle - k], 0, 1e-9);
    EXPECT_NEAR(u[middle + k], 0, 1e-9);
    const double share = u[middle] * n / k;  // of the exact distance; 0.32, 0.62, 0.81, 0.91
    EXPECT_GT(share, before);
    EXPECT_LT(share, 1.1);
    before = share;
  }
  EXPECT_GT(before, 0.88);
}

TEST(UnsignedHeat, TheBoundaryIsAsAccurateAsTheInterior) {
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
