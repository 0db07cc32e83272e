// Cutting along segments: they run along edges then, and nothing else changes.

#include "domain/mesh/cut_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "test_meshes.h"

namespace littoral {
namespace {

using Barycentrics = std::array<double, 3>;

/// At a corner, on a side or inside, by number: 0..2, 3..5, others.
Barycentrics point_of_face(int kind, std::mt19937& random) {
  std::uniform_real_distribution<double> some(0.05, 0.95);
  Barycentrics b{};
  const std::size_t k = std::size_t(kind) % 3;
  if (kind < 3) {
    b[k] = 1;
  } else if (kind < 6) {
    b[k] = some(random);
    b[(k + 1) % 3] = 1 - b[k];
  } else {
    b[0] = some(random);
    b[1] = (1 - b[0]) * some(random);
    b[2] = 1 - b[0] - b[1];
  }
  return b;
}

Vec3 place_of(const SurfaceMesh& mesh, int f, const Barycentrics& b) {
  return mesh.position(SurfacePoint::in_face(f, b[0], b[1], b[2]));
}

double area_above(const SurfaceMesh& mesh, int f) {
  const auto c = mesh.face(f);
  const Vec3 a = mesh.point(c[0]);
  return 0.5 * (mesh.point(c[1]) - a).cross(mesh.point(c[2]) - a).z();
}

void expect_along_segments(const SurfaceMesh& mesh, const std::vector<CutSegment>& segments,
                           const CutMesh& cut) {
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto& path = cut.path[s];
    const Vec3 a = place_of(mesh, segments[s].face, segments[s].a);
    const Vec3 d = place_of(mesh, segments[s].face, segments[s].b) - a;
    ASSERT_GE(path.size(), 2u);
    EXPECT_LE((cut.mesh.point(path.front()) - a).norm(), 1e-9);
    EXPECT_LE((cut.mesh.point(path.back()) - a - d).norm(), 1e-9);
    double before = -1;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const Vec3 x = cut.mesh.point(path[i]) - a;
      const double t = x.dot(d) / d.squaredNorm();
      EXPECT_LE((x - t * d).norm(), 1e-9);
      EXPECT_GT(t, before);
      before = t;
      if (i > 0) {
        EXPECT_GE(cut.mesh.find_edge(path[i - 1], path[i]), 0);
      }
    }
  }
}

TEST(CutMesh, RandomSegmentsBecomeEdgesOfTrianglesOfTheSameSurface) {
  std::mt19937 random(7);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    PolygonSoup soup = test::jittered_grid_soup(3, 3, 0.2, unsigned(round));
    const SurfaceMesh mesh(soup);
    std::vector<CutSegment> segments;
    std::vector<char> touched(std::size_t(mesh.n_faces()), 0);
    for (int i = 0; i < 1 + round % 8; ++i) {
      CutSegment s;
      s.face = int(random() % unsigned(mesh.n_faces()));
      s.a = point_of_face(int(random() % 8), random);
      s.b = point_of_face(int(random() % 8), random);
      if ((place_of(mesh, s.face, s.a) - place_of(mesh, s.face, s.b)).norm() < 0.01) continue;
      segments.push_back(s);
      for (int k = 0; k < 3; ++k)
        for (const int f : mesh.edge_faces(mesh.side_edge(s.face, k))) touched[std::size_t(f)] = 1;
    }
    const CutMesh cut = cut_mesh(mesh, segments);
    expect_along_segments(mesh, segments, cut);
    for (int v = 0; v < mesh.n_vertices(); ++v) EXPECT_EQ(cut.mesh.point(v), mesh.point(v));
    ASSERT_EQ(int(cut.point.size()), cut.mesh.n_vertices());
    for (int v = 0; v < cut.mesh.n_vertices(); ++v)
      EXPECT_LE((mesh.position(cut.point[std::size_t(v)]) - cut.mesh.point(v)).norm(), 1e-12);
    std::vector<double> area(std::size_t(mesh.n_faces()), 0);
    std::vector<int> pieces(std::size_t(mesh.n_faces()), 0);
    for (int f = 0; f < cut.mesh.n_faces(); ++f) {
      const auto parent = std::size_t(cut.parent_face[std::size_t(f)]);
      EXPECT_GT(area_above(cut.mesh, f), 0);
      area[parent] += area_above(cut.mesh, f);
      ++pieces[parent];
    }
    for (int f = 0; f < mesh.n_faces(); ++f) {
      EXPECT_NEAR(area[std::size_t(f)], area_above(mesh, f), 1e-12);
      if (!touched[std::size_t(f)]) {
        EXPECT_EQ(pieces[std::size_t(f)], 1);
      }
    }
    int outside = 0;  // a disc still: what was an edge of two faces is one, in parts or whole
    for (int e = 0; e < cut.mesh.n_edges(); ++e) {
      const auto n = cut.mesh.edge_faces(e).size();
      EXPECT_LE(n, 2u);
      if (n == 1) {
        const Vec3 x = cut.mesh.position(SurfacePoint::on_edge(e, 0.5));
        EXPECT_TRUE(std::min(x.x(), x.y()) < 1e-12 || std::max(x.x(), x.y()) > 1 - 1e-12);
        ++outside;
      }
    }
    EXPECT_GE(outside, 12);
    EXPECT_EQ(cut.mesh.n_vertices() - cut.mesh.n_edges() + cut.mesh.n_faces(), 1);
  }
}

