// What is known beside sources before anything is solved for: distances at the corners of their
// triangles, samples of curves, values, paths along edges.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "domain/mesh/polygon_surface.h"
#include "littoral/error.h"
#include "sources/surface/known_distances.h"
#include "sources/surface/p2_sources.h"
#include "sources/surface/source_values.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using testing::HasSubstr;

struct Placed {
  explicit Placed(const PolygonSoup& soup, const Sources& sources)
      : mesh(soup),
        T(intrinsic_triangulation(mesh, report)),
        placed(place_sources(mesh, sources, report)),
        on_triangles(triangle_sources(mesh, T, placed)) {}

  /// Of nodes of corners and middles of sides, in space.
  Vec3 node(int i) const {
    if (i < T.n_vertices) return mesh.point(i);
    return 0.5 *
           (mesh.point(T.edges(i - T.n_vertices, 0)) + mesh.point(T.edges(i - T.n_vertices, 1)));
  }

  Report report;
  SurfaceMesh mesh;
  IntrinsicTriangulation T;
  PlacedSources placed;
  TriangleSources on_triangles;
};

double to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const double length2 = (b - a).squaredNorm();
  const double s = length2 > 0 ? std::clamp((x - a).dot(b - a) / length2, 0.0, 1.0) : 0;
  return (x - a - s * (b - a)).norm();
}

/// Is x, of the plane or of a page of a book, in the triangle?
bool holds(const Placed& p, int f, const Vec3& x) {
  const Vec3 a = p.mesh.point(p.T.faces(f, 0)), b = p.mesh.point(p.T.faces(f, 1)),
             c = p.mesh.point(p.T.faces(f, 2));
  const Vec3 n = (b - a).cross(c - a);
  if (std::abs(n.normalized().dot(x - a)) > 1e-9) return false;
  for (const auto& [q, r] : {std::pair(a, b), {b, c}, {c, a}})
    if (n.dot((r - q).cross(x - q)) < -1e-9 * n.squaredNorm()) return false;
  return true;
}

/// The distance in each triangle that a piece or one of its ends lies in, by looking at all.
std::map<int, double> around_by_looking(const Placed& p, TriangleNodes nodes) {
  std::map<int, double> known;
  const auto know = [&](int node, double d) {
    const auto [at, fresh] = known.try_emplace(node, d);
    if (!fresh) at->second = std::min(at->second, d);
  };
  for (const CurvePiece& piece : p.placed.pieces) {
    const Vec3 a =
        p.mesh.position(SurfacePoint::in_face(piece.face, piece.a[0], piece.a[1], piece.a[2]));
    const Vec3 b =
        p.mesh.position(SurfacePoint::in_face(piece.face, piece.b[0], piece.b[1], piece.b[2]));
    for (int f = 0; f < p.T.n_faces(); ++f) {
      const bool at_a = holds(p, f, a), at_b = holds(p, f, b);
      const auto add = [&](const Vec3& q, const Vec3& r) {
        for (int k = 0; k < 3; ++k) {
          know(p.T.faces(f, k), to_segment(p.node(p.T.faces(f, k)), q, r));
          const int middle = p.T.n_vertices + p.T.side_edge(f, k);
          if (nodes == TriangleNodes::corners_and_middles)
            know(middle, to_segment(p.node(middle), q, r));
        }
      };
      if (at_a && at_b)
        add(a, b);
      else if (at_a)
        add(a, a);
      else if (at_b)
        add(b, b);
    }
  }
  return known;
}

SurfacePoint random_inside(const SurfaceMesh& mesh, std::mt19937& random) {
  std::uniform_real_distribution<double> some(0.05, 0.45);
  const double b = some(random), c = some(random);
  return SurfacePoint::in_face(static_cast<int>(random() % unsigned(mesh.n_faces())), 1 - b - c, b,
                               c);
}

TEST(KnownDistances, AreThoseInTheTrianglesThatHoldPiecesAndEnds) {
  std::mt19937 random(1);
  for (const PolygonSoup& soup : {test::jittered_grid_soup(6, 5, 0.2), test::book_soup(3, 4, 2.1),
                                  test::book_soup(2, 4, 3.0)}) {
    const SurfaceMesh mesh(soup);
    for (int round = 0; round < 20; ++round) {
      Sources sources;
      sources.add(Curve::through({random_inside(mesh, random), random_inside(mesh, random)}));
      const int e = static_cast<int>(random() % unsigned(mesh.n_edges()));  // ends on a side
      sources.add(Curve::through({SurfacePoint::on_edge(e, 0.3),
                                  SurfacePoint::in_face(mesh.edge_faces(e)[0], 0.3, 0.3, 0.4)}));
      const Placed p(soup, sources);
      for (const TriangleNodes nodes :
           {TriangleNodes::corners, TriangleNodes::corners_and_middles}) {
        const auto expected = around_by_looking(p, nodes);
        const auto found = distances_around(p.T, p.on_triangles.segments, nodes);
        ASSERT_EQ(found.size(), expected.size());
        auto at = expected.begin();
        for (const NodeDistance& d : found) {
          EXPECT_EQ(d.node, at->first);
          EXPECT_NEAR(d.distance * p.T.unit, at->second, 1e-9);
          Vec3 x = Vec3::Zero();
          for (int k = 0; k < 3; ++k) x += d.b[k] * p.mesh.point(p.T.faces(d.triangle, k));
          EXPECT_LT((x - p.node(d.node)).norm(), 1e-12);
          ++at;
        }
      }
    }
  }
}

