// Surfaces made of other ones: without copies, split at jumps, with longer sides, of polygons.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "constants.h"
#include "domain/intrinsic/lengthened_sides.h"
#include "domain/mesh/polygon_surface.h"
#include "domain/mesh/split_at_jumps.h"
#include "domain/mesh/unique_faces.h"
#include "littoral/error.h"
#include "sources/surface/refined_sources.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Two triangles of a square, then a third that covers the first, turned.
PolygonSoup square_with_copy() {
  PolygonSoup soup = test::grid_soup(1, 1);
  test::add_triangle(soup, 3, 1, 0);
  return soup;
}

/// A tetrahedron with two of its faces there twice.
PolygonSoup tetrahedron_with_copies() {
  PolygonSoup soup;
  soup.points.resize(4, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  for (const auto& c : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 0}, {1, 2, 3}, {3, 2, 1}, {0, 3, 2}})
    test::add_triangle(soup, c[0], c[1], c[2]);
  return soup;
}

TEST(UniqueFaces, CopiesGoAndTheFirstOfEachStays) {
  const auto input = std::make_shared<const SurfaceMesh>(tetrahedron_with_copies());
  const UniqueFaces unique(input);
  ASSERT_TRUE(unique.any_copies());
  EXPECT_EQ(unique.n_copies(), 2);
  EXPECT_THAT(unique.input_face, ElementsAre(0, 1, 3, 5));
  EXPECT_THAT(unique.face_of_input, ElementsAre(0, 1, 0, 2, 2, 3));
  EXPECT_EQ(unique.mesh->n_faces(), 4);
  EXPECT_EQ(unique.mesh->edges(), input->edges());
}

TEST(UniqueFaces, APointInACopyIsWhereItWas) {
  const SurfaceMesh input(tetrahedron_with_copies());
  const UniqueFaces unique(std::make_shared<const SurfaceMesh>(input));
  for (int f = 0; f < input.n_faces(); ++f) {
    const SurfacePoint before = SurfacePoint::in_face(f, 0.2, 0.3, 0.5);
    Sources sources(before);
    sources.add(Curve::through({before, SurfacePoint::at_vertex(0)}));
    const Sources after = unique.on_mesh(input, sources);
    EXPECT_LT((unique.mesh->position(after.points[0]) - input.position(before)).norm(), 1e-15) << f;
    EXPECT_EQ(after.curves[0].nodes[0].element, unique.face_of_input[std::size_t(f)]);
    EXPECT_EQ(after.curves[0].nodes[1].element, 0);
  }
}

TEST(UniqueFaces, ElementsThatAreNotThereKeepTheirNumbers) {
  const SurfaceMesh input(tetrahedron_with_copies());
  const UniqueFaces unique(std::make_shared<const SurfaceMesh>(input));
  for (const int f : {-1, input.n_faces(), 100}) {
    const Sources after = unique.on_mesh(input, Sources(SurfacePoint::in_face(f, 1, 0, 0)));
    EXPECT_EQ(after.points[0].element, f);
  }
}

TEST(UniqueFaces, WithoutCopiesItIsTheInput) {
  for (const auto& soup : {test::grid_soup(3, 2), test::octasphere_soup(1)}) {
    const auto input = std::make_shared<const SurfaceMesh>(soup);
    EXPECT_EQ(UniqueFaces(input).mesh, input);
    EXPECT_FALSE(UniqueFaces(input).any_copies());
    EXPECT_EQ(UniqueFaces(input).n_copies(), 0);
  }
}

TEST(UniqueFaces, ACopyAtARimIsFoundToo) {
  const UniqueFaces unique(std::make_shared<const SurfaceMesh>(square_with_copy()));
  EXPECT_THAT(unique.face_of_input, ElementsAre(0, 1, 0));
}

