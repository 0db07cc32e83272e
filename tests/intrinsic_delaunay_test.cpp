// Flips and refinement change triangles, not the surface nor what is drawn on it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "heat_helpers.h"
#include "one_call.h"
#include "sources/surface/retriangulate_sources.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// A square of thin triangles: nearly all edges are not Delaunay.
PolygonSoup needles() {
  PolygonSoup soup = test::jittered_grid_soup(60, 5, 0.2);
  for (int v = 0; v < soup.n_vertices(); ++v) soup.points(v, 0) += 2.5 * soup.points(v, 1);
  return soup;
}

struct Triangulated {
  const char* name;
  PolygonSoup soup;
  bool flat;
};

std::ostream& operator<<(std::ostream& out, const Triangulated& c) { return out << c.name; }

PolygonSoup three_pages() {  // three pages: an edge of three faces is never flipped
  PolygonSoup soup = needles();
  const int n = soup.n_vertices();
  soup.points.conservativeResize(n + 1, 3);
  soup.points.row(n) << 0, 0, 1;
  test::add_triangle(soup, 7, 8, n);
  return soup;
}

class Retriangulating : public testing::TestWithParam<std::tuple<Triangulated, double>> {
 protected:
  Retriangulating()
      : mesh(std::get<0>(GetParam()).soup),
        T(intrinsic_triangulation(mesh, report)),
        sources(place_sources(mesh, drawn(), report)),
        after(retriangulated(mesh, T, sources, {std::get<1>(GetParam()), 3, {}}, report, {})) {}

  static Sources drawn() {
    MatX3 line(3, 3);
    line << 0.6, 0.1, 0, 1.6, 0.55, 0, 2.5, 0.9, 0;
    Sources out = test::space_curve(line);
    Curve along;
    for (int v : {61, 62, 63, 124}) along.nodes.push_back(SurfacePoint::at_vertex(v));
    along.is_signed = false;
    out.curves.push_back(along);
    out.points = {SurfacePoint::at_vertex(100), SurfacePoint::in_face(50, 0.2, 0.3, 0.5)};
    return out;
  }
  double size(const std::string& name) const {
    for (const auto& [key, value] : report.sizes)
      if (key == name) return value;
    return -1;
  }

  Report report;
  SurfaceMesh mesh;
  IntrinsicTriangulation T;
  PlacedSources sources;
  Retriangulated after;
};

double area(const IntrinsicTriangulation& T) {
  double sum = 0;
  for (int f = 0; f < T.n_faces(); ++f) sum += T.shape(f).area;
  return sum;
}

TEST_P(Retriangulating, KeepsAreaVerticesAndSides) {
  EXPECT_NEAR(area(after.T), area(T), 1e-9 * area(T));
  EXPECT_GT(size("intrinsic_flips"), 20);
  EXPECT_EQ(after.T.n_components, T.n_components);
  for (int v = 0; v < mesh.n_vertices(); ++v) EXPECT_EQ(after.mesh.point(v), mesh.point(v));
  for (int e = 0; e < after.T.n_edges(); ++e) {  // faces agree about their common side
    double length = 0;
    for (int f : after.mesh.edge_faces(e))
      for (int k = 0; k < 3; ++k) {
        if (after.T.side_edge(f, k) != e) continue;
        if (length > 0) {
          EXPECT_EQ(after.T.length(f, k), length);
        }
        length = after.T.length(f, k);
      }
  }
}

TEST_P(Retriangulating, KeepsWhatIsDrawn) {
  std::vector<double> before(2, 0), now(2, 0);
  for (const CurvePiece& p : sources.pieces) before[p.curve] += p.length;
  for (const CurvePiece& p : after.sources.pieces) {
    now[p.curve] += p.length;
    // Its length by the new triangle is its length by the old one.
    const TriangleShape t = after.T.shape(p.face);
    Complex d = 0;
    for (int k = 0; k < 3; ++k) d += (p.b[k] - p.a[k]) * t.p[k];
    EXPECT_NEAR(std::abs(d) * after.T.unit, p.length, 1e-9);
  }
  for (int c = 0; c < 2; ++c) EXPECT_NEAR(now[c], before[c], 1e-12 * before[c]);
  EXPECT_EQ(after.sources.points.size(), 2U);
  if (!std::get<0>(GetParam()).flat) return;
  // In the plane a point's place in its new triangle is its place.
  EXPECT_LE(
      (after.mesh.position(after.sources.points[1]) - mesh.position(sources.points[1])).norm(),
      1e-9);
  for (const CurvePiece& p : after.sources.pieces) {
    if (!p.is_signed) continue;
    const auto at = [&](const std::array<double, 3>& b) {
      return after.mesh.position(SurfacePoint::in_face(p.face, b[0], b[1], b[2]));
    };
    const Vec3 from = at(p.a), to = at(p.b);
    const double slope = from.x() < 1.6 - 1e-9 ? 0.45 : 0.35 / 0.9;
    EXPECT_NEAR((to - from).y(), slope * (to - from).x(), 1e-9);
    EXPECT_GT((to - from).x(), 0) << "in the direction of travel";
  }
}

