#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "constants.h"
#include "contour/isolines.h"
#include "littoral/error.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::infinity;

VecX coordinate(const SurfaceMesh& mesh, int axis) { return mesh.points().col(axis); }

double total_length(const SurfaceMesh& mesh, const std::vector<Polyline>& lines) {
  double length = 0;
  for (const Polyline& line : lines) length += polyline_length(mesh, line);
  return length;
}

double value_at(const SurfaceMesh& mesh, const VecX& values, const SurfacePoint& p) {
  if (p.on == SurfacePoint::On::vertex) return values[p.element];
  EXPECT_EQ(p.on, SurfacePoint::On::edge);
  return p.b[0] * values[mesh.edges()(p.element, 0)] + p.b[1] * values[mesh.edges()(p.element, 1)];
}

// Random values from a small set, so that many vertices lie exactly at the level.
VecX random_values(int n, unsigned seed, bool ties) {
  std::mt19937 random(seed);
  VecX values(n);
  for (int v = 0; v < n; ++v) {
    values[v] = ties ? static_cast<int>(random() % 3) - 1.0 : random() / 2147483648.0 - 1.0;
  }
  return values;
}

TEST(Isolines, StraightLineAcrossAPlane) {
  const SurfaceMesh mesh(test::grid_soup(7, 5));
  const auto lines = isolines(mesh, coordinate(mesh, 0), 0.5);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_FALSE(lines[0].closed);
  EXPECT_NEAR(polyline_length(mesh, lines[0]), 1.0, 1e-12);
  const MatX3 points = polyline_points(mesh, lines[0]);
  EXPECT_LT((points.col(0).array() - 0.5).abs().maxCoeff(), 1e-12);
  // x grows to the right, so with larger values on the left travel is downwards.
  EXPECT_GT(points(0, 1), points(points.rows() - 1, 1));
}

TEST(Isolines, ParallelOfASphere) {
  const SurfaceMesh mesh(test::octasphere_soup(5));
  const double pi = std::acos(-1.0);
  for (const double angle : {0.3, 1.0, 2.0}) {
    VecX polar(mesh.n_vertices());
    for (int v = 0; v < mesh.n_vertices(); ++v) polar[v] = std::acos(mesh.point(v)[2]);
    const auto lines = isolines(mesh, polar, angle);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_TRUE(lines[0].closed);
    EXPECT_NEAR(polyline_length(mesh, lines[0]), 2 * pi * std::sin(angle), 0.01);
    // Larger values (south) on the left of travel seen from outside: westwards.
    const MatX3 p = polyline_points(mesh, lines[0]);
    EXPECT_LT(Vec3(p.row(0)).cross(Vec3(p.row(p.rows() / 4)))[2], 0);
    EXPECT_EQ(p.row(0), p.row(p.rows() - 1));
  }
}

TEST(Isolines, LevelThroughVerticesGivesOneCleanLine) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  const auto lines = isolines(mesh, coordinate(mesh, 2), 0);  // the equator runs along edges
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].closed);
  EXPECT_EQ(lines[0].nodes.size(), 4u << 4);
  for (const SurfacePoint& p : lines[0].nodes) EXPECT_EQ(p.on, SurfacePoint::On::vertex);
  EXPECT_NEAR(polyline_length(mesh, lines[0]), 2 * std::acos(-1.0), 0.01);
}

TEST(Isolines, LoneVertexAtTheLevelHasNoLine) {
  const SurfaceMesh mesh(test::octasphere_soup(2));
  EXPECT_TRUE(isolines(mesh, coordinate(mesh, 2), 1.0).empty());
  EXPECT_TRUE(isolines(mesh, coordinate(mesh, 2), -1.0).empty());
}

TEST(Isolines, FlatFieldAtTheLevelHasNoLineAndAFlatRegionOne) {
  const SurfaceMesh mesh(test::grid_soup(6, 6));
  EXPECT_TRUE(isolines(mesh, VecX::Constant(mesh.n_vertices(), 2), 2).empty());
  const VecX values = (coordinate(mesh, 0).array() - 0.5).max(0.0);  // equal to 0 on the left half
  const auto lines = isolines(mesh, values, 0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NEAR(polyline_length(mesh, lines[0]), 1.0, 1e-12);
  EXPECT_NEAR(polyline_points(mesh, lines[0]).col(0).maxCoeff(), 0.5, 1e-12);
}

TEST(Isolines, FacesWithInfiniteValuesAreSkipped) {
  const SurfaceMesh mesh(test::grid_soup(4, 4));
  VecX values = coordinate(mesh, 0);
  for (const double hole : {infinity, -infinity, std::nan("")}) {
    values[2 + 2 * 5] = hole;  // the middle vertex
    const auto lines = isolines(mesh, values, 0.4);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_LT(total_length(mesh, lines), 0.8);
    for (const Polyline& line : lines) {
      EXPECT_FALSE(line.closed);
      for (const SurfacePoint& p : line.nodes) EXPECT_NEAR(value_at(mesh, values, p), 0.4, 1e-12);
    }
  }
}

TEST(Isolines, LinesEndAtNonmanifoldEdges) {
  PolygonSoup soup;  // three wings on the edge 0-1
  soup.points.resize(5, 3);
  soup.points << 0, 0, 0, 0, 0, 1, 1, 0, 0, -1, 1, 0, -1, -1, 0;
  for (int wing = 2; wing < 5; ++wing) test::add_triangle(soup, 0, 1, wing);
  const SurfaceMesh mesh(soup);
  const auto lines = isolines(mesh, coordinate(mesh, 2), 0.5);
  ASSERT_EQ(lines.size(), 3u);
  for (const Polyline& line : lines) EXPECT_EQ(line.nodes.size(), 2u);
}

TEST(Isolines, OneFlippedFaceDoesNotBreakTheLine) {
  PolygonSoup soup = test::octasphere_soup(3);
  const SurfaceMesh whole(soup);
  const auto expected = isolines(whole, coordinate(whole, 2), 0.3);
  ASSERT_EQ(expected.size(), 1u);
  for (int f = 0; f < soup.n_faces(); ++f) {
    double low = 1, high = -1;
    for (int v : soup.face(f)) {
      low = std::min(low, soup.points(v, 2));
      high = std::max(high, soup.points(v, 2));
    }
    if (low > 0.3 || high < 0.3) continue;
    std::swap(soup.corners[soup.face_offsets[f]], soup.corners[soup.face_offsets[f] + 1]);
    break;
  }
  const SurfaceMesh mesh(soup);
  const auto lines = isolines(mesh, coordinate(mesh, 2), 0.3);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].closed);
  EXPECT_EQ(lines[0].nodes.size(), expected[0].nodes.size());
  const MatX3 p = polyline_points(mesh, lines[0]);  // larger values (north) on the left: eastwards
  EXPECT_GT(Vec3(p.row(0)).cross(Vec3(p.row(p.rows() / 4)))[2], 0);
}

