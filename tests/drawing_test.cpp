// What programs that show surfaces and let people draw on them are made of.

#include "littoral/drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "littoral/error.h"

namespace littoral {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// The unit square in n x n cells of two triangles each.
Mesh drawing_square(int n) {
  PolygonSoup soup;
  soup.points.resize((n + 1) * (n + 1), 3);
  for (int v = 0; v < soup.n_vertices(); ++v)
    soup.points.row(v) << double(v % (n + 1)) / n, double(v / (n + 1)) / n, 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = i + j * (n + 1);
      soup.add_face(std::array{a, a + 1, a + n + 2});
      soup.add_face(std::array{a, a + n + 2, a + n + 1});
    }
  return Mesh(std::move(soup));
}

Sources drawn_sources() {
  Sources sources;
  Curve curve = Curve::through({SurfacePoint::at_vertex(3), SurfacePoint::on_edge(2, 1.0 / 3),
                                SurfacePoint::in_face(4, 0.1, 0.2, 0.7)});
  sources.add(curve);
  curve.nodes.push_back(curve.nodes.front());
  sources.add(curve.unsigned_curve());
  sources.add(SurfacePoint::at_vertex(1));
  return sources;
}

void expect_same(const std::vector<SurfacePoint>& a, const std::vector<SurfacePoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].on, b[k].on);
    EXPECT_EQ(a[k].element, b[k].element);
    EXPECT_EQ(a[k].b, b[k].b);
  }
}

TEST(Drawing, TrianglesKnowTheirPolygons) {
  PolygonSoup soup;
  soup.points.resize(7, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2.5, .5, 0, 2, 1, 0;
  soup.add_face(std::array{0, 1, 2, 3});
  soup.add_face(std::array{1, 2});
  soup.add_face(std::array{1, 4, 5, 6, 2});
  const Triangulation cut = triangulation(soup);
  EXPECT_THAT(cut.polygons, ElementsAre(0, 0, 2, 2, 2));
  double area = 0;
  for (const auto& t : cut.corners.rowwise()) {
    const Vec3 a = soup.points.row(t[0]), b = soup.points.row(t[1]), c = soup.points.row(t[2]);
    area += (b - a).cross(c - a)[2] / 2;
  }
  EXPECT_NEAR(area, 1 + 1.25, 1e-12);
  EXPECT_EQ(triangulation(PolygonSoup{}).corners.rows(), 0);
}

TEST(Drawing, WhatStandsOnTheFloorSaysWhichWayIsUp) {
  MatX3 points(3, 3);
  points << -1, -1, 0, 1, 1, 1, 0, NAN, 0;
  EXPECT_TRUE(z_is_up(points));
  points.col(1).array() += 1;
  EXPECT_FALSE(z_is_up(points));
  EXPECT_FALSE(z_is_up(MatX3(0, 3)));
}

TEST(Drawing, PathsJoinNodesAcrossFaces) {
  const Mesh mesh = drawing_square(8);
  const auto path = path_through(
      mesh, {SurfacePoint::at_vertex(0), SurfacePoint::at_vertex(80), SurfacePoint::at_vertex(8)});
  double length = 0;
  for (std::size_t k = 1; k < path.size(); ++k)
    length += (mesh.position(path[k]) - mesh.position(path[k - 1])).norm();
  EXPECT_NEAR(length, std::sqrt(2) + 1, 1e-12);
  EXPECT_EQ(path.front().element, 0);
  EXPECT_EQ(path.back().element, 8);
  EXPECT_EQ(path_through(mesh, {SurfacePoint::at_vertex(5)}).size(), 1u);
  EXPECT_THROW(path_through(mesh, {SurfacePoint::at_vertex(0), SurfacePoint::at_vertex(81)}),
               InputError);
}

TEST(Drawing, OffsetCurvesLieAtTheirDistance) {
  const Mesh mesh = drawing_square(16);
  const DistanceSolver solver(mesh, SignedHeat{});
  std::vector<int> middle;
  for (int j = 0; j <= 16; ++j) middle.push_back(8 + 17 * j);
  const auto found =
      offset_curves(solver, Sources().add(Curve::along_vertices(middle)), {-0.25, 0.1});
  ASSERT_EQ(found.size(), 2u);
  for (const LevelCurves& level : found) {
    ASSERT_EQ(level.lines.size(), 1u);
    for (const auto& x : level.lines[0].rowwise()) EXPECT_NEAR(0.5 - x[0], level.level, 1e-3);
  }
  EXPECT_THROW(offset_curves(solver, Sources().add(Curve::along_vertices(middle)), {7}),
               InputError);
}

TEST(Drawing, SourcesComeBackFromTheirText) {
  const Mesh mesh = drawing_square(4);
  const Sources sources = drawn_sources();
  for (const std::string name : {"drawn.txt", "drawn.json"}) {
    const Sources again = parse_sources(sources_text(sources, name, mesh), name, mesh);
    ASSERT_EQ(again.curves.size(), 2u);
    for (std::size_t c = 0; c < 2; ++c) {
      EXPECT_EQ(again.curves[c].is_signed, sources.curves[c].is_signed);
      expect_same(again.curves[c].nodes, sources.curves[c].nodes);
    }
    expect_same(again.points, sources.points);
  }
}

TEST(Drawing, FormatsRefuseWhatTheyDoNotHold) {
  const Mesh mesh = drawing_square(4);
  SpaceCurve curve;
  curve.points = mesh.points().topRows(3);
  const Sources in_space = Sources().add(curve), chain = Sources().add(FaceChain{{0, 1}});
  EXPECT_THROW(sources_text(in_space, "a.txt", mesh), UnsupportedError);
  EXPECT_THROW(sources_text(chain, "a.json", mesh), UnsupportedError);
  EXPECT_THROW(sources_text(Sources(drawn_sources()).add(chain), "a.txt", mesh), UnsupportedError);
  EXPECT_THROW(sources_text(in_space, "a.ply", mesh), UnsupportedError);
  const Sources again = parse_sources(sources_text(in_space, "a.json", mesh), "a.json", mesh);
  EXPECT_EQ(again.space_curves.at(0).points, curve.points);
  EXPECT_THAT(parse_sources(sources_text(chain, "a.txt", mesh), "a.txt", mesh).chains.at(0).faces,
              ElementsAre(0, 1));
  EXPECT_THROW(sources_text(Sources(SurfacePoint::at_vertex(25)), "a.txt", mesh), InputError);
  EXPECT_EQ(sources_text(Sources(SurfacePoint::at_vertex(2)), "a.txt", Mesh::cloud(curve.points)),
            "unsigned_point\nv 2\n");
  EXPECT_THROW(sources_text(Sources(SurfacePoint::on_edge(999, 0.5)), "a.txt", mesh), InputError);
}

TEST(Drawing, OdditiesAreCounted) {
  EXPECT_THAT(oddities(drawing_square(4)), ElementsAre("16 edges lie on a boundary"));
  EXPECT_TRUE(oddities(Mesh::cloud(MatX3::Zero(3, 3))).empty());
  EXPECT_THAT(info_json(drawing_square(4)), HasSubstr("\"boundary_edges\": 16"));
}

}  // namespace
}  // namespace littoral
