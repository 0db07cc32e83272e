#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "littoral/error.h"
#include "sources/surface/pieces.h"
#include "sources/surface/surface_points.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using P = SurfacePoint;

Sources one_curve(std::vector<SurfacePoint> nodes, bool is_signed = true) {
  Sources sources;
  sources.curves.push_back({std::move(nodes), is_signed, "file.txt:9"});
  return sources;
}

Vec3 place(const SurfaceMesh& mesh, int face, const std::array<double, 3>& b) {
  return mesh.position(P::in_face(face, b[0], b[1], b[2]));
}

/// What every prepared set must satisfy. whole: no piece was left out.
void expect_sound(const SurfaceMesh& mesh, const PlacedSources& prepared, bool whole = true) {
  const double size = mesh.points().cwiseAbs().maxCoeff();
  ASSERT_EQ(prepared.n_curves, static_cast<int>(prepared.nodes.size()));
  for (std::size_t i = 0; i < prepared.pieces.size(); ++i) {
    const CurvePiece& piece = prepared.pieces[i];
    const Vec3 a = place(mesh, piece.face, piece.a), b = place(mesh, piece.face, piece.b);
    EXPECT_GT(piece.length, 0);
    EXPECT_NEAR((b - a).stableNorm(), piece.length, 1e-14 * size);
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(piece.a[k], 0);
      EXPECT_GE(piece.b[k], 0);
    }
    EXPECT_NEAR(piece.a[0] + piece.a[1] + piece.a[2], 1, 1e-15 * 4);
    EXPECT_NEAR(piece.b[0] + piece.b[1] + piece.b[2], 1, 1e-15 * 4);
    if (piece.edge >= 0) {
      int side = -1;
      for (int k = 0; k < 3; ++k)
        if (mesh.side_edge(piece.face, k) == piece.edge) side = k;
      ASSERT_GE(side, 0);
      EXPECT_EQ(piece.a[(side + 2) % 3], 0);
      EXPECT_EQ(piece.b[(side + 2) % 3], 0);
    }
    if (whole && i > 0 && prepared.pieces[i - 1].curve == piece.curve) {
      const CurvePiece& last = prepared.pieces[i - 1];
      EXPECT_LE((place(mesh, last.face, last.b) - a).stableNorm(), 1e-11 * size);
    }
  }
  for (const auto& nodes : prepared.nodes)
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
      EXPECT_TRUE(share_face(mesh, nodes[i], nodes[i + 1]));
}

double total_length(const PlacedSources& prepared) {
  double sum = 0;
  for (const CurvePiece& piece : prepared.pieces) sum += piece.length;
  return sum;
}

TEST(TracePieces, SimplestForms) {
  const SurfaceMesh mesh{test::grid_soup(1, 1)};  // faces (0,1,3), (0,3,2)
  EXPECT_EQ(simplest(mesh, P::in_face(0, 0, 1, 0)).on, P::On::vertex);
  EXPECT_EQ(simplest(mesh, P::in_face(0, 0, 1, 0)).element, 1);
  const P on_diagonal = simplest(mesh, P::in_face(1, 0.25, 0.75, 1e-15));
  EXPECT_EQ(on_diagonal.on, P::On::edge);
  EXPECT_EQ(on_diagonal.element, mesh.find_edge(0, 3));
  EXPECT_NEAR(mesh.position(on_diagonal)[0], 0.75, 1e-12);
  EXPECT_THAT(faces_at(mesh, on_diagonal), ElementsAre(0, 1));
  EXPECT_EQ(simplest(mesh, P::on_edge(on_diagonal.element, 0)).on, P::On::vertex);
  EXPECT_EQ(simplest(mesh, P::in_face(0, 0.2, 0.3, 0.5)).on, P::On::face);

  const auto b = barycentrics_in(mesh, on_diagonal, 0);
  ASSERT_TRUE(b);
  EXPECT_EQ((*b)[1], 0);
  EXPECT_NEAR((*b)[2], 0.75, 1e-12);
  EXPECT_FALSE(barycentrics_in(mesh, P::at_vertex(1), 1));
  EXPECT_FALSE(share_face(mesh, P::at_vertex(1), P::at_vertex(2)));
  EXPECT_TRUE(share_face(mesh, P::at_vertex(1), on_diagonal));
}

TEST(TracePieces, AlongEdgesAndInsideFaces) {
  const SurfaceMesh mesh{test::grid_soup(2, 2)};
  Report report;
  const auto prepared = place_sources(
      mesh, one_curve({P::at_vertex(0), P::at_vertex(1), P::in_face(2, 0, 0, 1)}), report);
  expect_sound(mesh, prepared);
  ASSERT_EQ(prepared.pieces.size(), 2u);
  EXPECT_EQ(prepared.pieces[0].edge, mesh.find_edge(0, 1));
  EXPECT_EQ(prepared.pieces[1].edge, mesh.find_edge(1, mesh.face(2)[2]));
  EXPECT_TRUE(report.warnings.empty());

  const auto crossing = place_sources(
      mesh, one_curve({P::in_face(0, 0.2, 0.6, 0.2), P::on_edge(mesh.find_edge(0, 4), 0.5)}, false),
      report);
  ASSERT_EQ(crossing.pieces.size(), 1u);
  EXPECT_EQ(crossing.pieces[0].edge, -1);
  EXPECT_EQ(crossing.pieces[0].face, 0);
  EXPECT_FALSE(crossing.pieces[0].is_signed);
}

