// Exact polyhedral distance against closed forms and an exhaustive search.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numbers>
#include <random>
#include <vector>

#include "base/parallel.h"
#include "geodesic_helpers.h"
#include "io/read.h"
#include "littoral/error.h"
#include "shared_data.h"
#include "test_meshes.h"

namespace littoral {
namespace {

Sources from(std::vector<SurfacePoint> points) {
  Sources sources;
  sources.points = std::move(points);
  return sources;
}

void expect_euclidean(const SurfaceMesh& mesh, const Sources& sources,
                      const std::vector<Vec3>& at) {
  const VecX d = test::exact(mesh, sources);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    double expected = 1e300;
    for (const Vec3& p : at) expected = std::min(expected, (mesh.point(v) - p).norm());
    EXPECT_NEAR(d[v], expected, 1e-12) << "vertex " << v;
  }
}

TEST(ExactPolyhedral, PlaneFromVerticesEdgesFacesAndSeveral) {
  for (const auto& soup : {test::grid_soup(13, 11), test::jittered_grid_soup(12, 9, 0.3)}) {
    const SurfaceMesh mesh(soup);
    const SurfacePoint corner = SurfacePoint::at_vertex(0), inner = SurfacePoint::at_vertex(40);
    const SurfacePoint edge = SurfacePoint::on_edge(77, 0.3);
    const SurfacePoint face = SurfacePoint::in_face(50, 0.2, 0.5, 0.3);
    for (const SurfacePoint& p : {corner, inner, edge, face})
      expect_euclidean(mesh, from({p}), {mesh.position(p)});
    expect_euclidean(mesh, from({corner, edge, face}),
                     {mesh.position(corner), mesh.position(edge), mesh.position(face)});
  }
}

/// What the vertices of a flat place divide is one again behind them: the number of windows of a
/// triangle does not grow with the mesh, and the answer is the same.
TEST(ExactPolyhedral, RaysDividedOnAFlatPlaceComeTogether) {
  for (const int n : {20, 80}) {
    const SurfaceMesh mesh(test::jittered_grid_soup(n, n, 0.3));
    MatX3 line(2, 3);
    line << 0.21, 0.33, 0, 0.52, 0.61, 0;
    const Vec3 a = line.row(0), ab = Vec3(line.row(1)) - a;
    for (const bool curve : {false, true}) {
      Report report;
      const VecX d = test::geodesic(test::exact_once, mesh,
                                    curve ? test::space_curve(line, false)
                                          : from({SurfacePoint::in_face(77, 0.2, 0.5, 0.3)}),
                                    report)
                         .distance;
      EXPECT_LT(report.iterations.front().second, 8 * mesh.n_faces()) << n << " " << curve;
      const Vec3 from_point = mesh.position(SurfacePoint::in_face(77, 0.2, 0.5, 0.3));
      for (int v = 0; v < mesh.n_vertices(); ++v) {
        const Vec3 p = mesh.point(v);
        const double x = std::clamp(ab.dot(p - a) / ab.squaredNorm(), 0.0, 1.0);
        const double expected = curve ? (p - a - x * ab).norm() : (p - from_point).norm();
        EXPECT_NEAR(d[v], expected, curve ? 1e-9 : 1e-12) << n << " " << curve << " " << v;
      }
    }
  }
}

/// So many sources that more goes on at the same time than is left to one thread.
TEST(ExactPolyhedral, SameBitsForAnyThreadCount) {
  const SurfaceMesh mesh(test::jittered_grid_soup(200, 200, 0.3));
  std::mt19937 random(5);
  Sources sources;
  for (int i = 0; i < 5000; ++i)
    sources.points.push_back(
        SurfacePoint::at_vertex(static_cast<int>(random() % std::size_t(mesh.n_vertices()))));
  set_thread_count(1);
  const VecX one = test::exact(mesh, sources);
  set_thread_count(3);
  const VecX three = test::exact(mesh, sources);
  set_thread_count(0);
  EXPECT_EQ(one, three);
}

TEST(ExactPolyhedral, PlaneFromBrokenLine) {
  const SurfaceMesh mesh(test::jittered_grid_soup(15, 15, 0.3));
  MatX3 line(3, 3);
  line << 0.21, 0.33, 0, 0.52, 0.61, 0, 0.83, 0.37, 0;
  for (const bool is_signed : {false, true}) {
    const VecX d = test::exact(mesh, test::space_curve(line, is_signed));
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      double expected = 1e300;
      for (int i = 0; i < 2; ++i) {
        const Vec3 a = line.row(i), ab = line.row(i + 1).transpose() - a, p = mesh.point(v);
        const double x = std::clamp(ab.dot(p - a) / ab.squaredNorm(), 0.0, 1.0);
        expected = std::min(expected, (p - a - x * ab).norm());
      }
      EXPECT_NEAR(d[v], expected, 1e-9) << "vertex " << v;
    }
  }
}

