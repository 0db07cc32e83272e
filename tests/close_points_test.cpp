// Points of a level set that lie close to one node become one, where the surface stays a manifold.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "contour/rough_surface.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using testing::HasSubstr;

/// A mesh none of whose points is close to a node; separated points are its points moved by 10.
RoughSurface rough_of(const PolygonSoup& soup) {
  RoughSurface rough;
  for (int v = 0; v < soup.n_vertices(); ++v) add_point(rough, Vec3(soup.points.row(v)));
  for (Vec3& p : rough.separated_points) p += Vec3(10, 0, 0);
  for (int f = 0; f < soup.n_faces(); ++f)
    rough.triangles.push_back({soup.face(f)[0], soup.face(f)[1], soup.face(f)[2]});
  return rough;
}

double open_edges(const PolygonSoup& soup) {
  Report report;
  report_boundary(soup, 0, report);
  return report.sizes.at(0).second;
}

bool has_point(const PolygonSoup& soup, const Vec3& p) {
  for (int v = 0; v < soup.n_vertices(); ++v)
    if ((Vec3(soup.points.row(v)) - p).norm() < 1e-12) return true;
  return false;
}

TEST(ClosePoints, WithoutAnyNothingChanges) {
  const PolygonSoup soup = test::octasphere_soup(2);
  const PolygonSoup merged = merge_close_points(rough_of(soup), {});
  EXPECT_EQ(merged.points, soup.points);
  EXPECT_EQ(merged.corners, soup.corners);
}

TEST(ClosePoints, ThoseOfOneNodeBecomeTheirMean) {
  const PolygonSoup soup = test::octasphere_soup(2);
  RoughSurface rough = rough_of(soup);
  const auto corners = rough.triangles[5];
  Vec3 mean = Vec3::Zero();
  for (const int v : corners) {
    rough.node[std::size_t(v)] = 7;
    mean += rough.points[std::size_t(v)] / 3;
  }
  rough.node[std::size_t(rough.triangles[100][0])] = 8;  // alone: stays
  const PolygonSoup merged = merge_close_points(rough, {});
  EXPECT_EQ(merged.n_vertices(), soup.n_vertices() - 2);
  EXPECT_EQ(merged.n_faces(), soup.n_faces() - 4);
  EXPECT_EQ(open_edges(merged), 0);
  EXPECT_TRUE(has_point(merged, mean));
  EXPECT_TRUE(has_point(merged, Vec3(soup.points.row(rough.triangles[100][0]))));
}

TEST(ClosePoints, ThoseOfOtherNodesStayApart) {
  const PolygonSoup soup = test::octasphere_soup(1);
  RoughSurface rough = rough_of(soup);
  for (std::size_t k = 0; k < 3; ++k) rough.node[std::size_t(rough.triangles[0][k])] = int(k);
  const PolygonSoup merged = merge_close_points(rough, {});
  EXPECT_EQ(merged.points, soup.points);
}