TEST(Isolines, PolygonsJoinAroundTheSideOfTheirMiddle) {
  PolygonSoup soup;
  soup.points.resize(4, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  const int quad[4] = {0, 1, 2, 3};
  soup.add_face(quad);
  const SurfaceMesh mesh(soup);
  VecX saddle(4);
  saddle << 1, -0.5, 1, -0.5;  // the middle is above: cuts around corners 1 and 3
  auto lines = isolines(mesh, saddle, 0);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NEAR(total_length(mesh, lines), 2 * std::sqrt(2.0) / 3, 1e-12);
  // Around corner 1 (1,0) from the side 0-1 to the side 1-2: the middle is on the left.
  EXPECT_NEAR(polyline_points(mesh, lines[0])(0, 1), 0, 1e-12);
  lines = isolines(mesh, -saddle, 0);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NEAR(total_length(mesh, lines), 2 * std::sqrt(2.0) / 3, 1e-12);
}

TEST(Isolines, RefusesWrongLengthAndLevel) {
  const SurfaceMesh mesh(test::grid_soup(2, 2));
  EXPECT_THROW(isolines(mesh, VecX::Zero(3), 0), InputError);
  EXPECT_THROW(isolines(mesh, VecX::Zero(9), infinity), InputError);
  EXPECT_THROW(isolines(mesh, VecX::Zero(9), std::nan("")), InputError);
}

TEST(Isolines, HugeValuesStayOnTheEdge) {
  const SurfaceMesh mesh(test::grid_soup(1, 1));
  const VecX values = (2 * coordinate(mesh, 0).array() - 1) * 1.7e308;
  const auto lines = isolines(mesh, values, 0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NEAR(polyline_points(mesh, lines[0])(0, 0), 0.5, 1e-12);
}

// Lines of random fields: they only end at the boundary, and each crossed edge is passed once.
TEST(Isolines, RandomFieldsGiveCompleteLines) {
  const SurfaceMesh closed(test::torus_soup(12, 9)), open(test::jittered_grid_soup(9, 8, 0.3));
  for (unsigned seed = 0; seed < 60; ++seed) {
    const bool ties = seed % 2;
    for (const SurfaceMesh* mesh : {&closed, &open}) {
      const VecX values = random_values(mesh->n_vertices(), seed, ties);
      std::map<int, int> visits;
      for (const Polyline& line : isolines(*mesh, values, 0)) {
        ASSERT_GE(line.nodes.size(), 2u);
        EXPECT_TRUE(line.closed || mesh == &open);
        for (std::size_t i = 0; i < line.nodes.size(); ++i) {
          const SurfacePoint& p = line.nodes[i];
          EXPECT_NEAR(value_at(*mesh, values, p), 0, 1e-12);
          if (p.on == SurfacePoint::On::edge) ++visits[p.element];
          const SurfacePoint& last = line.nodes[i > 0 ? i - 1 : line.nodes.size() - 1];
          const bool follows = i > 0 || line.closed;
          EXPECT_FALSE(follows && p.on == last.on && p.element == last.element);
        }
        if (!line.closed) {
          for (const SurfacePoint& p : {line.nodes.front(), line.nodes.back()}) {
            EXPECT_TRUE(p.on == SurfacePoint::On::vertex ||
                        mesh->edge_faces(p.element).size() == 1);
          }
        }
      }
      for (int e = 0; e < mesh->n_edges(); ++e) {
        const double a = values[mesh->edges()(e, 0)], b = values[mesh->edges()(e, 1)];
        EXPECT_EQ(visits.count(e) ? visits[e] : 0, a * b < 0 ? 1 : 0);
      }
    }
  }
}

TEST(Isolines, LargerValuesAreOnTheLeft) {
  const SurfaceMesh mesh(test::jittered_grid_soup(8, 8, 0.3));
  const VecX values = random_values(mesh.n_vertices(), 7, false);
  for (const Polyline& line : isolines(mesh, values, 0.1)) {
    for (std::size_t i = 1; i < line.nodes.size(); ++i) {
      const Vec3 a = mesh.position(line.nodes[i - 1]), b = mesh.position(line.nodes[i]);
      const int e = line.nodes[i].element;
      const int v0 = mesh.edges()(e, 0), v1 = mesh.edges()(e, 1);
      const int high = values[v0] > values[v1] ? v0 : v1;
      EXPECT_GT((b - a).cross(mesh.point(high) - a)[2], 0);
    }
  }
}

}  // namespace
}  // namespace littoral