/// Rings of n points at radius j / rings around an apex; every wedge spans `angle`.
SurfaceMesh cone(int n, int rings, double angle) {
  PolygonSoup soup;
  soup.points = MatX3::Zero(1 + n * rings, 3);
  const double total = n * angle, flat = 2 * std::numbers::pi;
  for (int i = 0; i < n; ++i) {
    Vec3 spoke;
    if (total < flat) {  // radius s and height c with the right angle between neighbouring spokes
      const double s = std::sin(angle / 2) / std::sin(std::numbers::pi / n);
      spoke << s * std::cos(i * flat / n), s * std::sin(i * flat / n), -std::sqrt(1 - s * s);
    } else {  // alternating up and down: cos(angle) = s^2 cos(2 pi / n) - (1 - s^2)
      const double s = std::sqrt((std::cos(angle) + 1) / (std::cos(flat / n) + 1));
      spoke << s * std::cos(i * flat / n), s * std::sin(i * flat / n),
          (i % 2 ? 1 : -1) * std::sqrt(1 - s * s);
    }
    for (int j = 0; j < rings; ++j) soup.points.row(1 + j * n + i) = spoke * (j + 1.0) / rings;
  }
  for (int i = 0; i < n; ++i) {
    const int k = (i + 1) % n;
    test::add_triangle(soup, 0, 1 + i, 1 + k);
    for (int j = 1; j < rings; ++j) {
      test::add_triangle(soup, 1 + (j - 1) * n + i, 1 + j * n + i, 1 + j * n + k);
      test::add_triangle(soup, 1 + (j - 1) * n + i, 1 + j * n + k, 1 + (j - 1) * n + k);
    }
  }
  return SurfaceMesh(soup);
}

TEST(ExactPolyhedral, ConesBelowAndAboveAFullTurn) {
  const int n = 12, rings = 5;
  for (const double angle : {0.3, 0.5, 0.6, 0.9}) {
    const SurfaceMesh mesh = cone(n, rings, angle);
    for (int j = 0; j < rings; ++j) {
      const VecX d = test::exact(mesh, from({SurfacePoint::at_vertex(1 + j * n)}));
      for (int i = 0; i < n; ++i)
        for (int l = 0; l < rings; ++l) {
          const double a = (j + 1.0) / rings, b = (l + 1.0) / rings;
          const double turn = std::min(i, n - i) * angle;
          const double expected = turn < std::numbers::pi
                                      ? std::sqrt(a * a + b * b - 2 * a * b * std::cos(turn))
                                      : a + b;
          EXPECT_NEAR(d[1 + l * n + i], expected, 1e-12)
              << angle << " " << j << " " << i << " " << l;
        }
    }
  }
}

