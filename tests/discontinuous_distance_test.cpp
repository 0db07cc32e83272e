// Distance that jumps: exact on flat tori, the same as ever where nothing has to jump.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/error.h"
#include "methods/heat/discontinuous.h"
#include "one_call.h"
#include "test_meshes.h"

namespace littoral {
namespace {

Sources vertex_loop(std::vector<int> vertices) {
  Sources sources;
  Curve& curve = sources.curves.emplace_back();
  for (int v : vertices) curve.nodes.push_back(SurfacePoint::at_vertex(v));
  return sources;
}

SurfaceAnswer distance(const SurfaceMesh& mesh, const Sources& sources, const SignedHeat& method) {
  Report report;
  return test::surface_answer(mesh, sources, method, report);
}

TEST(DiscontinuousDistance, LeavesIntegrableFieldsAlone) {
  // Unit vectors along x in the plane: phi = x, no jumps, no curl.
  const SurfaceMesh mesh(test::jittered_grid_soup(9, 9, 0.3));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const JumpCalculus J = jump_calculus(T);
  VecX Y(2 * J.n_faces);
  for (int f = 0; f < J.n_faces; ++f) {
    const Vec3 d = (mesh.point(T.faces(f, 1)) - mesh.point(T.faces(f, 0))).normalized();
    Y[2 * f] = d.x();  // the frame's real axis runs along d
    Y[2 * f + 1] = -d.y();
  }
  EXPECT_LT(edge_curl(J, Y).cwiseAbs().maxCoeff(), 1e-9);
  const DiscontinuousField field =
      integrate_discontinuous(J, T.faces.matrix(), Y, {}, 1, 0, {}, report);
  EXPECT_LT(field.objective, 1e-9);
  const double shift = field.phi(0, 0) * T.unit - mesh.point(T.faces(0, 0)).x();
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(T.unit * field.phi(f, k) - shift, mesh.point(T.faces(f, k)).x(), 1e-9);
}

TEST(DiscontinuousDistance, AgreesWithTheContinuousOneWhereACurveBounds) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  Sources sources;
  MatX3 ring(61, 3);
  for (int i = 0; i <= 60; ++i) {
    const double a = 2 * std::acos(-1.0) * (i % 60) / 60;
    ring.row(i) << 0.8 * std::cos(a), 0.8 * std::sin(a), 0.6;
  }
  sources.space_curves.push_back({ring, true, "ring"});
  const VecX plain = distance(mesh, sources, {}).values;
  const SurfaceAnswer torn = distance(mesh, sources, {.discontinuous = true});
  EXPECT_LT((plain - torn.values).cwiseAbs().maxCoeff(), 0.2);  // two edge lengths, at the pole
  EXPECT_LT((plain - torn.values).cwiseAbs().mean(), 0.03);
  EXPECT_EQ(torn.shown->scalars.at("distance").size(), torn.shown->n_vertices());
}

TEST(DiscontinuousDistance, ALoopThatBoundsNothingGetsDistanceToBothSides) {
  // Round the tube of a thin torus: distance grows all the way round and jumps opposite the loop.
  constexpr int nu = 60, nv = 10;
  const double R = 1, r = 0.1;
  const SurfaceMesh mesh(test::torus_soup(nu, nv, R, r));
  std::vector<int> loop;
  for (int j = 0; j <= nv; ++j) loop.push_back(j % nv);
  const SurfaceAnswer torn =
      distance(mesh, vertex_loop(loop), {.time_scale = 16, .discontinuous = true});
  const VecX& phi = torn.shown->scalars.at("distance");
  // |grad phi| is 1 nearly everywhere: values run from - to + half the way round.
  const double half = std::acos(-1.0) * R;
  EXPECT_NEAR(phi.maxCoeff(), half, 0.15 * half);
  EXPECT_NEAR(phi.minCoeff(), -half, 0.15 * half);
  EXPECT_GT(torn.shown->n_vertices(), mesh.n_vertices());
  // Without jumps, the field has to be flattened: far from what distance is.
  const VecX plain = distance(mesh, vertex_loop(loop), {.time_scale = 16}).values;
  EXPECT_LT(plain.maxCoeff(), 0.75 * half);
  // Few vertices are torn: one ring of the tube, more or less.
  EXPECT_LT(torn.shown->n_vertices() - mesh.n_vertices(), 3 * nv);
}

TEST(DiscontinuousDistance, OneConstantForAllPagesOfABook) {
  // From the middle line of one page: 1/2 at the spine, seen from every page, and more beyond.
  constexpr int n = 10;
  const SurfaceMesh mesh(test::book_soup(3, n, 2 * std::acos(-1.0) / 3));
  std::vector<int> line;
  for (int j = 0; j <= n; ++j) line.push_back((n + 1) * (n / 2) + j);
  for (const double smoothing : {0.0, 1.0}) {
    const SurfaceAnswer torn =
        distance(mesh, vertex_loop(line),
                 {.constraint = Constraint::none, .discontinuous = true, .smoothing = smoothing});
    const VecX& phi = torn.shown->scalars.at("distance");
    for (int v = 0; v < torn.shown->n_vertices(); ++v) {
      const Vec3 x = torn.shown->points.row(v);
      const double from_spine = std::hypot(x.x(), x.y());
      const bool on_first = std::abs(x.y()) < 1e-9 && x.x() > -1e-9;
      EXPECT_NEAR(std::abs(phi[v]), on_first ? std::abs(from_spine - 0.5) : 0.5 + from_spine, 0.03)
          << x.transpose();
    }
  }
}

TEST(DiscontinuousDistance, GoesOnBeyondAPinch) {
  // Two squares that share a corner: from a side of one across it, through the corner, on.
  constexpr int n = 8;
  PolygonSoup soup = test::jittered_grid_soup(n, n, 0);
  const int before = soup.n_vertices();
  const PolygonSoup other = soup;
  soup.points.conservativeResize(2 * before - 1, 3);
  const int shared = before - 1;  // at (1, 1)
  for (int v = 1; v < before; ++v)
    soup.points.row(before - 1 + v) = other.points.row(v) + soup.points.row(shared);
  for (int f = 0; f < other.n_faces(); ++f) {
    const auto c = other.face(f);
    const auto at = [&](int v) { return v == 0 ? shared : before - 1 + v; };
    test::add_triangle(soup, at(c[0]), at(c[1]), at(c[2]));
  }
  const SurfaceMesh mesh(soup);
  std::vector<int> line;
  for (int v = 0; v < before; ++v)
    if (soup.points(v, 0) == 0) line.push_back(v);
  ASSERT_EQ(line.size(), n + 1U);
  const Vec3 along = mesh.point(line[1]) - mesh.point(line[0]);
  if (along.y() > 0) std::reverse(line.begin(), line.end());  // left is where x grows
  const SurfaceAnswer torn = distance(mesh, vertex_loop(line), {.discontinuous = true});
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const Vec3 x = mesh.point(v);
    const double exact = v < before ? x.x() : 1 + std::hypot(x.x() - 1, x.y() - 1);
    // Heat bends along the sides of the corner.
    if (v < before || std::min(x.x(), x.y()) > 1.3) {
      EXPECT_NEAR(torn.values[v], exact, 0.1) << x.transpose();
    }
  }
}