TEST(KnownDistances, AlongEdgesOnlyTheirOwnNodesAreKnown) {
  Sources sources;
  sources.add(Curve::along_vertices({6, 7, 8}));
  const Placed p(test::grid_soup(4, 4), sources);
  const KnownDistances corners = known_distances(p.T, p.on_triangles, TriangleNodes::corners);
  EXPECT_EQ(corners, (KnownDistances{{6, 0.0}, {7, 0.0}, {8, 0.0}}));
  const KnownDistances all =
      known_distances(p.T, p.on_triangles, TriangleNodes::corners_and_middles);
  KnownDistances expected = corners;
  for (const int v : {6, 7}) expected[p.T.n_vertices + p.mesh.find_edge(v, v + 1)] = 0;
  EXPECT_EQ(all, expected);
}

TEST(KnownDistances, OfPoints) {
  Sources sources;
  sources.add(SurfacePoint::at_vertex(12)).add(SurfacePoint::in_face(0, 0.25, 0.25, 0.5));
  const Placed p(test::grid_soup(4, 4), sources);
  KnownDistances expected{{12, 0.0}};
  const Vec3 x = p.mesh.position(sources.points[1]);
  for (const int v : p.mesh.face(0)) expected[v] = (p.mesh.point(v) - x).norm() / p.T.unit;
  const KnownDistances known = known_distances(p.T, p.on_triangles, TriangleNodes::corners);
  ASSERT_EQ(known.size(), expected.size());
  for (const auto& [v, d] : expected) EXPECT_NEAR(known.at(v), d, 1e-14) << v;
}

TEST(KnownDistances, OnPolygonsThroughSpace) {
  PolygonSoup soup;  // a square and a triangle beside it
  soup.points.resize(5, 3);
  soup.points << 0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0, 3, 1, 0;
  soup.add_face(std::array{0, 1, 2, 3});
  soup.add_face(std::array{1, 4, 2});
  Report report;
  const NodalSurface S = polygon_surface(SurfaceMesh(soup), report);
  ASSERT_EQ(S.refined->n_vertices(), 6);  // the middle (1, 1) is vertex 5
  const auto known = [&](const Sources& sources) {
    const PlacedSources placed = place_sources(*S.refined, sources, report);
    KnownDistances d = known_distances(S, triangle_sources(*S.refined, *S.place, placed));
    for (auto& [node, distance] : d) distance *= S.place->unit;
    return d;
  };
  const auto expect = [&](const Sources& sources, const KnownDistances& expected) {
    const KnownDistances found = known(sources);
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [v, d] : expected) EXPECT_NEAR(found.at(v), d, 1e-12) << v;
  };
  expect(Sources(SurfacePoint::at_vertex(4)), {{4, 0}});
  const double r = std::sqrt(2.0);
  expect(Sources(SurfacePoint::at_vertex(5)), {{0, r}, {1, r}, {2, r}, {3, r}});
  Sources edge;
  edge.add(Curve::along_vertices({1, 2}));
  expect(edge, {{1, 0}, {2, 0}});
  Sources to_middle;
  to_middle.add(Curve::along_vertices({0, 5}));
  expect(to_middle, {{0, 0}, {1, r}, {2, r}, {3, r}});
  Sources across;  // of the triangle (1, 4, 2), from the middle of one side to that of another
  across.add(Curve::through({SurfacePoint::on_edge(S.refined->find_edge(1, 4), 0.5),
                             SurfacePoint::on_edge(S.refined->find_edge(2, 4), 0.5)}));
  expect(across, {{1, std::hypot(0.5, 0.5)}, {2, std::hypot(0.5, 0.5)}, {4, 0.5}});
}

/// Where samples of a curve on a plane are.
std::vector<Vec3> samples(const Placed& p, double spacing) {
  std::vector<Vec3> out;
  for (const P2Source<2>& source : p2_sources(p.mesh, p.T, p.placed, spacing)) {
    EXPECT_TRUE(source.on_curve);
    EXPECT_EQ(source.distance, 0);
    EXPECT_EQ(source.where.size(), 1u);
    Vec3 x = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      x += source.where[0].b[k] * p.mesh.point(p.T.faces(source.where[0].element, k));
    out.push_back(x);
  }
  return out;
}

