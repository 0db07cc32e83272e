#include <gmock/gmock.h>

#include "littoral/error.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(SurfaceMesh, CountsOfASphere) {
  const SurfaceMesh mesh(test::octasphere_soup(3));
  EXPECT_EQ(mesh.n_faces(), 512);
  EXPECT_EQ(mesh.n_vertices() - mesh.n_edges() + mesh.n_faces(), 2);
  EXPECT_EQ(mesh.n_components(), 1);
  for (int e = 0; e < mesh.n_edges(); ++e) EXPECT_EQ(mesh.edge_faces(e).size(), 2u);
}

TEST(SurfaceMesh, EdgesAreNumberedAndDirectedByFirstEncounter) {
  const SurfaceMesh mesh(test::grid_soup(1, 1));  // faces 0 1 3, 0 3 2
  ASSERT_EQ(mesh.n_edges(), 5);
  Rows<int, 2> expected(5, 2);
  expected << 0, 1, 1, 3, 3, 0, 3, 2, 2, 0;
  EXPECT_EQ(mesh.edges(), expected);
  EXPECT_EQ(mesh.side_edge(1, 0), 2);
  EXPECT_FALSE(mesh.side_along(1, 0));
  EXPECT_EQ(mesh.find_edge(2, 3), 3);
  EXPECT_EQ(mesh.find_edge(1, 2), -1);
}

TEST(SurfaceMesh, KeepsNonmanifoldEdgesAndIsolatedVertices) {
  PolygonSoup soup;
  soup.points = MatX3::Random(7, 3);
  for (int v = 2; v < 6; ++v) test::add_triangle(soup, 0, 1, v);
  soup.points.row(6).setConstant(std::nan(""));  // unused, hence harmless
  const SurfaceMesh mesh(std::move(soup));
  EXPECT_EQ(mesh.edge_faces(mesh.find_edge(0, 1)).size(), 4u);
  EXPECT_EQ(mesh.vertex_component()[6], -1);
  EXPECT_EQ(mesh.n_components(), 1);
}

TEST(SurfaceMesh, TakesAnyNumbersForEdges) {
  PolygonSoup soup;
  soup.points = MatX3::Random(4, 3);
  test::add_triangle(soup, 0, 1, 2);
  test::add_triangle(soup, 2, 1, 3);
  const SurfaceMesh mesh(std::move(soup), {900, 7, 8, 7, 1000, 9});
  EXPECT_EQ(mesh.n_edges(), 5);
  EXPECT_EQ(mesh.side_edge(0, 1), mesh.side_edge(1, 0));
  EXPECT_EQ(mesh.edge_faces(mesh.side_edge(1, 1)).size(), 1u);
}

TEST(SurfaceMesh, NamesTheVertexThatIsNotFinite) {
  PolygonSoup soup = test::grid_soup(2, 2);
  soup.points(4, 1) = std::nan("");
  try {
    const SurfaceMesh mesh(std::move(soup));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("vertex 4"));
  }
}

}  // namespace
}  // namespace littoral