TEST(DiscontinuousDistance, JumpsAtAPinchRatherThanAcrossEdges) {
  // A handle of narrow squares from the first edge of a side of a square to a corner across it. On
  // it the distance to that side is negative, in the square positive: they meet at the corner.
  constexpr int n = 8, m = 16;
  PolygonSoup soup = test::jittered_grid_soup(n, n, 0);
  const int before = soup.n_vertices();
  const auto vertex_at = [&](double x, double y) {
    for (int v = 0; v < before; ++v)
      if (soup.points(v, 0) == x && soup.points(v, 1) == y) return v;
    return -1;
  };
  std::vector<std::array<int, 2>> rungs{{vertex_at(0, 0), vertex_at(0, 1. / n)}};
  std::vector<double> along{0};
  soup.points.conservativeResize(before + 2 * m - 1, 3);
  Vec3 last = Vec3::Zero();
  for (int i = 1, v = before; i <= m; ++i) {
    const double angle = M_PI * i / m;
    const Vec3 x(0.5 - 0.5 * std::cos(angle), 0, 0.5 * std::sin(angle));
    along.push_back(along.back() + (x - last).norm());
    last = x;
    rungs.push_back({i < m ? v++ : vertex_at(1, 0), v});
    soup.points.row(rungs[i][0]) = x;
    soup.points.row(v++) = x + Vec3(0, i < 4 ? 1. / n : 0.5 / n, 0);
  }
  soup.points.row(rungs[m][0]) << 1, 0, 0;
  for (int i = 0; i < m; ++i) {
    test::add_triangle(soup, rungs[i][0], rungs[i][1], rungs[i + 1][1]);
    test::add_triangle(soup, rungs[i][0], rungs[i + 1][1], rungs[i + 1][0]);
  }
  std::vector<int> line;
  for (int j = n; j >= 0; --j) line.push_back(vertex_at(0, static_cast<double>(j) / n));
  const SurfaceMesh mesh(soup);
  const SurfaceAnswer torn = distance(mesh, vertex_loop(line), {.discontinuous = true});
  for (int v = 0; v < before; ++v)
    if (v != rungs[m][0]) {
      EXPECT_NEAR(torn.values[v], mesh.point(v).x(), 0.1);
    }
  for (int i = 1; i < m; ++i)
    for (const int v : rungs[i]) EXPECT_NEAR(torn.values[v], -along[i], 0.1) << i;
}

