// Points where heat methods are known to err: next to each other, at boundaries and corners, and
// inside faces.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "heat_helpers.h"
#include "methods/heat/cell_field.h"
#include "sources/systems/source_parts.h"
#include "test_meshes.h"

namespace littoral {
namespace {

Sources points_at(const std::vector<SurfacePoint>& points) {
  Sources sources;
  sources.points = points;
  return sources;
}

double nearest(const SurfaceMesh& mesh, const Sources& sources, const Vec3& p) {
  double d = 1e300;
  for (const SurfacePoint& s : sources.points) d = std::min(d, (mesh.position(s) - p).norm());
  return d;
}

/// Distance by both methods; signed heat at the automatic time scale.
std::vector<VecX> both(const SurfaceMesh& mesh, const Sources& sources) {
  Report report;
  return {test::unsigned_heat(mesh, sources, report), test::signed_heat(mesh, sources, {}, report)};
}

struct Errors {
  double mean = 0, largest = 0;
};

Errors errors(const SurfaceMesh& mesh, const Sources& sources, const VecX& u) {
  Errors e;
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const double d = std::abs(u[v] - nearest(mesh, sources, mesh.point(v)));
    e.mean += d / mesh.n_vertices();
    e.largest = std::max(e.largest, d);
  }
  return e;
}

constexpr int cells = 40;
std::vector<SurfaceMesh> squares() {
  std::vector<SurfaceMesh> all;
  for (int diagonal : {0, 1}) all.emplace_back(test::grid_soup(cells, cells, diagonal));
  for (unsigned seed : {1u, 2u})
    all.emplace_back(test::jittered_grid_soup(cells, cells, 0.3, seed));
  return all;
}

TEST(HeatPoints, PartsOfAFieldGetTheirUnitsBack) {
  // Solves scale the source of every part to 1. Blocks of two; the third is on no part.
  const std::vector<int> part{0, 1, -1, 0, 2};
  VecX b(10), x(10), expected(10);
  b << 3, -6, 0, 24, 7, 7, 2, 1, 0, 0;
  x << 0.5, -1, 0, 1, 0, 0, 2. / 6, 1. / 6, 1, 1;
  expected << 3, -6, 0, 24, 0, 0, 2, 1, 24e-20, 24e-20;  // the last has no source: as good as 0
  ScaledField<double> field{x, {0, 0, -1, 0, 0}, {1}};
  restore_units(field, nonzero_blocks(b, 2), part);
  EXPECT_EQ(field.scale[0], 24);
  EXPECT_LT((24 * field.x - expected).cwiseAbs().maxCoeff(), 1e-15);
  // Of parts alike only the unit changes.
  b << 3, -6, 0, 6, 0, 0, 2, 1, 6, 6;
  field = {x, {0, 0, -1, 0, 0}, {0.5}};
  restore_units(field, nonzero_blocks(b, 2), part);
  EXPECT_EQ(field.scale[0], 3);
  EXPECT_EQ(field.x, x);
}

TEST(HeatPoints, MidwayBetweenTwoPoints) {
  // One sum of heat from both gave 0.32, 0.62, 0.81, 0.91 of the exact value, and 0.22, 0.49, 0.67,
  // 0.82 as vectors at time scale 16, on the second of these meshes.
  const int middle = cells / 2 + cells / 2 * (cells + 1);
  for (const SurfaceMesh& mesh : squares())
    for (int k : {1, 2, 4, 8}) {  // 2 k edges apart
      const Sources sources = test::vertex_points({middle - k, middle + k});
      for (const VecX& u : both(mesh, sources)) {
        EXPECT_NEAR(u[middle - k], 0, 1e-9);
        EXPECT_NEAR(u[middle + k], 0, 1e-9);
        const double share = u[middle] / nearest(mesh, sources, mesh.point(middle));
        EXPECT_NEAR(share, 1, k == 1 ? 0.25 : 0.11) << 2 * k << " edges apart";
        EXPECT_LT(errors(mesh, sources, u).mean, 0.15 / cells);
      }
    }
}

TEST(HeatPoints, ManyPointsAreAsAccurateAsOne) {
  const SurfaceMesh mesh(test::jittered_grid_soup(cells, cells, 0.3));
  std::mt19937 random(7);
  Sources one = test::vertex_points({cells / 2 + cells / 2 * (cells + 1)}), many;
  for (int i = 0; i < 60; ++i)
    many.points.push_back(
        SurfacePoint::at_vertex(static_cast<int>(random() % ((cells + 1) * (cells + 1)))));
  for (int method : {0, 1}) {
    EXPECT_LT(errors(mesh, one, both(mesh, one)[method]).mean, 0.15 / cells);
    const Errors b = errors(mesh, many, both(mesh, many)[method]);
    EXPECT_LT(b.mean, 0.15 / cells);
    EXPECT_LT(b.largest, 1.3 / cells);
  }
}

TEST(HeatPoints, TwoPointsOnASphere) {
  const SurfaceMesh mesh(test::octasphere_soup(5));
  int a = 4, b = -1;  // the pole (0, 0, 1), and a vertex about 6 edges off
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (b < 0 ||
        std::abs(std::acos(mesh.point(v).z()) - 0.3) < std::abs(std::acos(mesh.point(b).z()) - 0.3))
      b = v;
  const Sources sources = test::vertex_points({a, b});
  for (const VecX& u : both(mesh, sources)) {
    double mean = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const Vec3 p = mesh.point(v);
      const auto angle = [&](int q) {
        return std::acos(std::clamp(p.dot(mesh.point(q)), -1., 1.));
      };
      const double exact = std::min(angle(a), angle(b));
      mean += std::abs(u[v] - exact) / mesh.n_vertices();
      EXPECT_NEAR(u[v], exact, exact < 0.5 ? 0.03 : 0.12);
    }
    EXPECT_LT(mean, 0.02);
  }
}

