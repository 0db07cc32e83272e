// Flips and splits of a plane triangulation leave everything that is drawn on it where it was.

#include "domain/intrinsic/intrinsic_mesh_editor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "test_meshes.h"

namespace littoral {
namespace {

/// Where the ends of segments are in the plane; segments are numbered in order.
struct Drawn {
  Drawn(const SurfaceMesh& mesh, const CurveNetwork& curves) {
    for (const auto& s : curves.segments)
      ends.emplace_back(mesh.position(curves.nodes[std::size_t(s.a)]),
                        mesh.position(curves.nodes[std::size_t(s.b)]));
    for (const SurfacePoint& p : curves.nodes) nodes.push_back(mesh.position(p));
  }
  std::vector<std::pair<Vec3, Vec3>> ends;
  std::vector<Vec3> nodes;
};

/// Is the point at the edge's ends, or between them?
bool lies_along(const SurfaceMesh& mesh, int e, const SurfacePoint& p) {
  if (p.on == SurfacePoint::On::edge) return p.element == e;
  return p.on == SurfacePoint::On::vertex &&
         (mesh.edges()(e, 0) == p.element || mesh.edges()(e, 1) == p.element);
}

bool lies_in(const SurfaceMesh& mesh, int f, const SurfacePoint& p) {
  if (p.on == SurfacePoint::On::face) return p.element == f;
  for (int k = 0; k < 3; ++k)
    if (p.on == SurfacePoint::On::vertex ? mesh.face(f)[std::size_t(k)] == p.element
                                         : mesh.side_edge(f, k) == p.element)
      return true;
  return false;
}

void expect_in_place(const Drawn& before, const Retriangulation& after) {
  const auto& nodes = after.curves.nodes;
  for (std::size_t i = 0; i < before.nodes.size(); ++i)
    EXPECT_LE((after.mesh.position(nodes[i]) - before.nodes[i]).norm(), 1e-12) << i;
  std::vector<double> length(before.ends.size(), 0);
  for (const auto& s : after.curves.segments) {
    const auto& [a, b] = before.ends[std::size_t(s.id)];
    const SurfacePoint &from = nodes[std::size_t(s.a)], &to = nodes[std::size_t(s.b)];
    EXPECT_LE((after.mesh.position(from) - (a + s.from * (b - a))).norm(), 1e-12) << s.id;
    EXPECT_LE((after.mesh.position(to) - (a + s.to * (b - a))).norm(), 1e-12) << s.id;
    EXPECT_LT(s.from, s.to);
    length[std::size_t(s.id)] += s.to - s.from;
    for (const SurfacePoint& p : {from, to})
      EXPECT_TRUE(s.edge >= 0 ? lies_along(after.mesh, s.edge, p) : lies_in(after.mesh, s.face, p))
          << s.id;
  }
  for (const double one : length) EXPECT_NEAR(one, 1, 1e-12);
}

/// Two triangles on both sides of an edge from vertex 0 to vertex 1.
PolygonSoup rhombus() {
  PolygonSoup soup;
  soup.points.resize(4, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0.4, 0.7, 0, 0.6, -0.8, 0;
  test::add_triangle(soup, 0, 1, 2);
  test::add_triangle(soup, 1, 0, 3);
  return soup;
}

bool joins(const SurfaceMesh& mesh, int e, int a, int b) {
  const int tail = mesh.edges()(e, 0), head = mesh.edges()(e, 1);
  return (tail == a && head == b) || (tail == b && head == a);
}

TEST(IntrinsicMeshEditor, CurvesAlongAnEdgeAreCutWhereItIsSplit) {
  const SurfaceMesh mesh(rhombus());
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  int e = 0;
  while (!joins(mesh, e, 0, 1)) ++e;
  const int tail = mesh.edges()(e, 0), head = mesh.edges()(e, 1);
  CurveNetwork curves;
  curves.nodes = {SurfacePoint::at_vertex(tail),  SurfacePoint::on_edge(e, 0.125),
                  SurfacePoint::on_edge(e, 0.25), SurfacePoint::on_edge(e, 0.5),
                  SurfacePoint::on_edge(e, 0.75), SurfacePoint::at_vertex(head)};
  int n = 0;
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < 6; ++b)
      if (a != b) curves.segments.push_back({n++, 0, 1, a, b, -1, e, false});
  IntrinsicMeshEditor editor(mesh, T, curves);
  ASSERT_TRUE(editor.split(e));
  EXPECT_EQ(editor.faces.size(), 4u);
  const Retriangulation after = std::move(editor).finish(T);
  expect_in_place(Drawn(mesh, curves), after);
  // Those from one side of the middle to the other are two now, the others are what they were.
  EXPECT_EQ(after.curves.segments.size(), 30u + 2 * 3 * 2);
  EXPECT_EQ(after.mesh.point(4), Vec3(0.5, 0, 0));
  EXPECT_EQ(after.curves.nodes[3].on, SurfacePoint::On::vertex);
  EXPECT_EQ(after.curves.nodes[3].element, 4);
  for (const auto& s : after.curves.segments) {
    ASSERT_GE(s.edge, 0);
    EXPECT_TRUE(joins(after.mesh, s.edge, 0, 4) || joins(after.mesh, s.edge, 1, 4));
  }
}

TEST(IntrinsicMeshEditor, FlipsAndSplitsLeaveDrawingsInThePlaneInPlace) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> some(0.05, 0.95);
  for (int round = 0; round < 20; ++round) {
    SCOPED_TRACE(round);
    const SurfaceMesh mesh(test::jittered_grid_soup(3, 3, 0.2));
    Report report;
    const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
    CurveNetwork curves;
    const auto any = [&](int n) { return static_cast<int>(random() % unsigned(n)); };
    const auto add = [&](const SurfacePoint& p) {
      curves.nodes.push_back(p);
      return static_cast<int>(curves.nodes.size()) - 1;
    };
    for (int i = 0; i < 20; ++i) {  // along edges, and through faces from side to side
      CurveNetwork::Segment s;
      s.id = i;
      if (i % 2 == 0) {
        s.edge = any(mesh.n_edges());
        s.a = add(SurfacePoint::on_edge(s.edge, some(random)));
        s.b = i % 4 == 0 ? add(SurfacePoint::at_vertex(mesh.edges()(s.edge, any(2))))
                         : add(SurfacePoint::on_edge(s.edge, some(random)));
      } else {
        s.face = any(mesh.n_faces());
        const double x = some(random) / 2, y = some(random) / 2;
        s.a = add(SurfacePoint::in_face(s.face, 1 - x - y, x, y));
        s.b = add(SurfacePoint::on_edge(mesh.side_edge(s.face, any(3)), some(random)));
      }
      curves.segments.push_back(s);
    }
    IntrinsicMeshEditor editor(mesh, T, curves);
    int flips = 0, splits = 0;
    for (int i = 0; i < 40; ++i) {
      const int e = any(static_cast<int>(editor.edges.size()));
      if (i % 3 == 0)
        splits += editor.split(e);
      else
        flips += editor.flip(e);
    }
    EXPECT_GT(flips, 0);
    EXPECT_GT(splits, 5);
    const Retriangulation after = std::move(editor).finish(T);
    double area = 0;
    for (int f = 0; f < after.T.n_faces(); ++f) area += after.T.shape(f).area;
    EXPECT_NEAR(area * T.unit * T.unit, 1, 1e-9);
    expect_in_place(Drawn(mesh, curves), after);
  }
}

TEST(IntrinsicMeshEditor, TrianglesAreTheSameWhereNothingIsDrawn) {
  PolygonSoup soup = test::jittered_grid_soup(6, 6, 0.25);
  soup.points.conservativeResize(soup.n_vertices() + 2, 3);  // two more pages at an edge
  soup.points.bottomRows(2) << 0.5, 0.5, 1, 0.5, 0.5, -1;
  const int inner = 3 * 7 + 3;
  test::add_triangle(soup, inner, inner + 1, soup.n_vertices() - 2);
  test::add_triangle(soup, inner, inner + 1, soup.n_vertices() - 1);
  const SurfaceMesh mesh(soup);
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  CurveNetwork curves;
  curves.nodes = {SurfacePoint::in_face(0, 0.2, 0.3, 0.5), SurfacePoint::in_face(0, 0.4, 0.4, 0.2)};
  curves.segments = {{0, 0, 1, 0, 1, 0, -1, false}};
  IntrinsicMeshEditor drawn(mesh, T, curves), plain(mesh, T, {});
  std::mt19937 random(5);
  int flips = 0, splits = 0;
  for (int i = 0; i < 300; ++i) {
    const int e = static_cast<int>(random() % plain.edges.size());
    const bool did = i % 3 == 0 ? plain.split(e) : plain.flip(e);
    ASSERT_EQ(i % 3 == 0 ? drawn.split(e) : drawn.flip(e), did);
    (i % 3 == 0 ? splits : flips) += did;
  }
  EXPECT_GT(flips, 20);
  EXPECT_GT(splits, 50);
  for (std::size_t e = 0; e < plain.edges.size(); ++e) {
    const auto& faces = plain.edges[e].faces;
    EXPECT_TRUE(std::equal(faces.begin(), faces.end(), drawn.edges[e].faces.begin(),
                           drawn.edges[e].faces.end()));
    ASSERT_FALSE(faces.empty());
    double sum = 0;
    for (const int f : faces) {
      const auto& sides = plain.faces[std::size_t(f)].e;
      const auto k = std::find(sides.begin(), sides.end(), int(e)) - sides.begin();
      ASSERT_LT(k, 3);
      sum += plain.shape(f).cot[std::size_t(k + 2) % 3];
    }
    EXPECT_EQ(plain.delaunay_sum(int(e)), sum);
  }
  const Retriangulation a = std::move(plain).finish(T), b = std::move(drawn).finish(T);
  EXPECT_EQ(a.T.faces.matrix(), b.T.faces.matrix());
  EXPECT_EQ(a.T.length, b.T.length);
  EXPECT_EQ(a.T.seams, b.T.seams);
  EXPECT_EQ(b.curves.nodes.size(), 2 + b.curves.segments.size() - 1);
}

TEST(FacesOfEdge, AreThoseThatWereAdded) {
  FacesOfEdge faces{4, 7};
  std::vector<int> expected{4, 7};
  for (const int f : {1, 9, 3}) {
    faces.push_back(f);
    expected.push_back(f);
    EXPECT_EQ(std::vector<int>(faces.begin(), faces.end()), expected);
  }
  FacesOfEdge moved = std::move(faces);
  EXPECT_EQ(moved.size(), 5u);
  EXPECT_EQ(moved[4], 3);
  moved.clear();
  EXPECT_TRUE(moved.empty());
  for (const int f : {8, 6, 5}) moved.push_back(f);
  EXPECT_EQ(std::vector<int>(moved.begin(), moved.end()), (std::vector<int>{8, 6, 5}));
}

}  // namespace
}  // namespace littoral
