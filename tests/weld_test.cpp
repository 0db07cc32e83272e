#include "spatial/weld.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "littoral/error.h"
#include "littoral/mesh.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// Every face with vertices of its own, each moved by up to `moved`.
PolygonSoup apart(const PolygonSoup& whole, double moved) {
  PolygonSoup out;
  out.points.resize(static_cast<Eigen::Index>(whole.corners.size()), 3);
  for (int f = 0, v = 0; f < whole.n_faces(); ++f) {
    std::vector<int> face;
    for (const int corner : whole.face(f)) {
      const Vec3 way(std::sin(7.0 * v), std::sin(11.0 * v), std::sin(13.0 * v));
      out.points.row(v) = whole.points.row(corner) + moved * way.normalized().transpose();
      face.push_back(v++);
    }
    out.add_face(face);
  }
  return out;
}

TEST(Weld, PutsASoupTogether) {
  const PolygonSoup whole = test::octasphere_soup(3);
  for (const double moved : {0.0, 1e-7}) {
    const Welded found = weld(apart(whole, moved), 2 * moved);
    EXPECT_EQ(found.soup.n_vertices(), whole.n_vertices());
    EXPECT_EQ(found.n_merged, 3 * whole.n_faces() - whole.n_vertices());
    EXPECT_EQ(found.soup.n_faces(), whole.n_faces());
    EXPECT_EQ(found.n_dropped_faces, 0);
  }
  EXPECT_EQ(weld(apart(whole, 1e-7), 0).n_merged, 0);
}

TEST(Weld, MakesAMeshConnected) {
  const Mesh soup(apart(test::octasphere_soup(3), 1e-7));
  EXPECT_EQ(soup.n_components(), soup.n_faces());
  EXPECT_EQ(soup.welded(2e-7).n_components(), 1);
  EXPECT_EQ(soup.welded().n_vertices(), soup.n_vertices());
  EXPECT_THROW(soup.welded(-1), InputError);
  EXPECT_THROW(soup.welded(NAN), InputError);
}

TEST(Weld, KeepsTheFirstAndDoesNotChain) {
  PolygonSoup row;
  row.points.resize(6, 3);
  row.points << 0, 0, 0, 0.9, 0, 0, 1.8, 0, 0, 5, 0, 0, NAN, 0, 0, NAN, 0, 0;
  row.scalars["u"] = VecX::LinSpaced(6, 0, 5);
  row.lines = {{0, 1, 2, 3}, {0, 1}};
  row.add_face(std::vector{0, 1, 3});
  row.add_face(std::vector{0, 1, 2, 3});
  const Welded found = weld(row, 1);
  // 1 becomes 0; 2 is farther than 1 from that.
  EXPECT_EQ(found.n_merged, 1);
  EXPECT_EQ(found.soup.n_vertices(), 5);
  EXPECT_EQ(found.soup.scalars.at("u")[1], 2);
  EXPECT_EQ(found.soup.lines, (std::vector<std::vector<int>>{{0, 1, 2}}));
  EXPECT_EQ(found.n_dropped_faces, 1);
  ASSERT_EQ(found.soup.n_faces(), 1);
  EXPECT_EQ(found.soup.face(0).size(), 3u);
}

}  // namespace
}  // namespace littoral