TEST(HeatPoints, CornersAndSidesOfASquare) {
  // Radial vectors at a corner have a net direction, which outlives the rest: 0.71 at the far end
  // of a side.
  const SurfaceMesh mesh(test::grid_soup(cells, cells, 1));
  for (int source : {0, cells, cells / 2, (cells / 2) * (cells + 1)}) {
    const Sources sources = test::vertex_points({source});
    for (const VecX& u : both(mesh, sources)) {
      EXPECT_LT(errors(mesh, sources, u).mean, 0.012);
      EXPECT_LT(errors(mesh, sources, u).largest, 0.055);
    }
  }
  const Sources on_side = points_at({SurfacePoint::on_edge(mesh.find_edge(7, 8), 0.3)});
  for (const VecX& u : both(mesh, on_side)) EXPECT_LT(errors(mesh, on_side, u).mean, 0.02);
}

/// A fan of `rings` rings about the origin from angle 0 to `total`, its rays at uneven angles.
PolygonSoup uneven_fan(double total, int rings, int rays) {
  PolygonSoup soup;
  std::vector<Vec3> points{{0, 0, 0}};
  for (int i = 1; i <= rings; ++i)
    for (int k = 0; k <= rays; ++k) {
      const double s = double(k) / rays, angle = total * (0.6 * s + 0.4 * s * s * s);
      points.emplace_back(std::cos(angle) * i / rings, std::sin(angle) * i / rings, 0);
    }
  soup.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v)
    soup.points.row(static_cast<Eigen::Index>(v)) = points[v];
  for (int k = 0; k < rays; ++k) test::add_triangle(soup, 0, 1 + k, 2 + k);
  for (int i = 1; i < rings; ++i)
    for (int k = 0; k < rays; ++k) {
      const int a = 1 + (i - 1) * (rays + 1) + k, b = a + rays + 1;
      test::add_triangle(soup, a, b, b + 1);
      test::add_triangle(soup, a, b + 1, a + 1);
    }
  return soup;
}

TEST(HeatPoints, UnevenFansAndAHalfDisk) {
  const double turn = 2 * std::acos(-1.0);
  for (double total : {turn / 8, turn / 4, turn / 2, 0.7 * turn}) {
    const SurfaceMesh mesh(uneven_fan(total, 20, 14));
    for (const VecX& u : both(mesh, test::vertex_points({0})))
      for (int v = 0; v < mesh.n_vertices(); ++v)
        EXPECT_NEAR(u[v], mesh.point(v).norm(), 0.06) << total << " at " << mesh.point(v);
  }
}

TEST(HeatPoints, ExactOnTheTrianglesThatHoldThePoint) {
  const SurfaceMesh mesh(test::jittered_grid_soup(12, 12, 0.3));
  Report report;
  const Sources sources =
      points_at({SurfacePoint::at_vertex(30), SurfacePoint::in_face(150, 0.2, 0.3, 0.5),
                 SurfacePoint::on_edge(200, 0.4)});
  const auto p = test::problem(mesh, sources, report);
  for (int c : p.terms.near)
    for (int k = 0; k < 3; ++k) {
      const int v = p.T.faces(c, k);
      EXPECT_NEAR(p.terms.d0[v] * p.T.unit, nearest(mesh, sources, mesh.point(v)), 1e-12);
    }
  EXPECT_EQ(p.terms.near.size(), mesh.vertex_faces(30).size() + 1 + 2);
  for (const VecX& u : both(mesh, sources)) EXPECT_LT(errors(mesh, sources, u).mean, 0.3 / 12);
}

TEST(HeatPoints, PointsBesideCurvesKeepTheCurveAtZero) {
  const SurfaceMesh mesh(test::grid_soup(12, 12, 1));
  Sources sources;
  Curve curve;
  for (int j = 0; j <= 12; ++j) curve.nodes.push_back(SurfacePoint::at_vertex(6 + 13 * j));
  sources.curves.push_back(curve);
  sources.points = {SurfacePoint::at_vertex(7 + 13 * 6), SurfacePoint::at_vertex(2 + 13 * 6)};
  for (const VecX& u : both(mesh, sources)) {
    ASSERT_TRUE(u.allFinite());
    for (const SurfacePoint& p : curve.nodes) EXPECT_NEAR(u[p.element], 0, 1e-8);
    for (const SurfacePoint& p : sources.points) EXPECT_NEAR(u[p.element], 0, 1e-8);
  }
}

TEST(HeatPoints, BatchesSeparateNeighbours) {
  const SurfaceMesh mesh(test::grid_soup(30, 30, 1));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  std::vector<PartStart> starts;
  const int across = 6;
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < across; ++i)
      starts.push_back({5 * i + 5 * j * 31, static_cast<int>(starts.size()), 0});
  const std::vector<int> batch = batches_of_parts(T, starts, across * across);
  EXPECT_LT(*std::max_element(batch.begin(), batch.end()), 16);
  for (int j = 0; j < across; ++j)
    for (int i = 0; i + 1 < across; ++i) {
      EXPECT_NE(batch[i + j * across], batch[i + 1 + j * across]);
      EXPECT_NE(batch[j + i * across], batch[j + (i + 1) * across]);
    }
  for (int j = 0; j < across; ++j)
    for (int i = 0; i + 2 < across; ++i)
      EXPECT_NE(batch[i + j * across], batch[i + 2 + j * across]);
  EXPECT_THAT(batches_of_parts(T, {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}, 3),
              testing::ElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace littoral
