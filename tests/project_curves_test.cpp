#include "sources/curves/project_curves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "constants.h"
#include "io/read.h"
#include "littoral/error.h"
#include "shared_data.h"
#include "sources/surface/pieces.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::pi;
using testing::HasSubstr;

double length(const SurfaceMesh& mesh, const std::vector<SurfacePoint>& nodes) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
    sum += (mesh.position(nodes[i + 1]) - mesh.position(nodes[i])).stableNorm();
  return sum;
}

double length(const SpaceCurve& curve) {
  double sum = 0;
  for (Eigen::Index i = 0; i + 1 < curve.points.rows(); ++i)
    sum += (curve.points.row(i + 1) - curve.points.row(i)).norm();
  return sum;
}

/// Segments in any order joined to curves that run until they close or end.
std::vector<SpaceCurve> space_curves(const PolygonSoup& soup) {
  std::map<int, std::vector<int>> next;
  std::size_t left = 0;
  for (const auto& line : soup.lines)
    for (std::size_t i = 0; i + 1 < line.size(); ++i, ++left) {
      next[line[i]].push_back(line[i + 1]);
      next[line[i + 1]].push_back(line[i]);
    }
  std::vector<SpaceCurve> curves;
  for (const auto& [seed, unused] : next) {
    std::vector<int> walk{seed};
    while (!next[walk.back()].empty()) {
      const int a = walk.back(), b = next[a].back();
      next[a].pop_back();
      std::erase(next[b], a);
      walk.push_back(b);
    }
    if (walk.size() < 2) continue;
    SpaceCurve curve;
    curve.points = soup.points(walk, Eigen::all);
    curve.origin = "curve.obj";
    curves.push_back(std::move(curve));
  }
  return curves;
}

TEST(ProjectCurves, CircleAboveTheEquator) {
  const SurfaceMesh mesh{test::octasphere_soup(5)};
  SpaceCurve circle;
  const int n = 37;
  circle.points.resize(n + 1, 3);
  for (int i = 0; i <= n; ++i) {
    const double angle = 2 * pi * (i % n) / n;
    circle.points.row(i) << 1.3 * std::cos(angle), 1.3 * std::sin(angle), 0.39;
  }
  circle.origin = "ring.obj:4";
  Report report;
  const ProjectedCurve projected = CurveProjector(mesh).project(circle, report);
  ASSERT_EQ(projected.curves.size(), 1u);
  const auto& nodes = projected.curves[0].nodes;
  EXPECT_EQ(mesh.position(nodes.front()), mesh.position(nodes.back()));
  // Closest points of a curve far from the faces are drawn to creases: a little longer than the
  // arc.
  EXPECT_NEAR(length(mesh, nodes), 2 * pi * std::cos(std::atan2(0.39, 1.3)), 0.15);
  EXPECT_NEAR(projected.largest_move, std::hypot(1.3, 0.39) - 1, 0.02);
  for (const SurfacePoint& node : nodes) {
    const Vec3 p = mesh.position(node);
    EXPECT_NEAR(std::atan2(p[2], std::hypot(p[0], p[1])), std::atan2(0.39, 1.3), 0.02);
  }
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_THAT(report.warnings[0], HasSubstr("ring.obj:4"));
  EXPECT_THAT(report.warnings[0], HasSubstr("% of the bounding box diagonal"));
}

TEST(ProjectCurves, CurveOnTheSurfaceStays) {
  const SurfaceMesh mesh{test::jittered_grid_soup(20, 20, 0.2)};
  SpaceCurve zigzag;
  zigzag.points.resize(4, 3);
  zigzag.points << 0.1, 0.1, 0, 0.9, 0.3, 0, 0.2, 0.7, 0, 0.8, 0.8, 0;
  Report report;
  const ProjectedCurve projected = CurveProjector(mesh).project(zigzag, report);
  ASSERT_EQ(projected.curves.size(), 1u);
  EXPECT_LT(projected.largest_move, 1e-12);
  EXPECT_NEAR(length(mesh, projected.curves[0].nodes), length(zigzag), 1e-6);
  EXPECT_TRUE(report.warnings.empty());
}

TEST(ProjectCurves, SplitsBetweenComponents) {
  PolygonSoup soup = test::grid_soup(4, 4);
  const int n = soup.n_vertices(), faces = soup.n_faces();
  MatX3 points(2 * n, 3);
  points << soup.points, soup.points.rowwise() + Eigen::RowVector3d(1.5, 0, 0);
  soup.points = points;
  for (int f = 0; f < faces; ++f)
    test::add_triangle(soup, soup.face(f)[0] + n, soup.face(f)[1] + n, soup.face(f)[2] + n);
  const SurfaceMesh mesh{std::move(soup)};
  Sources sources;
  sources.space_curves.resize(1);
  sources.space_curves[0].points.resize(2, 3);
  sources.space_curves[0].points << 0.3, 0.4, 0, 2.2, 0.4, 0;
  Report report;
  const PlacedSources prepared = place_sources(mesh, sources, report);
  EXPECT_EQ(prepared.n_curves, 2);
  double sum = 0;
  for (const CurvePiece& piece : prepared.pieces) sum += piece.length;
  EXPECT_NEAR(sum, 0.7 + 0.7, 1e-9);
  ASSERT_FALSE(report.warnings.empty());
  EXPECT_THAT(report.warnings.back(), HasSubstr("split into 2"));
}

