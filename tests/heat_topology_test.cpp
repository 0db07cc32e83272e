// Surfaces of other shapes than a disk or a sphere, and curves that cross faces.

#include <gtest/gtest.h>

#include "heat_helpers.h"
#include "one_call.h"
#include "test_meshes.h"

namespace littoral {
namespace {

const double whole_turn = 2 * std::acos(-1.0);

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
      const double angle = whole_turn * (v % nv) / nv, off = std::min(angle, whole_turn - angle);
      const double exact =
          r * std::min(off, whole_turn / 2 - off) * (angle < whole_turn / 2 ? 1 : -1);
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
      const double angle = whole_turn * std::min(i % (nu / 2), nu / 2 - i % (nu / 2)) / nu;
      EXPECT_GT(std::abs(value), 0.85 * 0.6 * angle);
      EXPECT_LT(std::abs(value), 1.1 * 1.4 * angle + 0.02);
    }
}

/// A Moebius band of nu x nw squares about the unit circle, seam at the last of the nu.
struct MoebiusBand {
  int nu = 120, nw = 8;
  double half_width = 0.16;

  double across(int j) const { return half_width * (2.0 * j / nw - 1); }
  /// i counts twice round: on the second round the band is upside down.
  int vertex(int i, int j) const {
    const int round = i / nu % 2;
    return i % nu * (nw + 1) + (round == 0 ? j : nw - j);
  }
  PolygonSoup soup(bool polygons = false) const {
    PolygonSoup soup;
    soup.points.resize(nu * (nw + 1), 3);
    for (int i = 0; i < nu; ++i)
      for (int j = 0; j <= nw; ++j) {
        const double u = whole_turn * i / nu, s = 1 + across(j) * std::cos(u / 2);
        soup.points.row(i * (nw + 1) + j) << s * std::cos(u), s * std::sin(u),
            across(j) * std::sin(u / 2);
      }
    for (int i = 0; i < nu; ++i)
      for (int j = 0; j < nw; ++j) {
        const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                  d = vertex(i, j + 1);
        if (polygons) {
          soup.add_face(std::vector<int>{a, b, c, d});
        } else {
          test::add_triangle(soup, a, b, c);
          test::add_triangle(soup, a, c, d);
        }
      }
    return soup;
  }
  Curve curve(int from, int to, int j) const {
    std::vector<int> vertices;
    for (int i = from; i <= to; ++i) vertices.push_back(vertex(i, j));
    return curve_at(vertices);
  }
};

TEST(HeatTopology, OpenCurveOnAMoebiusBand) {
  // Along half of the core and across the seam: beside it distance is the way across the band, with
  // opposite signs on the two sides although the band has one side only.
  const MoebiusBand band;
  const SurfaceMesh mesh(band.soup());
  Sources sources;
  sources.curves = {band.curve(90, 150, band.nw / 2)};
  Report report;
  const VecX phi = test::signed_heat(mesh, sources, with(Constraint::zero_set), report);
  ASSERT_TRUE(phi.allFinite());
  for (int i = 96; i <= 144; ++i)
    for (int j = 0; j <= band.nw; ++j)
      EXPECT_NEAR(phi[band.vertex(i, j)], band.across(j), 0.02) << i << " " << j;
  EXPECT_EQ(report.warnings.size(), 1U);
}

TEST(HeatTopology, ACurveTwiceRoundAMoebiusBand) {
  // It divides the band into a narrower Moebius band and an annulus with the boundary, whose sign
  // is one and the same all round. Drawn at once, in parts of one edge each, and through faces.
  const MoebiusBand band{60};
  const SurfaceMesh mesh(band.soup());
  const int quarter = 3 * band.nw / 4;
  std::vector<Sources> all(3);
  all[0].curves = {band.curve(0, 2 * band.nu, quarter)};
  for (int i = 0; i < 2 * band.nu; ++i) all[1].curves.push_back(band.curve(i, i + 1, quarter));
  for (int i = 0; i <= 2 * band.nu; ++i)
    for (int side = 0; side < 2 && i + side <= 2 * band.nu; ++side) {
      // Half way between two rows, over every edge that goes across.
      const bool upside_down = i >= band.nu && i < 2 * band.nu;
      const int from = band.vertex(i, quarter - (upside_down ? 0 : 1));
      const int e = mesh.find_edge(
          side ? from : band.vertex(i, quarter - 1),
          side ? band.vertex(i + 1, quarter - (upside_down ? 1 : 0)) : band.vertex(i, quarter));
      if (i == 0 && side == 0) all[2].curves.emplace_back();
      all[2].curves[0].nodes.push_back(SurfacePoint::on_edge(e, 0.5));
    }
  for (std::size_t k = 0; k < all.size(); ++k)
    for (const AnyMethod& method :
         {AnyMethod(SignedHeat{}), AnyMethod(FastMarching{}), AnyMethod(Automatic{}),
          AnyMethod(SignedHeat{.intrinsic_delaunay = true}),
          AnyMethod(Quadratic{.is_signed = true})}) {
      Report report;
      const VecX phi = test::surface_distance(mesh, all[k], method, report);
      const double at = band.across(quarter) - (k == 2 ? band.half_width / band.nw : 0);
      for (int i = 0; i < band.nu; ++i)
        for (int j = 0; j <= band.nw; ++j) {
          const double expected = std::abs(band.across(j)) - at;
          ASSERT_NEAR(phi[band.vertex(i, j)], expected, 0.03)
              << "curve " << k << ", " << report.method << " at " << i << " " << j;
        }
    }
}