TEST(DiscontinuousDistance, FewerJumpsWhereTheFieldDoesNotIntegrate) {
  // Two strips of squares that slide along their common line, one up and one down: the jump is
  // there whatever it costs. Of the edges beside, those that cost less by eq. 16 take it.
  constexpr int n = 8;
  const SurfaceMesh mesh(test::jittered_grid_soup(n, n, 0));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const JumpCalculus J = jump_calculus(T);
  VecX Y(2 * J.n_faces);
  for (int f = 0; f < J.n_faces; ++f) {
    const Vec3 middle =
        (mesh.point(T.faces(f, 0)) + mesh.point(T.faces(f, 1)) + mesh.point(T.faces(f, 2))) / 3;
    const Vec3 d = (mesh.point(T.faces(f, 1)) - mesh.point(T.faces(f, 0))).normalized();
    const double y = middle.x() < 0.5 ? 1 : -1;
    Y[2 * f] = y * d.y();  // <(0, y), d>, and <(0, y), d turned left>
    Y[2 * f + 1] = y * d.x();
  }
  const VecX curl = edge_curl(J, Y);
  const DiscontinuousField field =
      integrate_discontinuous(J, T.faces.matrix(), Y, {}, 1, 0, {}, report);
  double total = 0;
  for (int e = 0; e < J.n_edges; ++e) {
    const double x0 = mesh.point(T.edges(e, 0)).x(), x1 = mesh.point(T.edges(e, 1)).x();
    const bool between = J.interior(e) && x0 == 0.5 && x1 == 0.5;
    EXPECT_NEAR(curl[e], between ? 2 : 0, 1e-12);
    if (!between) {
      EXPECT_NEAR(field.jump[e], 0, 1e-9);
    }
    total += J.length[e] * std::exp(-curl[e]) * std::abs(field.jump[e]);
  }
  // |phi_left - phi_right| = |2 y - c|, least in the sum for c = 1: the mean of |2 y - 1| over the
  // middles of n edges is 1/2, of length 1 in all.
  EXPECT_NEAR(total, std::exp(-2.0) * 0.5 / T.unit / T.unit, 1e-9);
  EXPECT_NEAR(field.objective, total, 1e-9);
}