TEST_P(Retriangulating, IsDelaunay) {
  // Those on the boundary cannot be flipped, only split.
  const bool refined = std::get<1>(GetParam()) > 0;
  EXPECT_LE(size("intrinsic_edges_not_delaunay"), (refined ? 0.002 : 0.02) * T.n_edges());
  if (!refined) return;
  int bad = 0;
  for (int f = 0; f < after.T.n_faces(); ++f)
    for (double cot : after.T.shape(f).cot) bad += cot > 1 / std::tan(0.4);
  EXPECT_LE(bad, 0.05 * after.T.n_faces());
  EXPECT_LE(after.T.n_vertices, 4 * mesh.n_vertices() + 1000);
}

INSTANTIATE_TEST_SUITE_P(Cases, Retriangulating,
                         testing::Combine(testing::Values(Triangulated{"needles", needles(), true},
                                                          Triangulated{"book", three_pages(),
                                                                       false}),
                                          testing::Values(0.0, 25.0)));

TEST(IntrinsicDelaunay, FlipsTheOneEdgeThatIsNotWhicheverNumberItHas) {
  // Two flat triangles on the long diagonal of a rhombus.
  std::array<int, 4> number{0, 1, 2, 3};
  do {
    PolygonSoup soup;
    soup.points.resize(4, 3);
    const double at[4][2] = {{-1, 0}, {1, 0}, {0, 0.3}, {0, -0.3}};
    for (int i = 0; i < 4; ++i) soup.points.row(number[i]) << at[i][0], at[i][1], 0;
    test::add_triangle(soup, number[0], number[1], number[2]);
    test::add_triangle(soup, number[1], number[0], number[3]);
    const SurfaceMesh mesh(soup);
    Report report;
    const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
    EXPECT_EQ(share_not_delaunay(T), 1);
    Sources source;
    source.points = {SurfacePoint::at_vertex(0)};
    const Retriangulated after =
        retriangulated(mesh, T, place_sources(mesh, source, report), {0, 3, {}}, report, {});
    for (int f = 0; f < 2; ++f)
      for (int k = 0; k < 3; ++k) EXPECT_LT(after.T.length(f, k) * after.T.unit, 1.1);
  } while (std::next_permutation(number.begin(), number.end()));
}

/// Triangles around vertex 0 whose other corners lie on a circle, at these angles in degrees; the
/// fan is closed if they end at 360. Face f begins at its corner (f + turn) % 3.
PolygonSoup fan_soup(const std::vector<double>& angles, int turn) {
  PolygonSoup soup;
  const bool closed = angles.back() == 360;
  const int n = static_cast<int>(angles.size()) - closed;
  soup.points.resize(n + 1, 3);
  soup.points.row(0).setZero();
  for (int i = 0; i < n; ++i) {
    const double a = std::acos(-1.0) / 180 * angles[std::size_t(i)];
    soup.points.row(1 + i) << std::cos(a), std::sin(a), 0;
  }
  for (int i = 0; i + !closed < n; ++i) {
    std::array<int, 3> corners{0, 1 + i, 1 + (i + 1) % n};
    std::rotate(corners.begin(), corners.begin() + (i + turn) % 3, corners.end());
    soup.add_face(corners);
  }
  return soup;
}

struct RefinedFan {
  int added;
  double least_angle;  // degrees
};

/// After refinement that keeps the edges from vertex 0 to these.
RefinedFan refined_fan(const PolygonSoup& soup, const std::vector<int>& kept,
                       double smallest_angle = 25) {
  const SurfaceMesh mesh(soup);
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  RefineOptions options;
  options.smallest_angle = smallest_angle;
  options.keep.assign(std::size_t(T.n_edges()), 0);
  for (int e = 0; e < T.n_edges(); ++e)
    for (const int v : kept)
      if (T.edges(e, 0) + T.edges(e, 1) == v && T.edges(e, 0) * T.edges(e, 1) == 0)
        options.keep[std::size_t(e)] = 1;
  const Retriangulation after = intrinsic_delaunay(mesh, T, {}, options, report, {});
  RefinedFan out{after.added, 180};
  for (int f = 0; f < after.T.n_faces(); ++f)
    for (const double cot : after.T.shape(f).cot)
      out.least_angle = std::min(out.least_angle, std::atan2(1, cot) * 180 / std::acos(-1.0));
  return out;
}