TEST(ExactPolyhedral, UnitCube) {
  PolygonSoup soup;
  soup.points.resize(8, 3);
  for (int v = 0; v < 8; ++v) soup.points.row(v) << (v & 1), (v >> 1 & 1), (v >> 2 & 1);
  for (const auto& q : std::vector<std::array<int, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    test::add_triangle(soup, q[0], q[1], q[2]);
    test::add_triangle(soup, q[0], q[2], q[3]);
  }
  const SurfaceMesh mesh(soup);
  const VecX d = test::exact(mesh, from({SurfacePoint::at_vertex(0)}));
  for (int v = 0; v < 8; ++v)
    EXPECT_NEAR(d[v], std::vector({0., 1., std::sqrt(2.), std::sqrt(5.)})[__builtin_popcount(v)],
                1e-13);
  // From the centre of the bottom (0 2 | 1 3): 1/2 up to each side of the top is 1 + 1/2 along the
  // axis; its corners are sqrt((1/2)^2 + (3/2)^2) away.
  const VecX c = test::exact(mesh, from({SurfacePoint::in_face(0, 0.5, 0, 0.5)}));
  for (int v = 0; v < 4; ++v) EXPECT_NEAR(c[v], std::sqrt(0.5), 1e-13);
  for (int v = 4; v < 8; ++v) EXPECT_NEAR(c[v], std::sqrt(2.5), 1e-13);
}

void expect_oracle(const SurfaceMesh& mesh) {
  const test::GeodesicOracle oracle(mesh);
  for (int a = 0; a < mesh.n_vertices(); ++a) {
    const VecX d = test::exact(mesh, from({SurfacePoint::at_vertex(a)}));
    for (int b = 0; b < mesh.n_vertices(); ++b)
      EXPECT_NEAR(d[b], oracle(a, b), 1e-9) << a << " " << b;
  }
}

TEST(ExactPolyhedral, NonmanifoldScrapsLikeExhaustiveSearch) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    expect_oracle(SurfaceMesh(test::scrap(seed, 12)));
  }
}

TEST(ExactPolyhedral, BumpySurfacesLikeExhaustiveSearch) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-0.25, 0.25);
    PolygonSoup bumpy = test::jittered_grid_soup(4, 4, 0.3, seed);
    for (int v = 0; v < bumpy.n_vertices(); ++v) bumpy.points(v, 2) = u(random);
    PolygonSoup ball = test::octasphere_soup(1);
    for (int v = 0; v < ball.n_vertices(); ++v) ball.points.row(v) *= 1 + 2 * u(random);
    expect_oracle(SurfaceMesh(bumpy));
    expect_oracle(SurfaceMesh(ball));
  }
}

TEST(ExactPolyhedral, SameWhateverTheUnitOrTheLabels) {
  PolygonSoup soup = test::torus_soup(16, 9);
  const VecX d = test::exact(SurfaceMesh(soup), from({SurfacePoint::at_vertex(5)}));
  for (const double scale : {1e-3, 1e3}) {
    PolygonSoup scaled = soup;
    scaled.points *= scale;
    const VecX s = test::exact(SurfaceMesh(scaled), from({SurfacePoint::at_vertex(5)}));
    EXPECT_LT((s / scale - d).cwiseAbs().maxCoeff(), 1e-12);
  }
  PolygonSoup renamed;
  const int n = soup.n_vertices();
  renamed.points.resize(n, 3);
  auto name = [n](int v) { return (v * 5 + 3) % n; };
  for (int v = 0; v < n; ++v) renamed.points.row(name(v)) = soup.points.row(v);
  for (int f = soup.n_faces() - 1; f >= 0; --f) {
    const auto c = soup.face(f);
    test::add_triangle(renamed, name(c[1]), name(c[0]), name(c[2]));
  }
  const VecX r = test::exact(SurfaceMesh(renamed), from({SurfacePoint::at_vertex(name(5))}));
  for (int v = 0; v < n; ++v) EXPECT_NEAR(r[name(v)], d[v], 1e-12);
}