TEST(CutMesh, EndsNearACornerOrEachOtherAreOne) {
  PolygonSoup soup = test::grid_soup(1, 1);
  const SurfaceMesh mesh(soup);
  const auto vertices = [&](double x, double y) {  // of cuts from two places of side 0
    const CutMesh cut =
        cut_mesh(mesh, {{0, {1 - x, x, 0}, {0, 0, 1}}, {0, {1 - y, y, 0}, {0, 0, 1}}});
    return cut.mesh.n_vertices() - mesh.n_vertices();
  };
  EXPECT_EQ(vertices(0.3, 0.6), 2);
  EXPECT_EQ(vertices(0.3, 0.3 + 1e-8), 2);
  EXPECT_EQ(vertices(0.3, 0.3 + 1e-10), 1);
  EXPECT_EQ(vertices(0.3 + 1e-10, 0.3), 1);
  EXPECT_EQ(vertices(0.3, 1e-8), 2);
  EXPECT_EQ(vertices(0.3, 1e-10), 1);
  EXPECT_EQ(vertices(1 - 1e-10, 0.3), 1);
  EXPECT_EQ(vertices(1 - 1e-8, 0.3), 2);
}

TEST(CutMesh, FacesWithoutAreaAreCutWhereTheirCoordinatesSay) {
  // Corners on a line, or nearly, with the middle one first, second and third, or at one place.
  for (const double height : {0.0, 1e-9, 1e-3})
    for (int turn = 0; turn < 4; ++turn) {
      SCOPED_TRACE(testing::Message() << height << ", " << turn);
      PolygonSoup soup;
      soup.points.resize(4, 3);
      soup.points << 0, 0, 0, 1, 0, 0, 0.4, height, 0, 0.3, 1, 0;
      if (turn == 3) soup.points.topRows(3).setZero();
      test::add_triangle(soup, turn % 3, (turn + 1) % 3, (turn + 2) % 3);
      test::add_triangle(soup, turn % 3, (turn + 2) % 3, 3);
      const SurfaceMesh mesh(soup);
      const Barycentrics inside{0.3, 0.2, 0.5}, on_0{0.6, 0.4, 0}, on_1{0, 0.7, 0.3},
          corner{0, 0, 1};
      const CutMesh cut = cut_mesh(
          mesh, {{0, on_0, inside}, {0, inside, on_1}, {0, corner, on_0}, {0, on_0, on_1}});
      const auto expect_at = [&](int v, const Barycentrics& b) {
        const SurfacePoint& p = cut.point[std::size_t(v)];
        if (*std::max_element(b.begin(), b.end()) == 1) {
          EXPECT_EQ(v, mesh.face(0)[std::size_t(std::max_element(b.begin(), b.end()) - b.begin())]);
          return;
        }
        for (int k = 0; k < 3; ++k) {
          if (b[std::size_t(k + 2) % 3] != 0) continue;  // not on side k
          ASSERT_EQ(p.on, SurfacePoint::On::edge);
          ASSERT_EQ(p.element, mesh.side_edge(0, k));
          const double t = b[std::size_t(k + 1) % 3];
          EXPECT_NEAR(p.b[1], mesh.side_along(0, k) ? t : 1 - t, 1e-9);
        }
        if (*std::min_element(b.begin(), b.end()) > 0) {
          for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(p.b[k], b[k], 1e-6) << k;
        }
      };
      expect_at(cut.path[0].front(), on_0);
      expect_at(cut.path[0].back(), inside);
      expect_at(cut.path[1].front(), inside);
      expect_at(cut.path[1].back(), on_1);
      expect_at(cut.path[2].front(), corner);
      expect_at(cut.path[3].back(), on_1);
      for (const auto& path : cut.path)
        for (std::size_t i = 1; i < path.size(); ++i)
          EXPECT_GE(cut.mesh.find_edge(path[i - 1], path[i]), 0);
      // A disc, of which nothing is doubled.
      EXPECT_EQ(cut.mesh.n_vertices() - cut.mesh.n_edges() + cut.mesh.n_faces(), 1);
      for (int e = 0; e < cut.mesh.n_edges(); ++e) EXPECT_LE(cut.mesh.edge_faces(e).size(), 2u);
    }
}

}  // namespace
}  // namespace littoral
