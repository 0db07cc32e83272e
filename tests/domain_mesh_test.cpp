#include <gmock/gmock.h>

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "base/parallel.h"
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

// So many vertices that several threads share them; the simple reference is a map.
TEST(SurfaceMesh, EdgesOfManyVerticesAreThoseOfAMapOnAnyNumberOfThreads) {
  PolygonSoup soup = test::torus_soup(150, 140);
  test::add_triangle(soup, 0, 1, 20000);  // edges of three faces, and between far numbers
  test::add_triangle(soup, 1, 0, 9000);
  test::add_triangle(soup, 7, 7, 12000);  // a side that ends where it begins
  std::map<std::pair<int, int>, int> number;
  std::vector<std::array<int, 2>> edges;
  std::vector<int> edge_of_side;
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto corners = soup.face(f);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const int tail = corners[k], head = corners[(k + 1) % corners.size()];
      const auto [at, is_new] = number.try_emplace(std::minmax(tail, head), int(edges.size()));
      if (is_new) edges.push_back({tail, head});
      edge_of_side.push_back(at->second);
    }
  }
  for (const int threads : {1, 2, 3, 0}) {
    set_thread_count(threads);
    const SurfaceMesh mesh(soup);
    ASSERT_EQ(mesh.n_edges(), int(edges.size()));
    for (int e = 0; e < mesh.n_edges(); ++e) {
      ASSERT_EQ(mesh.edges()(e, 0), edges[e][0]);
      ASSERT_EQ(mesh.edges()(e, 1), edges[e][1]);
    }
    for (int c = 0; c < int(edge_of_side.size()); ++c)
      ASSERT_EQ(mesh.side_edge(c / 3, c % 3), edge_of_side[c]);
  }
  set_thread_count(0);
}

// Of several the first in the order of faces, whichever thread finds one first.
TEST(SurfaceMesh, NamesTheFirstFaceThatIsWrongOfMany) {
  PolygonSoup soup = test::grid_soup(200, 200);
  soup.points(201 * 200, 2) = std::nan("");  // of the last row
  soup.corners[3 * 20000 + 1] = 99999;
  soup.corners[3 * 60000] = -1;
  for (const int threads : {1, 2, 0}) {
    set_thread_count(threads);
    try {
      const SurfaceMesh mesh(soup);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("face 20000 refers to vertex 99999"));
    }
  }
  set_thread_count(0);
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

// As large as parts of it are numbered by different threads.
TEST(SurfaceMesh, EdgesOfLargeMeshesAreNumberedAndGroupedInTheSameWay) {
  PolygonSoup soup = test::grid_soup(140, 130);
  soup.add_face(std::vector<int>{0, 1, 2, 200, 199});
  soup.add_face(std::vector<int>{0, 1, 150});  // three faces at an edge
  const SurfaceMesh mesh(soup);
  std::map<std::pair<int, int>, int> numbers;
  std::vector<std::vector<int>> faces;
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto corners = soup.face(f);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const int tail = corners[k], head = corners[(k + 1) % corners.size()];
      const auto [at, is_new] = numbers.emplace(std::minmax(tail, head), int(numbers.size()));
      if (is_new) {
        faces.emplace_back();
        ASSERT_EQ(mesh.edges().row(at->second), (Eigen::RowVector2i(tail, head)));
      }
      ASSERT_EQ(mesh.side_edge(f, int(k)), at->second) << f;
      faces[at->second].push_back(f);
    }
  }
  ASSERT_EQ(mesh.n_edges(), int(numbers.size()));
  for (int e = 0; e < mesh.n_edges(); ++e)
    ASSERT_THAT(mesh.edge_faces(e), ::testing::ElementsAreArray(faces[e])) << e;
}

// The first few vertices are looked for one by one, the others together.
TEST(SurfaceMesh, FacesOfAVertexAreTheSameHoweverManyAreAskedFor) {
  PolygonSoup soup = test::grid_soup(6, 5);
  soup.add_face(std::vector<int>{3, 9, 3, 20});  // twice at vertex 3
  MatX3 points(soup.points.rows() + 1, 3);
  points << soup.points, 0, 0, 9;  // in no face
  soup.points = points;
  std::vector<std::vector<int>> expected(soup.n_vertices());
  for (int f = 0; f < soup.n_faces(); ++f)
    for (const int v : soup.face(f)) expected[v].push_back(f);
  for (const int first : {0, 3, 20, soup.n_vertices() - 1}) {
    const SurfaceMesh mesh(soup);
    const auto found = mesh.vertex_faces(first);
    EXPECT_THAT(found, ::testing::ElementsAreArray(expected[first])) << first;
    for (int v = 0; v < mesh.n_vertices(); ++v)
      EXPECT_THAT(mesh.vertex_faces(v), ::testing::ElementsAreArray(expected[v])) << v;
    EXPECT_THAT(found, ::testing::ElementsAreArray(expected[first])) << "kept: " << first;
  }
}

TEST(SurfaceMesh, SeveralThreadsMayAskForTheFacesOfVertices) {
  const PolygonSoup soup = test::grid_soup(30, 30);
  const SurfaceMesh mesh(soup);
  std::vector<int> degree(mesh.n_vertices(), 0), found(mesh.n_vertices(), 0);
  for (const int v : soup.corners) ++degree[v];
  parallel_for(found.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) found[v] = int(mesh.vertex_faces(int(v)).size());
  });
  EXPECT_EQ(found, degree);
}

}  // namespace
}  // namespace littoral