TEST(TracePieces, GapsAreTracedAndCounted) {
  const SurfaceMesh mesh{test::octasphere_soup(3)};
  Report report;
  const auto prepared = place_sources(
      mesh, one_curve({P::at_vertex(0), P::at_vertex(2), P::at_vertex(1), P::at_vertex(0)}),
      report);
  expect_sound(mesh, prepared);
  EXPECT_TRUE(report.warnings.empty());  // all are as far apart as the others
  ASSERT_EQ(report.sizes.size(), 1u);
  EXPECT_EQ(report.sizes[0], (std::pair<std::string, double>("traced segments", 3)));
  EXPECT_NEAR(total_length(prepared), 2 * std::acos(-1.0), 0.03 * 2);
  EXPECT_EQ(prepared.nodes[0].front().element, prepared.nodes[0].back().element);  // closed
}

TEST(TracePieces, WarnsWhereOneSegmentIsFarLongerThanTheOthers) {
  const SurfaceMesh mesh{test::grid_soup(20, 1)};
  Report report;
  place_sources(mesh,
                one_curve({P::at_vertex(0), P::at_vertex(1), P::at_vertex(2), P::at_vertex(3),
                           P::at_vertex(15), P::at_vertex(16)}),
                report);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(
      report.warnings[0].text.find("1 segment of curve 1 (file.txt:9) joins nodes that share no "
                                   "face and are far apart"),
      std::string::npos)
      << report.warnings[0].text;
}

TEST(TracePieces, ReversedTurnsSignedCurvesOnly) {
  const SurfaceMesh mesh{test::grid_soup(4, 4)};
  Sources sources = one_curve({P::at_vertex(0), P::at_vertex(24)});
  sources.curves.push_back({{P::at_vertex(4), P::at_vertex(20)}, false, ""});
  SpaceCurve space;
  space.points.resize(2, 3);
  space.points << 0.1, 0.2, 0, 0.9, 0.2, 0;
  sources.space_curves.push_back(space);
  Report report;
  const auto straight = place_sources(mesh, sources, report);
  const auto flipped = place_sources(mesh, sources.reversed(), report);
  expect_sound(mesh, flipped);
  ASSERT_EQ(flipped.n_curves, 3);
  EXPECT_EQ(flipped.nodes[0].front().element, 24);
  EXPECT_EQ(flipped.nodes[1].front().element, 4);
  EXPECT_TRUE(mesh.position(flipped.nodes[2].front()).isApprox(Vec3(0.9, 0.2, 0), 1e-12));
  EXPECT_TRUE(mesh.position(straight.nodes[2].front()).isApprox(Vec3(0.1, 0.2, 0), 1e-12));
  EXPECT_NEAR(total_length(straight), total_length(flipped), 1e-12);
}

TEST(TracePieces, RepeatedNodesAreDroppedWithACount) {
  PolygonSoup soup = test::grid_soup(2, 2);
  soup.points.row(4) = soup.points.row(1);  // coincident vertices: an edge without length
  const SurfaceMesh mesh{soup};
  Report report;
  const auto prepared = place_sources(mesh,
                                      one_curve({P::at_vertex(0), P::at_vertex(0), P::at_vertex(1),
                                                 P::at_vertex(4), P::at_vertex(5)}),
                                      report);
  expect_sound(mesh, prepared);
  EXPECT_EQ(prepared.pieces.size(), 2u);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_THAT(report.warnings[0], HasSubstr("2 zero-length steps of curve 1 (file.txt:9)"));
}

void expect_refused(const SurfaceMesh& mesh, const Sources& sources, const std::string& say) {
  Report report;
  try {
    place_sources(mesh, sources, report);
    ADD_FAILURE() << "accepted: " << say;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(say));
  }
}