TEST(DiscontinuousDistance, ConstraintAndPenaltyApplyOrAreRefused) {
  // One straight line in a square and a shorter one beside it, turned the other way: without
  // constraint only the mean along both is 0.
  const SurfaceMesh mesh(test::jittered_grid_soup(20, 20, 0.2));
  Sources sources;
  MatX3 one(2, 3), two(2, 3);
  one << 0.3, 0.02, 0, 0.3, 0.98, 0;
  two << 0.6, 0.05, 0, 0.6, 0.6, 0;
  sources.space_curves = {{one, true, ""}, {two, true, ""}};
  const auto largest = [&](const SignedHeat& options) {
    const VecX phi = distance(mesh, sources, options).values;
    double most = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const Vec3 x = mesh.point(v);
      if (std::abs(x.x() - 0.3) < 0.03 || (std::abs(x.x() - 0.6) < 0.03 && x.y() < 0.6))
        most = std::max(most, std::abs(phi[v]));
    }
    return most;
  };
  const double free = largest({.constraint = Constraint::none, .discontinuous = true});
  const double held = largest({.discontinuous = true});
  const double weak = largest({.soft = 1e-6, .discontinuous = true});
  EXPECT_GT(free, 0.1);
  EXPECT_LT(held, 0.05);
  EXPECT_GT(weak, 0.1);
  EXPECT_THROW(largest({.constraint = Constraint::level_sets, .discontinuous = true}),
               UnsupportedError);
}

TEST(DiscontinuousDistance, IsZeroAtSourcesAtVertices) {
  // Smoothing moves values beside them, not there.
  const SurfaceMesh mesh(test::octasphere_soup(3));
  Sources points;
  points.points = {SurfacePoint::at_vertex(17), SurfacePoint::at_vertex(200)};
  std::map<double, int> equator;  // by angle
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (std::abs(mesh.point(v).z()) < 1e-12)
      equator[std::atan2(mesh.point(v).y(), mesh.point(v).x())] = v;
  std::vector<int> ring;
  for (const auto& [angle, v] : equator) ring.push_back(v);
  ring.push_back(ring.front());
  const SignedHeat smoothed{.discontinuous = true, .smoothing = 4};
  const VecX from_points = distance(mesh, points, smoothed).values;
  for (const int v : {17, 200}) EXPECT_EQ(from_points[v], 0) << v;
  const VecX from_ring = distance(mesh, vertex_loop(ring), smoothed).values;
  for (const int v : ring) EXPECT_EQ(from_ring[v], 0) << v;
  EXPECT_GT(std::min(from_points.maxCoeff(), from_ring.maxCoeff()), 1);
}

/// Values of the split surface by the face and corner they belong to.
double torn_value(const SurfaceAnswer& torn, int face, int k) {
  return torn.shown->scalars.at("distance")[torn.shown->face(face)[k]];
}

