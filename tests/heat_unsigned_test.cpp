// The unsigned baseline is free of two errors known from existing programs.

#include <gtest/gtest.h>

#include "heat_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(UnsignedHeat, NeighbouringSourcesDoNotHalveEachOthersDistance) {
  // Two sources two edges apart: the vertex between them is one edge from each, not half an edge.
  const int n = 20;
  const double h = 1.0 / n;
  const SurfaceMesh mesh(test::grid_soup(n, n, 1));
  const int middle = 10 + 10 * (n + 1);
  Report report;
  const VecX u = test::unsigned_heat(mesh, test::vertex_points({middle - 1, middle + 1}), report);
  EXPECT_NEAR(u[middle], h, 0.35 * h);
  EXPECT_NEAR(u[middle - 1], 0, 1e-9);
  EXPECT_NEAR(u[middle + 1], 0, 1e-9);
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