TEST(SplitAtJumps, VerticesAreDoubledWhereKeysDiffer) {
  const SurfaceMesh mesh(test::grid_soup(2, 1));  // four triangles, from left to right
  Rows<std::int64_t, 3> key(4, 3);
  key << 0, 0, 0, 0, 0, 0, 7, 7, 7, 7, 7, 7;
  const SplitSurface split = split_at_jumps(mesh, key);
  EXPECT_EQ(split.soup.n_vertices(), 8);  // 1 and 4 there twice
  EXPECT_EQ(SurfaceMesh(split.soup).n_components(), 2);
  for (int f = 0; f < 4; ++f)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(Vec3(split.soup.points.row(split.soup.face(f)[k])), mesh.point(mesh.face(f)[k]));
  for (std::size_t v = 0; v < split.corner.size(); ++v) {
    const auto [f, k] = split.corner[v];
    EXPECT_EQ(split.soup.face(f)[std::size_t(k)], static_cast<int>(v));
  }
  EXPECT_EQ(split_at_jumps(mesh, Rows<std::int64_t, 3>::Zero(4, 3)).soup.n_vertices(), 6);
}

TEST(LengthenedSides, OnlyTrianglesThatAreTooThinChange) {
  PolygonSoup soup;
  soup.points.resize(5, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.25, -1e-9, 0, 0.5, -1, 0;
  test::add_triangle(soup, 0, 1, 2);
  test::add_triangle(soup, 1, 0, 3);
  test::add_triangle(soup, 0, 4, 3);
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(SurfaceMesh(soup), report);
  IntrinsicTriangulation longer = T;
  EXPECT_EQ(lengthen_sides(longer, 1e-3), 1);
  EXPECT_EQ(longer.length.row(0), T.length.row(0));
  EXPECT_EQ(longer.length.row(2), T.length.row(2));
  const auto l = longer.length.row(1);
  EXPECT_NEAR((l.sum() - 2 * l.maxCoeff()) / T.length.row(1).maxCoeff(), 1e-3, 1e-12);
  for (int k = 1; k < 3; ++k)
    EXPECT_NEAR(l[k] - l[0], T.length(1, k) - T.length(1, 0), 1e-15);  // all by the same
}

TEST(LengthenedSides, SidesOfNoLengthBecomeAShareOfTheMeanEdge) {
  PolygonSoup soup = test::grid_soup(1, 1);
  Report report;
  IntrinsicTriangulation T = intrinsic_triangulation(SurfaceMesh(soup), report);
  T.length.row(1).setZero();
  EXPECT_EQ(lengthen_sides(T, 0.25), 1);
  for (int k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(T.length(1, k), 0.25 * T.mean_edge_length);
}

TEST(LengthenedSides, NeedlesAreCountedInAWarning) {
  PolygonSoup soup = test::grid_soup(1, 1);
  soup.points.row(3) = soup.points.row(1) + soup.points.row(2) * 1e-8;
  Report report;
  const auto T = std::make_shared<const IntrinsicTriangulation>(
      intrinsic_triangulation(SurfaceMesh(soup), report));
  ASSERT_TRUE(report.warnings.empty());
  const auto thicker = without_needles(T, report);
  EXPECT_NE(thicker, T);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(report.warnings[0].code, "degenerate-faces");
  EXPECT_THAT(report.warnings[0].text, HasSubstr("1 thin face had"));
  const auto fine = std::make_shared<const IntrinsicTriangulation>(
      intrinsic_triangulation(SurfaceMesh(test::grid_soup(2, 2)), report));
  EXPECT_EQ(without_needles(fine, report), fine);
  EXPECT_EQ(report.warnings.size(), 1u);
}

/// A pentagon and a triangle beside it, and both in triangles: a fan about the pentagon's first.
struct Pentagon {
  SurfaceMesh input, refined;
  std::vector<int> face_offsets{0, 3, 4};

  static PolygonSoup points() {
    PolygonSoup soup;
    soup.points.resize(6, 3);
    soup.points << 0, 0, 0, 2, 0, 0, 3, 2, 0, 1, 3, 0, -1, 2, 0, 4, 0, 0;
    return soup;
  }
  static PolygonSoup polygons() {
    PolygonSoup soup = points();
    soup.add_face(std::array{0, 1, 2, 3, 4});
    soup.add_face(std::array{1, 5, 2});
    return soup;
  }
  static PolygonSoup triangles() {
    PolygonSoup soup = points();
    for (const auto& c : {std::array{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {1, 5, 2}}) soup.add_face(c);
    return soup;
  }
  Pentagon() : input(polygons()), refined(triangles()) {}
};

TEST(RefinedSources, PointsStayWhereTheyAre) {
  const Pentagon p;
  std::vector<SurfacePoint> points{SurfacePoint::at_vertex(4),
                                   SurfacePoint::in_face(1, 0.2, 0.3, 0.5)};
  for (int e = 0; e < p.input.n_edges(); ++e) points.push_back(SurfacePoint::on_edge(e, 0.25));
  for (const auto& [b, c] : {std::pair(0.2, 0.3), {-0.4, 0.9}, {0.1, 0.8}, {-1, 0.7}})
    points.push_back(SurfacePoint::in_face(0, 1 - b - c, b, c));
  Sources sources;
  sources.points = points;
  sources.add(Curve::through(points));
  const Sources out = refined_sources(p.input, p.refined, p.face_offsets, sources);
  ASSERT_EQ(out.points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT((p.refined.position(out.points[i]) - p.input.position(points[i])).norm(), 1e-14) << i;
    EXPECT_LT((p.refined.position(out.curves[0].nodes[i]) - p.input.position(points[i])).norm(),
              1e-14);
  }
  EXPECT_EQ(out.points[1].element, 3);
}

TEST(RefinedSources, AtAnySize) {
  for (const double size : {1e-200, 1e200}) {
    PolygonSoup polygons = Pentagon::polygons(), triangles = Pentagon::triangles();
    polygons.points *= size;
    triangles.points *= size;
    const SurfaceMesh input(polygons), refined(triangles);
    const SurfacePoint point = SurfacePoint::in_face(0, 0.5, -0.4, 0.9);
    const Sources out = refined_sources(input, refined, {0, 3, 4}, Sources(point));
    EXPECT_LT((refined.position(out.points[0]) - input.position(point)).cwiseAbs().maxCoeff(),
              1e-14 * size);
  }
}

TEST(RefinedSources, APointBesideItsPolygonGoesToTheNearest) {
  const Pentagon p;
  const Sources out =
      refined_sources(p.input, p.refined, p.face_offsets,
                      Sources(SurfacePoint::in_face(0, 0.5, 1, -0.5)));  // (0.5, -1)
  EXPECT_LT((p.refined.position(out.points[0]) - Vec3(0.5, 0, 0)).norm(), 1e-15);
}

TEST(RefinedSources, ElementsThatAreNotThereAreRefused) {
  const Pentagon p;
  for (const SurfacePoint& point :
       {SurfacePoint::at_vertex(6), SurfacePoint::at_vertex(-1), SurfacePoint::on_edge(7, 0.5),
        SurfacePoint::in_face(2, 1, 0, 0), SurfacePoint::in_face(-1, 1, 0, 0)})
    EXPECT_THROW(refined_sources(p.input, p.refined, p.face_offsets, Sources(point)), InputError);
}

TEST(PolygonSurface, PolygonsOfVeryManyCornersAreCutOnTheirOwn) {
  constexpr int n = 100;  // a star of radii 1 and 1/2, beside a triangle
  PolygonSoup soup;
  soup.points.resize(3 + n, 3);
  soup.points.topRows(3) << 5, 0, 0, 6, 0, 0, 5, 1, 0;
  std::vector<int> corners;
  for (int k = 0; k < n; ++k) {
    const double r = k % 2 == 0 ? 1 : 0.5, turn = 2 * test::pi * k / n;
    soup.points.row(3 + k) << r * std::cos(turn), r * std::sin(turn), 0;
    corners.push_back(3 + k);
  }
  soup.add_face(std::array{0, 1, 2});
  soup.add_face(corners);
  Report report;
  const NodalSurface S = polygon_surface(SurfaceMesh(soup), report);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(report.warnings[0].code, "polygons-cut");
  EXPECT_THAT(report.warnings[0].text, HasSubstr("1 polygon of more than 64 corners"));
  EXPECT_EQ(S.refined->n_vertices(), 3 + n);
  EXPECT_EQ(S.face_offsets, (std::vector<int>{0, 1, n - 1}));
  EXPECT_EQ(S.n_patches(), n - 1);
  double area = 0;
  for (int f = 1; f < S.refined->n_faces(); ++f) {
    const auto c = S.refined->face(f);
    const Vec3 a = S.refined->point(c[0]);
    const double z = (S.refined->point(c[1]) - a).cross(S.refined->point(c[2]) - a).z() / 2;
    EXPECT_GT(z, 0);
    area += z;
  }
  EXPECT_NEAR(area, n * 0.5 * 0.5 * std::sin(2 * test::pi / n), 1e-12);
}

}  // namespace
}  // namespace littoral
