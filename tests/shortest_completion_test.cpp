// Completions of curves on the pages of a book, whose lengths are known.

#include "methods/winding/shortest_completion.h"

#include <gtest/gtest.h>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/error.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// Three pages, each of two rectangles side by side along the spine, which is 1 and 3 long there.
/// Vertices 0, 1, 2 are on it; face 4 p + 2 r + t is triangle t of rectangle r on page p.
PolygonSoup book() {
  PolygonSoup soup;
  soup.points.resize(12, 3);
  const double along[3] = {0, 1, 4};
  const double across[3][2] = {{1, 0}, {-1, 0.5}, {-1, -0.5}};
  for (int i = 0; i < 3; ++i) {
    soup.points.row(i) << along[i], 0, 0;
    for (int p = 0; p < 3; ++p)
      soup.points.row(3 + 3 * p + i) << along[i], across[p][0], across[p][1];
  }
  for (int p = 0; p < 3; ++p)
    for (int r = 0; r < 2; ++r) {
      const int outer = 3 + 3 * p + r;
      test::add_triangle(soup, r, outer + 1, outer);
      test::add_triangle(soup, r, r + 1, outer + 1);
    }
  return soup;
}

struct Book {
  Book() : mesh(book()), T(intrinsic_triangulation(mesh, report)), J(jump_calculus(T)) {}
  int edge(int a, int b) const {
    int e = 0;
    while (!(mesh.edges()(e, 0) == a && mesh.edges()(e, 1) == b) &&
           !(mesh.edges()(e, 0) == b && mesh.edges()(e, 1) == a))
      ++e;
    return e;
  }
  ShortestCompletion completed(const VecX& curve, Complete which, double curve_weight) {
    return shortest_completion(J, curve, which, curve_weight, {}, report);
  }

  Report report;
  SurfaceMesh mesh;
  IntrinsicTriangulation T;
  JumpCalculus J;
};

TEST(ShortestCompletion, ACurveThatCutsOffACornerOfAPageBounds) {
  Book book;
  VecX curve = VecX::Zero(book.J.n_edges);
  const int e = book.edge(0, 4);  // cuts off face 0
  const bool left = book.J.sides[std::size_t(e)][0].face == 0;
  for (const int sense : {1, -1}) {
    curve[e] = left ? sense : -sense;
    const ShortestCompletion out = book.completed(curve, Complete::none, 1);
    EXPECT_TRUE(out.parts[0].bounds());
    EXPECT_EQ(out.parts[0].largest, 1);
    for (int f = 0; f < 12; ++f) EXPECT_EQ(out.region[f], (f == 0) == (sense == 1) ? 1 : 0) << f;
  }
}

TEST(ShortestCompletion, ACurveThatReachesTheSpineIsCompletedAlongIt) {
  // Between the rectangles of the first page: the smaller one is cut off the two other pages along
  // the spine, 1 long, once from each.
  Book book;
  VecX curve = VecX::Zero(book.J.n_edges);
  const int e = book.edge(1, 4);
  curve[e] = book.J.sides[std::size_t(e)][0].face < 2 ? 1 : -1;
  const double unit = book.T.unit;
  for (const Complete which : {Complete::none, Complete::without_ends}) {
    const ShortestCompletion out = book.completed(curve, which, 10);
    EXPECT_FALSE(out.parts[0].solved);
    EXPECT_EQ(out.parts[0].ends, 1);
  }
  const ShortestCompletion out = book.completed(curve, Complete::all, 10);
  ASSERT_EQ(out.parts.size(), 1u);
  ASSERT_TRUE(out.parts[0].solved);
  EXPECT_NEAR(out.parts[0].given * unit, 1, 1e-12);
  EXPECT_NEAR(out.parts[0].added * unit, 2, 1e-12);
  EXPECT_EQ(out.parts[0].overruled, 0);
  for (int f = 0; f < 12; ++f) EXPECT_EQ(out.region[f], f < 2 ? 1 : 0) << f;
  const ShortestCompletion without = book.completed(curve, Complete::all, 1.5);  // 1.5 < 2
  EXPECT_EQ(without.parts[0].added, 0);
  EXPECT_NEAR(without.parts[0].overruled * unit, 1, 1e-12);
  EXPECT_EQ(without.region.maxCoeff(), 0);
}

TEST(ShortestCompletion, ACurveAlongTheSpineHasNoSides) {
  Book book;
  VecX curve = VecX::Zero(book.J.n_edges);
  curve[book.edge(0, 1)] = 1;
  EXPECT_THROW(book.completed(curve, Complete::all, 1), UnsupportedError);
}

}  // namespace
}  // namespace littoral