TEST(HeatTopology, ACurveTwiceRoundAMoebiusBandOfPolygons) {
  const MoebiusBand band{60};
  const SurfaceMesh mesh(band.soup(true));
  const int quarter = 3 * band.nw / 4;
  Sources sources;
  sources.curves = {band.curve(0, 2 * band.nu, quarter)};
  for (const AnyMethod& method : {AnyMethod(Automatic{}), AnyMethod(SignedHeat{})}) {
    Report report;
    const VecX phi = test::surface_distance(mesh, sources, method, report);
    for (int i = 0; i < band.nu; ++i)
      for (int j = 0; j <= band.nw; ++j)
        ASSERT_NEAR(phi[band.vertex(i, j)], std::abs(band.across(j)) - band.across(quarter), 0.03)
            << report.method << " at " << i << " " << j;
  }
  Sources core;
  core.curves = {band.curve(0, band.nu, band.nw / 2).unsigned_curve()};
  for (const char* method : {"unsigned-heat", "belyaev-fayolle", "signed-heat"}) {
    Report report;
    const VecX phi = test::surface_distance(mesh, core, AnyMethod::named(method), report);
    for (int i = 0; i < band.nu; ++i)
      for (int j = 0; j <= band.nw; ++j)
        ASSERT_NEAR(phi[band.vertex(i, j)], std::abs(band.across(j)), 0.03) << method;
  }
}

TEST(HeatTopology, ACurveAlongTheSeamOfAMoebiusBand) {
  // Straight across the band where the faces on both sides lie on the same side of their edge, and
  // elsewhere. It bounds nothing, so that the distance is flattened; its signs are as drawn.
  const MoebiusBand band{60};
  const SurfaceMesh mesh(band.soup());
  for (const int at : {0, 30})
    for (const bool reversed : {false, true})
      for (const AnyMethod& method : {AnyMethod(SignedHeat{}), AnyMethod(FastMarching{}),
                                      AnyMethod(SignedHeat{.intrinsic_delaunay = true}),
                                      AnyMethod(Quadratic{.is_signed = true})}) {
        Sources sources;
        Curve& curve = sources.curves.emplace_back();
        for (int j = 0; j <= band.nw; ++j)
          curve.nodes.push_back(SurfacePoint::at_vertex(band.vertex(at, j)));
        if (reversed) sources = sources.reversed();
        Report report;
        const VecX phi = test::surface_distance(mesh, sources, method, report);
        for (const int away : {2, 5, 9})
          for (int j = 0; j <= band.nw; ++j) {
            // Left of travel is where i falls, as the faces after either column say.
            const double least = 0.2 * whole_turn * away / band.nu, sign = reversed ? -1 : 1;
            EXPECT_LT(sign * phi[band.vertex(at + away, j)], -least)
                << report.method << " " << at << " " << j;
            EXPECT_GT(sign * phi[band.vertex(at + 2 * band.nu - away, j)], least)
                << report.method << " " << at << " " << j;
          }
      }
}

TEST(HeatTopology, RegionsOnAMoebiusBand) {
  const MoebiusBand band;
  const SurfaceMesh mesh(band.soup());
  Sources sources;
  sources.curves = {band.curve(0, 2 * band.nu, 3 * band.nw / 4)};
  for (const Formulation formulation : {Formulation::primal, Formulation::dual}) {
    Report report;
    const WindingAnswer answer = solve_once<WindingDomain>(
        SurfaceWinding{.formulation = formulation}, {domain_of(mesh).mesh}, sources, {}, report);
    EXPECT_TRUE(answer.nonbounding.empty());
    const int inner = answer.region[band.nw], outer = answer.region[0];  // of the first column
    EXPECT_EQ(std::abs(inner - outer), 1);
    for (int f = 0; f < mesh.n_faces(); ++f) {
      const int j = f / 2 % band.nw;
      EXPECT_EQ(answer.region[f], j < band.nw / 4 || j >= 3 * band.nw / 4 ? outer : inner) << f;
    }
  }
}

TEST(HeatTopology, TheCoreOfAMoebiusBandHasOneSide) {
  const MoebiusBand band;
  const SurfaceMesh mesh(band.soup());
  Sources sources;
  sources.curves = {band.curve(0, band.nu, band.nw / 2)};
  Report report;
  test::signed_heat(mesh, sources, {}, report);
  ASSERT_EQ(report.warnings.size(), 2U);
  EXPECT_NE(report.warnings[1].text.find("sides exchanged"), std::string::npos);
}

TEST(HeatTopology, SidesAreWarnedOfOnlyWhereTheyMatter) {
  const MoebiusBand band;
  const SurfaceMesh mesh(band.soup());
  Report report;
  test::signed_heat(mesh, test::vertex_points({7}), {}, report);
  EXPECT_TRUE(report.warnings.empty());
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
