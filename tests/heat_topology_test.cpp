// Surfaces of other shapes than a disk or a sphere, and curves that cross faces.

#include <gtest/gtest.h>

#include "heat_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

const double turn = 2 * std::acos(-1.0);

Curve curve_at(const std::vector<int>& vertices, bool is_signed = true) {
  Curve curve;
  for (int v : vertices) curve.nodes.push_back(SurfacePoint::at_vertex(v));
  curve.is_signed = is_signed;
  return curve;
}

SignedHeat with(Constraint constraint) { return {1, constraint}; }

TEST(HeatTopology, TwoParallelLoopsBoundABandOnATorus) {
  // Loops the long way round, outside (v = 0) and inside (v = pi): distance is r times the smaller
  // angle, positive in the band v < pi that lies to the left of both. Neither bounds alone.
  const int nu = 96, nv = 40;
  const double r = 0.4;
  const SurfaceMesh mesh(test::torus_soup(nu, nv, 1, r));
  std::vector<int> outer, inner;
  for (int i = 0; i <= nu; ++i) {
    outer.push_back(i % nu * nv);
    inner.push_back((nu - i) % nu * nv + nv / 2);
  }
  Sources sources;
  sources.curves = {curve_at(outer), curve_at(inner)};
  for (Constraint constraint : {Constraint::none, Constraint::zero_set, Constraint::level_sets}) {
    Report report;
    const VecX phi = test::signed_heat(mesh, sources, with(constraint), report);
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const double angle = turn * (v % nv) / nv, off = std::min(angle, turn - angle);
      const double exact = r * std::min(off, turn / 2 - off) * (angle < turn / 2 ? 1 : -1);
      ASSERT_NEAR(phi[v], exact, 0.035) << "constraint " << static_cast<int>(constraint);
    }
  }
}

TEST(HeatTopology, TwoMeridiansBoundHalfATorus) {
  // The exact distance is not elementary; symmetry and sign are known.
  const int nu = 64, nv = 24;
  const SurfaceMesh mesh(test::torus_soup(nu, nv));
  std::vector<int> near, far;
  for (int j = 0; j <= nv; ++j) {
    near.push_back((nv - j) % nv);        // at u = 0, left is towards growing u
    far.push_back(nu / 2 * nv + j % nv);  // at u = pi, left is towards falling u
  }
  Sources sources;
  sources.curves = {curve_at(near), curve_at(far)};
  Report report;
  const VecX phi = test::signed_heat(mesh, sources, with(Constraint::zero_set), report);
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const double value = phi[i * nv + j];
      if (i % (nu / 2) == 0) {
        EXPECT_NEAR(value, 0, 1e-8);
        continue;
      }
      EXPECT_GT(value * (i < nu / 2 ? 1 : -1), 0) << i << " " << j;
      EXPECT_NEAR(value, phi[(nu + nu / 2 - i) % nu * nv + j], 0.03);
      // No path is shorter than along the inner equator, none longer than along the outer.
      const double angle = turn * std::min(i % (nu / 2), nu / 2 - i % (nu / 2)) / nu;
      EXPECT_GT(std::abs(value), 0.85 * 0.6 * angle);
      EXPECT_LT(std::abs(value), 1.1 * 1.4 * angle + 0.02);
    }
}