/// Two tetrahedra without the face that they share: 1, 2, 3 are a ring of edges and no face.
PolygonSoup two_tetrahedra() {
  PolygonSoup soup;
  soup.points.resize(5, 3);
  soup.points << 0, 0, 1, 1, 0, 0, -0.5, 0.8, 0, -0.5, -0.8, 0, 0, 0, -1;
  for (const auto& c : {std::array{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {4, 2, 1}, {4, 3, 2}, {4, 1, 3}})
    soup.add_face(c);
  return soup;
}

TEST(ClosePoints, ARingThatIsNoFaceIsNotClosed) {
  RoughSurface rough = rough_of(two_tetrahedra());
  rough.node[1] = rough.node[2] = 3;  // both are joined to 3, and there is no face 1, 2, 3
  const PolygonSoup merged = merge_close_points(rough, {});
  EXPECT_EQ(merged.n_faces(), 6);
  EXPECT_TRUE(has_point(merged, rough.separated_points[1]));
  EXPECT_TRUE(has_point(merged, rough.separated_points[2]));
  EXPECT_TRUE(has_point(merged, rough.points[3]));
}

TEST(ClosePoints, ATetrahedronIsLeftOfTwo) {
  RoughSurface rough = rough_of(two_tetrahedra());
  rough.node[0] = rough.node[1] = 3;
  const PolygonSoup merged = merge_close_points(rough, {});
  EXPECT_EQ(merged.n_faces(), 4);
  EXPECT_EQ(open_edges(merged), 0);
  // What is left cannot lose another point.
  for (const int v : {0, 1, 2}) rough.node[std::size_t(v)] = 3;
  EXPECT_EQ(merge_close_points(rough, {}).n_faces(), 4);
}

TEST(ClosePoints, AtTheRimOnlyAlongIt) {
  const PolygonSoup soup = test::grid_soup(4, 4);
  const auto merged = [&](std::vector<int> close) {
    RoughSurface rough = rough_of(soup);
    for (const int v : close) rough.node[std::size_t(v)] = 3;
    return merge_close_points(rough, {});
  };
  const PolygonSoup along = merged({1, 2});  // an edge of the rim
  EXPECT_EQ(along.n_faces(), 31);
  EXPECT_EQ(open_edges(along), 15);
  EXPECT_TRUE(has_point(along, Vec3(0.375, 0, 0)));
  const PolygonSoup beside = merged({1, 6});  // one of the rim with one inside
  EXPECT_EQ(beside.n_faces(), 30);
  EXPECT_EQ(open_edges(beside), 16);
  // A diagonal between two sides of the rim: it would come to touch itself.
  PolygonSoup strip = test::grid_soup(4, 1);
  RoughSurface rough = rough_of(strip);
  rough.node[1] = rough.node[6] = 3;
  EXPECT_EQ(merge_close_points(rough, {}).n_faces(), strip.n_faces());
  EXPECT_EQ(open_edges(merge_close_points(rough, {})), open_edges(strip));
}

TEST(ClosePoints, APartWithoutSizeGoes) {
  PolygonSoup soup = two_tetrahedra();
  const int n = soup.n_vertices();
  soup.points.conservativeResize(n + 4, 3);
  soup.points.bottomRows(4).rowwise() = Eigen::RowVector3d(5, 5, 5);
  for (const auto& c : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
    test::add_triangle(soup, n + c[0], n + c[1], n + c[2]);
  RoughSurface rough = rough_of(soup);
  for (int k = 0; k < 4; ++k) rough.node[std::size_t(n + k)] = 9;
  const PolygonSoup merged = merge_close_points(rough, {});
  EXPECT_EQ(merged.n_vertices(), n);
  EXPECT_EQ(merged.n_faces(), 6);
  rough.points[std::size_t(n + 2)].x() += 1e-3;  // now it has some
  EXPECT_EQ(merge_close_points(rough, {}).n_faces(), 10);
}

TEST(ClosePoints, CrossingsAreCloseToANodeWithinATwentiethOfTheEdge) {
  const auto at = [](double t) { return Vec3(t, 0, 0); };
  for (const auto& [t, node] : {std::pair(0.04, 5), {0.06, -1}, {0.5, -1}, {0.94, -1}, {0.96, 5}}) {
    RoughSurface rough;
    add_point(rough, Vec3::Zero());
    place_crossing(rough, 0, t, 5, at);
    EXPECT_EQ(rough.node[0], node) << t;
    EXPECT_EQ(rough.points[0], Vec3(t, 0, 0));
    EXPECT_EQ(rough.separated_points[0], Vec3(t, 0, 0));
  }
  RoughSurface rough;
  add_point(rough, Vec3::Zero());
  place_crossing(rough, 0, 0, 5, at);
  EXPECT_EQ(rough.separated_points[0], Vec3(1e-3, 0, 0));
  place_crossing(rough, 0, 1, 5, at);
  EXPECT_EQ(rough.separated_points[0], Vec3(1 - 1e-3, 0, 0));
}

TEST(ReportBoundary, OpenEdgesAreCounted) {
  Report report;
  report_boundary(test::grid_soup(3, 2), 0.5, report);
  EXPECT_EQ(report.sizes.at(0).second, 10);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(report.warnings[0].code, "open-surface");
  EXPECT_THAT(report.warnings[0].text, HasSubstr("level 0.5 is open"));
  EXPECT_THAT(report.warnings[0].text, HasSubstr("10 edges"));
  Report closed;
  report_boundary(test::octasphere_soup(1), 0.5, closed);
  EXPECT_TRUE(closed.warnings.empty());
}

}  // namespace
}  // namespace littoral