TEST(DiscontinuousDistance, TheCoreOfAMoebiusBand) {
  // Figures 13 and 14: a curve without two sides on a surface without orientation. Beside it the
  // distance is that across the band; where its sides come back exchanged the distance jumps from
  // -d to d, along one line across the band.
  constexpr int nu = 60, nw = 8;
  constexpr double half_width = 0.16;
  PolygonSoup soup;
  soup.points.resize(nu * (nw + 1), 3);
  const auto across = [&](int j) { return half_width * (2.0 * j / nw - 1); };
  const auto vertex = [&](int i, int j) {
    return i < nu ? i * (nw + 1) + j : (i - nu) * (nw + 1) + nw - j;
  };
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j <= nw; ++j) {
      const double u = 2 * std::acos(-1.0) * i / nu, s = 1 + across(j) * std::cos(u / 2);
      soup.points.row(vertex(i, j)) << s * std::cos(u), s * std::sin(u),
          across(j) * std::sin(u / 2);
    }
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nw; ++j) {
      test::add_triangle(soup, vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
      test::add_triangle(soup, vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  const SurfaceMesh mesh(soup);
  std::vector<int> core;
  for (int i = 0; i <= nu; ++i) core.push_back(vertex(i, nw / 2));
  Report report;
  const SurfaceAnswer torn = test::surface_answer(
      mesh, vertex_loop(core), SignedHeat{.discontinuous = true, .jump_threshold = 0.5}, report);
  double error = 0;
  for (int f = 0; f < mesh.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int j = mesh.face(f)[k] % (nw + 1);
      const double phi = torn_value(torn, f, k), exact = std::abs(across(j));
      error += std::abs(std::abs(phi) - exact) / (3 * mesh.n_faces());
    }
  EXPECT_LT(error, 0.1 * half_width);
  double jumps = 0;
  for (const auto& [name, value] : report.sizes)
    if (name == "jump_length") jumps = value;
  EXPECT_GT(jumps, 0.5 * half_width);
  EXPECT_LT(jumps, 4 * half_width);
}

TEST(DiscontinuousDistance, InconsistentPartsOfOneCurve) {
  // Figure 14, bottom: a circle in the plane, one half drawn the other way. Each side of each half
  // keeps its sign and distance near it, which no continuous function can.
  constexpr int n = 40;
  const SurfaceMesh mesh(test::jittered_grid_soup(n, n, 0.2));
  Sources sources;
  for (const int half : {0, 1}) {
    MatX3 arc(31, 3);
    for (int i = 0; i <= 30; ++i) {
      const double a = std::acos(-1.0) * (half ? 2 - i / 30.0 : i / 30.0);
      arc.row(i) << 0.5 + 0.25 * std::cos(a), 0.5 + 0.25 * std::sin(a), 0;
    }
    sources.space_curves.push_back({arc, true, ""});
  }
  const SurfaceAnswer torn = distance(mesh, sources, {.discontinuous = true});
  double error = 0;
  int count = 0;
  for (int f = 0; f < mesh.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) {
      const Vec3 x = mesh.point(mesh.face(f)[k]) - Vec3(0.5, 0.5, 0);
      const double exact = (0.25 - x.norm()) * (x.y() > 0 ? 1 : -1);
      if (std::abs(x.y()) < 0.1 || std::abs(exact) > 0.2) continue;
      error += std::abs(torn_value(torn, f, k) - exact);
      ++count;
    }
  EXPECT_LT(error / count, 0.02);
}

TEST(DiscontinuousDistance, LeavesOutWhatBoundsNothing) {
  constexpr int nu = 24, nv = 16;
  const SurfaceMesh mesh(test::torus_soup(nu, nv));
  std::vector<int> tube, disk;
  for (int j = 0; j <= nv; ++j) tube.push_back(3 * nv + j % nv);
  for (int i = 8; i < 14; ++i) disk.push_back(i * nv + 2);
  for (int j = 2; j < 8; ++j) disk.push_back(14 * nv + j);
  for (int i = 14; i > 8; --i) disk.push_back(i * nv + 8);
  for (int j = 8; j >= 2; --j) disk.push_back(8 * nv + j);
  Sources both = vertex_loop(tube);
  both.curves.push_back(vertex_loop(disk).curves[0]);
  const VecX filtered = distance(mesh, both, {.bounding_only = true}).values;
  const VecX alone = distance(mesh, vertex_loop(disk), {}).values;
  EXPECT_LT((filtered - alone).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_THROW(distance(mesh, vertex_loop(tube), {.bounding_only = true}), InputError);
}

}  // namespace
}  // namespace littoral