TEST(ProjectCurves, SquiggleOnSphere) {
  LITTORAL_NEEDS_SHARED("data/curves/rc-squiggle-on-sphere.obj");
  LITTORAL_NEEDS_SHARED("data/generated/analytic/sphere4.obj");
  const auto curves =
      space_curves(io::read_surface(test::shared() / "data/curves/rc-squiggle-on-sphere.obj"));
  const SurfaceMesh mesh{io::read_surface(test::shared() / "data/generated/analytic/sphere4.obj")};
  const CurveProjector projector(mesh);
  for (const SpaceCurve& curve : curves) {
    Report report;
    const ProjectedCurve projected = projector.project(curve, report);
    ASSERT_EQ(projected.curves.size(), 1u);
    const auto& nodes = projected.curves[0].nodes;
    EXPECT_LT(projected.largest_move, 0.1);
    EXPECT_NEAR(length(mesh, nodes), length(curve), 0.03 * length(curve));
    EXPECT_EQ(mesh.position(nodes.front()) == mesh.position(nodes.back()),
              curve.points.row(0) == curve.points.row(curve.points.rows() - 1));
  }
  EXPECT_FALSE(curves.empty());
}

TEST(ProjectCurves, TorusCurvesOnSharedMeshes) {
  LITTORAL_NEEDS_SHARED("data/curves/rc-multi-on-torus.obj");
  LITTORAL_NEEDS_SHARED("data/generated/analytic/torus.obj");
  const SurfaceMesh mesh{io::read_surface(test::shared() / "data/generated/analytic/torus.obj")};
  Sources sources;
  sources.space_curves =
      space_curves(io::read_surface(test::shared() / "data/curves/rc-multi-on-torus.obj"));
  ASSERT_FALSE(sources.space_curves.empty());
  Report report;
  const PlacedSources prepared = place_sources(mesh, sources, report);
  EXPECT_EQ(prepared.n_curves, static_cast<int>(sources.space_curves.size()));
  EXPECT_GT(prepared.pieces.size(), 100u);
}

TEST(ProjectCurves, BrokenMeshes) {
  for (const char* name : {"needles", "collinear", "coincident_verts", "repeat_index", "book5",
                           "edge_cubes", "bowtie_cubes", "flat_1e-6", "tiny_1e-30", "huge_1e30",
                           "tiny_1e-200", "huge_1e200", "offset_1e7", "allcoincident", "two_scales",
                           "anisotropic_1e4", "soup", "dup_faces_opposite"}) {
    SCOPED_TRACE(name);
    const auto path = std::string("data/generated/geometry/") + name + ".obj";
    LITTORAL_NEEDS_SHARED(path);
    const SurfaceMesh mesh{io::read_surface(test::shared() / path)};
    const Tracer tracer(mesh);
    std::mt19937 random(4);
    int traced = 0;
    for (int i = 0; i < 12; ++i) {
      const int f = static_cast<int>(random() % mesh.n_faces());
      const int g = static_cast<int>(random() % mesh.n_faces());
      const auto a = simplest(mesh, SurfacePoint::in_face(f, 0.2, 0.3, 0.5));
      const auto b = simplest(mesh, SurfacePoint::at_vertex(mesh.face(g)[1]));
      if (tracer.component(a) != tracer.component(b)) continue;
      const auto way = tracer.trace(a, b);
      ++traced;
      for (std::size_t k = 0; k + 1 < way.size(); ++k)
        EXPECT_TRUE(share_face(mesh, way[k], way[k + 1]));
      EXPECT_TRUE(std::isfinite(length(mesh, way)));
    }
    EXPECT_EQ(traced == 0, mesh.n_components() > 12);

    SpaceCurve chord;  // through the middle of the mesh
    chord.points.resize(2, 3);
    chord.points << mesh.points().row(mesh.face(0)[0]),
        mesh.points().row(mesh.face(mesh.n_faces() - 1)[1]);
    Report report;
    const ProjectedCurve projected = CurveProjector(mesh).project(chord, report);
    ASSERT_FALSE(projected.curves.empty());
    for (const Curve& curve : projected.curves)
      EXPECT_TRUE(std::isfinite(length(mesh, curve.nodes)));
    EXPECT_TRUE(std::isfinite(projected.largest_move));
  }
}

TEST(ProjectCurves, NodesThatShareNoFaceAreTraced) {
  // What generated/curves/bad_nonadjacent.txt holds: vertices 0, 5, 300.
  LITTORAL_NEEDS_SHARED("data/generated/curves/sphere_cap.obj");
  const SurfaceMesh mesh{io::read_surface(test::shared() / "data/generated/curves/sphere_cap.obj")};
  Sources sources;
  sources.curves.push_back(
      {{SurfacePoint::at_vertex(0), SurfacePoint::at_vertex(5), SurfacePoint::at_vertex(300)},
       true,
       "bad_nonadjacent.txt:2"});
  Report report;
  const PlacedSources prepared = place_sources(mesh, sources, report);
  EXPECT_TRUE(report.warnings.empty());
  ASSERT_EQ(report.sizes.size(), 1u);
  EXPECT_EQ(report.sizes[0].second, 2);  // traced segments
  const Vec3 a = mesh.point(0).normalized(), b = mesh.point(5).normalized(),
             c = mesh.point(300).normalized();
  const double radius = mesh.point(0).norm();
  const double arcs = radius * (std::acos(a.dot(b)) + std::acos(b.dot(c)));
  EXPECT_NEAR(length(mesh, prepared.nodes[0]), arcs, 0.01 * arcs);
}

}  // namespace
}  // namespace littoral