TEST(HeatTopology, OpenCurveOnAMoebiusBand) {
  // Along a third of the core: beside it distance is the way across the band, with opposite signs
  // on the two sides although the band has one side only.
  const int nu = 120, nw = 8;
  const double half_width = 0.16;
  PolygonSoup soup;
  soup.points.resize(nu * (nw + 1), 3);
  auto across = [&](int j) { return half_width * (2.0 * j / nw - 1); };
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j <= nw; ++j) {
      const double u = turn * i / nu, s = 1 + across(j) * std::cos(u / 2);
      soup.points.row(i * (nw + 1) + j) << s * std::cos(u), s * std::sin(u),
          across(j) * std::sin(u / 2);
    }
  auto vertex = [&](int i, int j) { return i < nu ? i * (nw + 1) + j : nw - j; };
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nw; ++j) {
      test::add_triangle(soup, vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
      test::add_triangle(soup, vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  const SurfaceMesh mesh(soup);
  std::vector<int> core;
  for (int i = 20; i <= 60; ++i) core.push_back(vertex(i, nw / 2));
  Sources sources;
  sources.curves = {curve_at(core)};
  Report report;
  const VecX phi = test::signed_heat(mesh, sources, with(Constraint::zero_set), report);
  ASSERT_TRUE(phi.allFinite());
  for (int i = 26; i <= 54; ++i)
    for (int j = 0; j <= nw; ++j) EXPECT_NEAR(phi[vertex(i, j)], across(j), 0.02) << i << " " << j;
}

/// A unit cube of n x n squares a side, its least corner at `at`; equal positions share a vertex.
void add_cube(PolygonSoup& soup, std::vector<Vec3>& points, int n, const Vec3& at) {
  std::map<std::array<long, 3>, int> known;
  auto key = [&](const Vec3& p) {
    return std::array<long, 3>{std::lround(p.x() * n), std::lround(p.y() * n),
                               std::lround(p.z() * n)};
  };
  for (std::size_t v = 0; v < points.size(); ++v) known[key(points[v])] = static_cast<int>(v);
  auto id = [&](const Vec3& p) {
    const auto [it, added] = known.try_emplace(key(p), static_cast<int>(points.size()));
    if (added) points.push_back(p);
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          auto corner = [&](int a, int b) {
            Vec3 p = at;
            p[axis] += side;
            p[(axis + 1) % 3] += double(i + a) / n;
            p[(axis + 2) % 3] += double(j + b) / n;
            return id(p);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          test::add_triangle(soup, a, side ? b : d, c);
          test::add_triangle(soup, a, c, side ? d : b);
        }
}

SurfaceMesh two_cubes(int n, const Vec3& second) {
  PolygonSoup soup;
  std::vector<Vec3> points;
  add_cube(soup, points, n, Vec3(0, 0, 0));
  add_cube(soup, points, n, second);
  soup.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v)
    soup.points.row(static_cast<Eigen::Index>(v)) = points[v];
  return SurfaceMesh(soup);
}

int vertex_at(const SurfaceMesh& mesh, const Vec3& p) {
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if ((mesh.point(v) - p).norm() < 1e-9) return v;
  return -1;
}

TEST(HeatTopology, TwoCubesThatShareAVertex) {
  const SurfaceMesh mesh = two_cubes(10, Vec3(1, 1, 1));
  const Vec3 shared(1, 1, 1);
  const Sources sources = test::vertex_points({vertex_at(mesh, shared)});
  Report report;
  for (const VecX& u :
       {test::unsigned_heat(mesh, sources, report), test::signed_heat(mesh, sources, {}, report)})
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const Vec3 p = mesh.point(v) - shared;
      if (p.cwiseAbs().minCoeff() > 1e-9) {  // not on one of the six squares at the vertex
        EXPECT_GT(u[v], 1);
      } else {
        EXPECT_NEAR(u[v], p.norm(), 0.08) << p.transpose();
      }
    }
}

TEST(HeatTopology, TwoCubesThatShareAnEdge) {
  const int n = 10;
  const SurfaceMesh mesh = two_cubes(n, Vec3(1, 1, 0));
  std::vector<int> edge;
  for (int k = 0; k <= n; ++k) edge.push_back(vertex_at(mesh, Vec3(1, 1, double(k) / n)));
  Sources sources;
  sources.curves = {curve_at(edge, false)};
  Report report;
  for (const VecX& u : {test::unsigned_heat(mesh, sources, report),
                        test::signed_heat(mesh, sources, with(Constraint::zero_set), report)})
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const Vec3 p = mesh.point(v) - Vec3(1, 1, 0);
      ASSERT_TRUE(std::isfinite(u[v]));
      if (std::min(std::abs(p.x()), std::abs(p.y())) < 1e-9) {  // on the four squares at the edge
        EXPECT_NEAR(u[v], std::hypot(p.x(), p.y()), 0.1) << p.transpose();
      }
    }
}

TEST(HeatTopology, ACurveThroughFacesDoesNotPinTheirCorners) {
  // One condition per crossed edge would force a linear function on the crossed triangles to be
  // zero at all their corners.
  const int n = 30;
  const SurfaceMesh mesh(test::jittered_grid_soup(n, n, 0.3));
  MatX3 line(2, 3);
  line << 0.37, 0, 0, 0.61, 1, 0;
  const Vec3 along = Vec3(0.24, 1, 0).normalized(), left(-along.y(), along.x(), 0);
  auto exact = [&](const Vec3& p) { return (p - Vec3(0.37, 0, 0)).dot(left); };
  Report report;
  const auto sources = test::space_curve(line);
  const VecX none = test::signed_heat(mesh, sources, with(Constraint::none), report);
  const VecX zero = test::signed_heat(mesh, sources, with(Constraint::zero_set), report);
  double error_none = 0, error_zero = 0, value = 0, expected = 0;
  for (int f = 0; f < mesh.n_faces(); ++f) {
    double d[3], low = 1, high = -1;
    for (int k = 0; k < 3; ++k) {
      d[k] = exact(mesh.point(mesh.face(f)[k]));
      low = std::min(low, d[k]), high = std::max(high, d[k]);
    }
    if (low * high >= 0) continue;  // not crossed
    for (int k = 0; k < 3; ++k) {
      value += std::abs(zero[mesh.face(f)[k]]);
      expected += std::abs(d[k]);
    }
  }
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    error_none += std::abs(none[v] - exact(mesh.point(v))) / mesh.n_vertices();
    error_zero += std::abs(zero[v] - exact(mesh.point(v))) / mesh.n_vertices();
  }
  EXPECT_NEAR(value / expected, 1, 0.1);
  EXPECT_LT(error_zero, 1.5 * error_none + 1e-4);
  EXPECT_LT(error_zero, 0.1 / n);
}

}  // namespace
}  // namespace littoral