TEST(TracePieces, BadSourcesAreRefused) {
  PolygonSoup soup = test::grid_soup(2, 2);
  soup.points.conservativeResize(10, 3);
  soup.points.row(9).setZero();  // isolated
  const SurfaceMesh mesh{soup};
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  expect_refused(mesh, {}, "nothing to measure distance from");
  expect_refused(mesh, one_curve({P::at_vertex(0), P::at_vertex(0)}), "nothing");
  expect_refused(mesh, one_curve({P::at_vertex(0)}), "one node");
  expect_refused(mesh, one_curve({}), "no nodes");
  expect_refused(mesh, one_curve({P::at_vertex(0), P::at_vertex(10)}), "vertex 10");
  expect_refused(mesh, one_curve({P::at_vertex(0), P::at_vertex(9)}), "no face");
  expect_refused(mesh, one_curve({P::at_vertex(-1), P::at_vertex(9)}), "vertex -1");
  expect_refused(mesh, one_curve({P::on_edge(99, 0.5), P::at_vertex(0)}), "edge 99");
  expect_refused(mesh, one_curve({P::on_edge(0, 1.5), P::at_vertex(0)}), "edge 0");
  expect_refused(mesh, one_curve({P::on_edge(0, nan), P::at_vertex(0)}), "file.txt:9");
  expect_refused(mesh, one_curve({P::in_face(8, 1, 0, 0), P::at_vertex(0)}), "face 8");
  expect_refused(mesh, one_curve({P::in_face(1, 0.5, 0, 0), P::at_vertex(0)}), "sum");
  expect_refused(mesh, one_curve({P::in_face(1, inf, -inf, 1), P::at_vertex(0)}), "face 1");
  Sources point;
  point.points.push_back(P::at_vertex(77));
  expect_refused(mesh, point, "vertex 77");
  Sources space;
  space.space_curves.resize(1);
  space.space_curves[0].points.resize(2, 3);
  space.space_curves[0].points << 0, 0, 0, nan, 0, 0;
  expect_refused(mesh, space, "not finite");
  space.space_curves[0].points << 0, 0, 0, 1e9, 0, 0;
  expect_refused(mesh, space, "unit");

  PolygonSoup quad = test::grid_soup(1, 1);
  const int corners[] = {0, 1, 3, 2};
  quad.add_face(corners);
  Report report;
  EXPECT_THROW(
      place_sources(SurfaceMesh{quad}, one_curve({P::at_vertex(0), P::at_vertex(1)}), report),
      UnsupportedError);
}

TEST(TracePieces, PropertyRandomSourcesAreSound) {
  EXPECT_TRUE(rc::check([] {
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    PolygonSoup soup = test::torus_soup(12, 8);
    for (int i = *rc::gen::inRange(0, 20); i > 0; --i) {
      const std::size_t c = random() % soup.corners.size();
      if (i % 2)
        soup.points.row(soup.corners[c]) = soup.points.row(soup.corners[c / 3 * 3]);
      else
        soup.corners[c] = soup.corners[c / 3 * 3];
    }
    const SurfaceMesh mesh{soup};
    std::uniform_real_distribution<double> u(0, 1);
    std::vector<SurfacePoint> nodes;
    for (int i = 0; i < 6; ++i) {
      const int f = static_cast<int>(random() % mesh.n_faces());
      const double a = u(random), b = (1 - a) * u(random);
      nodes.push_back(i % 3 == 0   ? P::at_vertex(mesh.face(f)[0])
                      : i % 3 == 1 ? P::on_edge(mesh.side_edge(f, 1), a)
                                   : P::in_face(f, a, b, 1 - a - b));
    }
    Report report;
    PlacedSources prepared;
    try {
      prepared = place_sources(mesh, one_curve(nodes), report);
    } catch (const InputError&) {
      RC_ASSERT(mesh.n_components() > 1);  // the only reason to refuse these
      return;
    }
    const bool whole = std::none_of(
        report.warnings.begin(), report.warnings.end(),
        [](const Warning& w) { return w.text.find("repeat a vertex") != std::string::npos; });
    expect_sound(mesh, prepared, whole);
    RC_ASSERT(!testing::Test::HasFailure());
    Report other;
    const PlacedSources again = place_sources(mesh, one_curve(prepared.nodes[0]), other);
    RC_ASSERT(again.pieces.size() == prepared.pieces.size());  // nothing left to trace
    const double length = total_length(prepared);
    RC_ASSERT(std::abs(total_length(again) - length) <= 1e-12 * length);  // added in another order
  }));
}

TEST(Pieces, WhatLiesInFacesWithoutSurfaceIsNamed) {
  // A square of two triangles and a face that repeats a vertex, with an edge of its own.
  PolygonSoup soup;
  soup.points.resize(5, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0;
  for (const auto& [a, b, c] : {std::array{0, 1, 2}, std::array{0, 2, 3}, std::array{1, 4, 4}})
    test::add_triangle(soup, a, b, c);
  const SurfaceMesh mesh(soup);
  Sources sources;
  Curve& curve = sources.curves.emplace_back();
  for (const int v : {3, 0, 1, 4}) curve.nodes.push_back(SurfacePoint::at_vertex(v));
  Curve& still = sources.curves.emplace_back();
  for (const int v : {2, 2}) still.nodes.push_back(SurfacePoint::at_vertex(v));
  sources.points = {SurfacePoint::at_vertex(4)};
  Report report;
  const PlacedSources placed = place_sources(mesh, sources, report);
  EXPECT_EQ(placed.pieces.size(), 2U);
  const auto warned = [&](const std::string& text) {
    return std::any_of(report.warnings.begin(), report.warnings.end(), [&](const auto& warning) {
      return warning.text.find(text) != std::string::npos;
    });
  };
  EXPECT_TRUE(warned("1 piece of curve 1 in faces that repeat a vertex was left out"));
  EXPECT_TRUE(warned("curve 2 has no length"));
  EXPECT_TRUE(warned("point source 1 lies on vertex 4"));
}

}  // namespace
}  // namespace littoral