TEST(P2Sources, SamplesOfACurveAreEquallyFarApartWithBothEnds) {
  std::mt19937 random(7);
  const PolygonSoup soup = test::jittered_grid_soup(7, 6, 0.2);
  const SurfaceMesh mesh(soup);
  std::uniform_real_distribution<double> some(0.1, 2);
  for (int round = 0; round < 300; ++round) {
    const SurfacePoint a = random_inside(mesh, random), b = random_inside(mesh, random);
    const Placed p(soup, Sources().add(Curve::through({a, b})));
    const double spacing = some(random), step = spacing * mean_edge_lengths(p.T)[0] * p.T.unit;
    const Vec3 from = mesh.position(a), to = mesh.position(b);
    const double length = (to - from).norm();
    const std::vector<Vec3> points = samples(p, spacing);
    const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(length / step)));
    ASSERT_EQ(points.size(), count + 1);
    for (std::size_t i = 0; i <= count; ++i)
      EXPECT_LT((points[i] - from - double(i) / double(count) * (to - from)).norm(), 1e-9);
  }
}

TEST(P2Sources, SpacingIsThatOfTheComponent) {
  PolygonSoup soup = test::grid_soup(8, 8);  // and the same again, ten times as large
  const int n = soup.n_vertices();
  const PolygonSoup one = soup;
  soup.points.conservativeResize(2 * n, 3);
  soup.points.bottomRows(n) = 10 * one.points;
  soup.points.bottomRows(n).col(2).setConstant(3);
  for (int f = 0; f < one.n_faces(); ++f)
    test::add_triangle(soup, n + one.face(f)[0], n + one.face(f)[1], n + one.face(f)[2]);
  for (const int first : {0, n}) {
    Sources sources;
    sources.add(Curve::along_vertices({first, first + 8}));
    const Placed p(soup, sources);
    EXPECT_EQ(samples(p, 0.5).size(),
              samples(Placed(one, Sources().add(Curve::along_vertices({0, 8}))), 0.5).size());
  }
}

TEST(P2Sources, PointsCountOnceAndInEveryTriangleAround) {
  Sources sources;
  sources.add(SurfacePoint::at_vertex(12)).add(SurfacePoint::at_vertex(12));
  sources.add(SurfacePoint::in_face(3, 0.2, 0.3, 0.5)).add(SurfacePoint::in_face(3, 0.3, 0.2, 0.5));
  sources.add(SurfacePoint::in_face(3, 0.2, 0.3, 0.5));
  const Placed p(test::grid_soup(4, 4), sources);
  const auto found = p2_sources(p.mesh, p.T, p.placed, 0);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].where.size(), p.mesh.vertex_faces(12).size());
  for (const auto& [element, b] : found[0].where) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(b[k], p.T.faces(element, k) == 12);
  }
  EXPECT_EQ(found[1].where.size(), 1u);
  EXPECT_FALSE(found[1].on_curve);
}

TEST(P2Sources, ASpacingTooSmallIsRefused) {
  const Placed p(test::grid_soup(2, 2), Sources().add(Curve::along_vertices({0, 1})));
  EXPECT_THROW(p2_sources(p.mesh, p.T, p.placed, 0.0009), InputError);
  EXPECT_NO_THROW(p2_sources(p.mesh, p.T, p.placed, 0.001));
  EXPECT_NO_THROW(p2_sources(p.mesh, p.T, p.placed, 0));
}

TEST(ValueRange, HoldsTheValuesOfAllSources) {
  EXPECT_TRUE(value_range({}).same());
  EXPECT_EQ(value_range({}).low, 0);
  Sources sources;
  sources.add(Curve::along_vertices({0, 1}).with_value(3));
  EXPECT_EQ(value_range(sources).low, 3);
  EXPECT_TRUE(value_range(sources).same());
  sources.add(SurfacePoint::at_vertex(0));
  EXPECT_EQ(value_range(sources).low, 0);
  sources.add(SurfacePoint::at_vertex(0), -2);
  sources.add(Curve::along_vertices({0, 1}).with_value(9).unsigned_curve());
  SpaceCurve curve;
  curve.value = 11;
  sources.add(curve);
  curve.value = -11;
  curve.is_signed = false;
  sources.add(curve);
  EXPECT_EQ(value_range(sources).low, -11);
  EXPECT_EQ(value_range(sources).high, 11);
  EXPECT_FALSE(value_range(sources).same());
  EXPECT_EQ(signed_value_range(sources).low, 3);
  EXPECT_EQ(signed_value_range(sources).high, 11);
  const Sources shifted = shifted_values(sources, 0.5);
  EXPECT_EQ(value_range(shifted).low, -10.5);
  EXPECT_EQ(value_range(shifted).high, 11.5);
  EXPECT_EQ(shifted.point_value(0), 0.5);
  EXPECT_EQ(shifted.point_value(1), -1.5);
}