TEST(IntrinsicDelaunay, RefinementLeavesTipsOfNarrowWedgesAlone) {
  // A thin triangle at the middle of a fan is refined, unless there is a wedge between kept edges
  // there that has not three times the smallest angle to share out.
  for (const double wedge : {20, 70, 80, 100})
    for (int turn = 0; turn < 3; ++turn) {
      SCOPED_TRACE(wedge);
      const PolygonSoup soup =
          fan_soup({0, wedge, (wedge + 168) / 2, 168, 180, 225, 270, 315, 360}, turn);
      const RefinedFan both = refined_fan(soup, {1, 2});
      if (wedge < 75) {
        EXPECT_EQ(both.added, 0);
      } else {
        EXPECT_GE(both.least_angle, 25 - 1e-9);
      }
      EXPECT_GT(refined_fan(soup, {1}).added, 0);
      EXPECT_GT(refined_fan(soup, {2}).added, 0);
      EXPECT_GE(refined_fan(soup, {}).least_angle, 25 - 1e-9);
    }
}

TEST(IntrinsicDelaunay, RefinementLeavesNarrowTipsOfTheBoundaryAlone) {
  // The angle at vertex 0 is all there is to share out between its triangles.
  for (const double whole : {30, 50, 70, 80, 120})
    for (int turn = 0; turn < 3; ++turn) {
      SCOPED_TRACE(whole);
      const RefinedFan out = refined_fan(fan_soup({0, 15, whole}, turn), {});
      if (whole < 75) {
        EXPECT_EQ(out.added, 0);
      } else {
        EXPECT_GT(out.added, 0);
      }
    }
}

TEST(IntrinsicDelaunay, RefinesDownToAnglesBelowOneDegree) {
  const PolygonSoup soup = fan_soup({0, 60, 119.8, 120, 180, 240, 300, 360}, 0);
  EXPECT_NEAR(refined_fan(soup, {}, 0.05).least_angle, 0.2, 1e-9);  // as it was
  EXPECT_GE(refined_fan(soup, {}, 0.5).least_angle, 0.5 - 1e-9);
}

TEST(IntrinsicDelaunay, CountsFlipsAndTheShareOfEdgesThatNeedThem) {
  // Pairs of triangles on the long or the short diagonal of a kite, and one by itself.
  for (int flat = 0; flat < 4; ++flat) {
    PolygonSoup soup;
    soup.points.resize(15, 3);
    for (int pair = 0; pair < 3; ++pair) {
      const double half = pair < flat ? 0.3 : 2;
      const int v = 4 * pair;
      soup.points.middleRows(v, 4) << -1, 0, 0, 1, 0, 0, 0, half, 0, 0, -1.1, 0;
      test::add_triangle(soup, v, v + 1, v + 2);
      test::add_triangle(soup, v + 1, v, v + 3);
    }
    soup.points.bottomRows(3) << 0, 0, 0, 1, 0, 0, 0.5, 0.8, 0;
    test::add_triangle(soup, 12, 13, 14);
    const SurfaceMesh mesh(soup);
    Report report;
    const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
    EXPECT_DOUBLE_EQ(share_not_delaunay(T), flat / 3.0);
    const Retriangulation after = intrinsic_delaunay(mesh, T, {}, {0, 3, {}}, report, {});
    EXPECT_EQ(after.flips, flat);
    EXPECT_EQ(after.added, 0);
    EXPECT_EQ(after.not_delaunay, 0);
    EXPECT_EQ(share_not_delaunay(after.T), 0);
  }
}

TEST(IntrinsicDelaunay, NoEdgeBetweenTwoTrianglesMeansNoShareOfThem) {
  // Of one triangle, and of flat ones that meet at an edge of three, which cannot be flipped.
  for (const int pages : {1, 3}) {
    PolygonSoup soup;
    soup.points.resize(2 + pages, 3);
    soup.points.topRows(2) << -1, 0, 0, 1, 0, 0;
    for (int page = 0; page < pages; ++page) {
      soup.points.row(2 + page) << 0, 0.1 * std::cos(2 * page), 0.1 * std::sin(2 * page);
      test::add_triangle(soup, 0, 1, 2 + page);
    }
    Report report;
    EXPECT_EQ(share_not_delaunay(intrinsic_triangulation(SurfaceMesh(soup), report)), 0);
  }
}

TEST(IntrinsicDelaunay, MakesPointDistanceOnNeedlesBetter) {
  PolygonSoup soup = test::grid_soup(12, 12);
  soup.points.col(0) *= 12;  // triangles 12 times as long as wide, sheared
  soup.points.col(0) += 6 * soup.points.col(1);
  const SurfaceMesh mesh(soup);
  const int source = 6 + 13 * 6;
  double error[2];
  for (int intrinsic = 0; intrinsic < 2; ++intrinsic) {
    Report report;
    const VecX phi =
        test::surface_distance(mesh, test::vertex_points({source}),
                               UnsignedHeat{.intrinsic_delaunay = intrinsic == 1}, report);
    ASSERT_EQ(phi.size(), mesh.n_vertices());
    error[intrinsic] = 0;
    for (int v = 0; v < phi.size(); ++v)
      error[intrinsic] +=
          std::abs(phi[v] - (mesh.point(v) - mesh.point(source)).norm()) / double(phi.size());
  }
  EXPECT_LT(error[1], 0.5 * error[0]);
}

}  // namespace
}  // namespace littoral