TEST(ExactPolyhedral, WhatNoSourceReachesIsInfinite) {
  PolygonSoup soup = test::grid_soup(2, 2);
  soup.points.conservativeResize(13, 3);
  soup.points.bottomRows(4) << 5, 0, 0, 6, 0, 0, 5, 1, 0, 9, 9, 9;
  test::add_triangle(soup, 9, 10, 11);
  Report report;
  const VecX d = test::geodesic(test::exact_once, SurfaceMesh(soup),
                                from({SurfacePoint::at_vertex(0)}), report)
                     .distance;
  EXPECT_EQ(report.unreachable_components, std::vector<int>{1});
  for (int v = 0; v < 13; ++v) EXPECT_EQ(std::isinf(d[v]), v >= 9);
}

TEST(ExactPolyhedral, StopsWhenAsked) {
  const SurfaceMesh mesh(test::octasphere_soup(5));
  CancelToken token;
  const Task task(token, [&](double, const std::string&) { token.cancel(); });
  Report report;
  EXPECT_THROW(
      test::geodesic(test::exact_once, mesh, from({SurfacePoint::at_vertex(0)}), report, task),
      Cancelled);
}

TEST(ExactPolyhedral, ProgressIsTheShareOfVerticesThatAreReached) {
  const SurfaceMesh mesh(test::octasphere_soup(6));
  std::vector<double> told;
  const Task task({}, [&](double fraction, const std::string&) { told.push_back(fraction); });
  Report report;
  test::geodesic(test::exact_once, mesh, from({SurfacePoint::at_vertex(0)}), report, task);
  ASSERT_GT(told.size(), 10u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  // The front runs over the sphere from pole to pole and has the most windows halfway.
  EXPECT_LT(told.front(), 0.3);
  EXPECT_GT(told.back(), 0.9);
  EXPECT_LE(told.back(), 1);
  double widest = 0;
  for (std::size_t i = 1; i < told.size(); ++i) widest = std::max(widest, told[i] - told[i - 1]);
  EXPECT_LT(widest, 0.3);
}

TEST(ExactPolyhedral, ReferenceDistances) {
  for (const std::string name : {"bunny", "spot"}) {
    LITTORAL_NEEDS_SHARED("reference/geodesic/" + name);
    const auto folder = test::shared() / "reference/geodesic" / name;
    const SurfaceMesh mesh(io::read_surface(folder / "mesh.obj"));
    const VecX d = test::exact(mesh, from({SurfacePoint::at_vertex(0)}));
    const VecX m = test::marched(mesh, from({SurfacePoint::at_vertex(0)}));
    std::ifstream exact_file(folder / "exact.txt"), marched_file(folder / "fmm.txt");
    double worst = 0, worst_marched = 0, worst_theirs = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      double e = 0, f = 0;
      ASSERT_TRUE(exact_file >> e && marched_file >> f);
      worst = std::max(worst, std::abs(d[v] - e));
      worst_marched = std::max(worst_marched, std::abs(m[v] - e));
      worst_theirs = std::max(worst_theirs, std::abs(f - e));
    }
    EXPECT_LT(worst, 1e-9 * d.maxCoeff());  // the file has ten digits
    EXPECT_LT(worst_marched, worst_theirs);
  }
}

TEST(ExactPolyhedral, ACurveReachesAVertexThatLiesOnAnEdge) {
  // The vertex of a face without area, in the middle of a square's diagonal: the last step of the
  // curve there has no length, but leads from the edge to the vertex.
  PolygonSoup soup;
  soup.points.resize(5, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.5, 0;
  test::add_triangle(soup, 0, 1, 2);
  test::add_triangle(soup, 0, 2, 3);
  test::add_triangle(soup, 0, 2, 4);
  Sources sources;
  sources.curves.push_back({{SurfacePoint::at_vertex(1), SurfacePoint::at_vertex(4)}, false, ""});
  EXPECT_EQ(test::exact(SurfaceMesh(soup), sources)[4], 0);
}

}  // namespace
}  // namespace littoral