TEST(EdgePaths, AreTheShortest) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> some(0.1, 2);
  for (int round = 0; round < 40; ++round) {
    constexpr int n = 14;
    std::vector<EdgePaths::Edge> edges;
    MatX all = MatX::Constant(n, n, infinity);
    all.diagonal().setZero();
    for (int i = 0; i < 18; ++i) {
      const int a = static_cast<int>(random() % n), b = static_cast<int>(random() % n);
      const double length = some(random);
      edges.push_back({a, b, length});
      if (a != b) all(a, b) = all(b, a) = std::min(all(a, b), length);
    }
    for (int k = 0; k < n; ++k)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) all(i, j) = std::min(all(i, j), all(i, k) + all(k, j));
    const EdgePaths paths(n, edges);
    const std::vector<EdgePaths::Start> starts{{0, 0.0}, {5, -0.7}, {9, 1.3}};
    for (const double limit : {infinity, 1.5}) {
      const VecX found = paths.lengths(starts, limit);
      for (int v = 0; v < n; ++v) {
        double least = infinity;
        for (const auto& [from, value] : starts) least = std::min(least, value + all(from, v));
        if (least > limit) least = infinity;
        if (least < infinity)
          EXPECT_NEAR(found[v], least, 1e-12);
        else
          EXPECT_EQ(found[v], infinity);
      }
    }
  }
}

TEST(EdgePaths, ReachFromPointsInsideFacesGoesByTheirCorners) {
  Sources sources;
  sources.add(SurfacePoint::in_face(0, 0.2, 0.3, 0.5), 0.25).add(SurfacePoint::at_vertex(24), 1);
  const Placed p(test::jittered_grid_soup(4, 4, 0.2), sources);
  const VecX reach = reach_along_edges(p.T, p.on_triangles) * p.T.unit;
  const Vec3 x = p.mesh.position(sources.points[0]);
  for (int v = 0; v < p.mesh.n_vertices(); ++v) {
    EXPECT_GE(reach[v], std::min(0.25 + (p.mesh.point(v) - x).norm(),
                                 1 + (p.mesh.point(v) - p.mesh.point(24)).norm()) -
                            1e-12);
  }
  for (const int v : p.mesh.face(0))
    EXPECT_NEAR(reach[v], 0.25 + (p.mesh.point(v) - x).norm(), 1e-12);
  EXPECT_NEAR(reach[24], 1, 1e-12);
}

TEST(ShadowedSources, EightAreNamedAndTheOthersCounted) {
  for (const int n : {0, 1, 8, 9, 11}) {
    std::vector<std::pair<std::string, double>> excess;
    for (int i = 0; i < n; ++i) excess.emplace_back("curve " + std::to_string(i + 1), i + 0.5);
    Report report;
    warn_of_shadowed(excess, report);
    ASSERT_EQ(static_cast<int>(report.warnings.size()), std::min(n, 8) + (n > 8));
    if (n > 0) {
      EXPECT_THAT(report.warnings[0].text, HasSubstr("curve 1 has a value 0.5 above"));
    }
    if (n == 9) {
      EXPECT_THAT(report.warnings[8].text, HasSubstr("1 more source is shadowed"));
    }
    if (n == 11) {
      EXPECT_THAT(report.warnings[8].text, HasSubstr("3 more sources are shadowed"));
    }
  }
}

TEST(ShadowedSources, AreThoseThatOthersReachSooner) {
  const PolygonSoup soup = test::grid_soup(4, 4);
  const auto warned = [&](double at_face, double at_curve) {
    Sources sources(SurfacePoint::at_vertex(0));
    sources.add(SurfacePoint::in_face(31, 0.2, 0.3, 0.5), at_face);  // at the far corner
    sources.add(Curve::along_vertices({20, 21}).with_value(at_curve));
    const Placed p(soup, sources);
    Report report;
    warn_of_shadowed(p.mesh, p.T, p.placed, report);
    std::vector<std::string> out;
    for (const Warning& w : report.warnings) out.push_back(w.text.substr(0, w.text.find(" has")));
    return out;
  };
  using testing::ElementsAre;
  EXPECT_THAT(warned(0, 0), testing::IsEmpty());
  EXPECT_THAT(warned(1, 0.9), testing::IsEmpty());
  EXPECT_THAT(warned(5, 0.9), ElementsAre("point source 2"));
  EXPECT_THAT(warned(1, 1.1), ElementsAre("curve 1"));
  EXPECT_THAT(warned(5, 5), ElementsAre("curve 1", "point source 2"));
}

}  // namespace
}  // namespace littoral
