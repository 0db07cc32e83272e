// Fast marching against exact distances.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "geodesic_helpers.h"
#include "littoral/error.h"
#include "one_call.h"
#include "report_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

double worst_error(const SurfaceMesh& mesh, const VecX& d,
                   const std::function<double(const Vec3&)>& expected) {
  double worst = 0;
  for (int v = 0; v < mesh.n_vertices(); ++v)
    worst = std::max(worst, std::abs(d[v] - expected(mesh.point(v))));
  return worst;
}

TEST(FastMarching, StraightFrontsAreExactAlsoThroughObtuseTriangles) {
  PolygonSoup soup = test::jittered_grid_soup(14, 14, 0.35, 3);
  for (int v = 0; v < soup.n_vertices(); ++v) soup.points(v, 0) *= 3;  // most corners are obtuse
  const SurfaceMesh mesh(soup);
  MatX3 line(2, 3);
  line << 0, 0, 0, 0, 1, 0;  // along the boundary x = 0
  const VecX d = test::marched(mesh, test::space_curve(line, false));
  // Only corners at the boundary lack a vertex in front; the front from the left never needs them
  // to be right inside.
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (mesh.point(v).y() > 0.25 && mesh.point(v).y() < 0.75 && mesh.point(v).x() < 0.7) {
      EXPECT_NEAR(d[v], mesh.point(v).x(), 2e-3) << v;
    }
}

TEST(FastMarching, SignedLineAndItsReverse) {
  const SurfaceMesh mesh(test::jittered_grid_soup(20, 20, 0.3));
  MatX3 line(2, 3);
  line << 0, 0.37, 0, 1, 0.37, 0;
  const VecX d = test::marched(mesh, test::space_curve(line));
  EXPECT_LT(worst_error(mesh, d, [](const Vec3& p) { return p.y() - 0.37; }), 1.5e-2);
  const VecX r = test::marched(mesh, test::space_curve(line.colwise().reverse()));
  EXPECT_LT((r + d).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(FastMarching, ThereAndBackHasNoSides) {
  for (const SurfaceMesh& mesh : {SurfaceMesh(test::jittered_grid_soup(20, 20, 0.3)),
                                  SurfaceMesh(test::grid_soup(20, 20))})  // along edges
    for (const double y : {0.37, 0.5}) {
      MatX3 line(2, 3), back(3, 3);
      line << 0, y, 0, 1, y, 0;
      back << 0, y, 0, 1, y, 0, 0, y, 0;
      const VecX d = test::marched(mesh, test::space_curve(back));
      const VecX unsigned_line = test::marched(mesh, test::space_curve(line, false));
      EXPECT_LT((d - unsigned_line).cwiseAbs().maxCoeff(), 1e-12) << y;
      // Once more and it has.
      back.conservativeResize(4, 3);
      back.row(3) = line.row(1);
      const VecX again = test::marched(mesh, test::space_curve(back));
      EXPECT_LT((again - test::marched(mesh, test::space_curve(line))).cwiseAbs().maxCoeff(),
                1e-12);
    }
}

TEST(FastMarching, SignsAroundACircleThroughFacesAndALoopOfEdges) {
  const SurfaceMesh mesh(test::jittered_grid_soup(30, 30, 0.3));
  const VecX d = test::marched(mesh, test::space_curve(test::circle(0.5, 0.5, 0, 0.3, 80)));
  EXPECT_LT(worst_error(mesh, d,
                        [](const Vec3& p) { return 0.3 - std::hypot(p.x() - 0.5, p.y() - 0.5); }),
            0.02);
  const SurfaceMesh sphere(test::octasphere_soup(4));
  MatX3 equator = test::circle(0, 0, 0, 1, 64);  // runs along edges
  const VecX s = test::marched(sphere, test::space_curve(equator));
  for (int v = 0; v < sphere.n_vertices(); ++v)
    if (std::abs(sphere.point(v).z()) > 1e-9) {
      EXPECT_GT(s[v] * sphere.point(v).z(), 0) << v;
    }
}

/// The loop of edges around faces within a radius of a point, to the left of it; none if there are
/// several or one goes through a vertex twice.
std::vector<int> loop_around(const SurfaceMesh& mesh, const std::vector<char>& inside) {
  std::map<int, int> after;
  int edges = 0;
  for (int f = 0; f < mesh.n_faces(); ++f)
    for (int k = 0; inside[f] && k < 3; ++k) {
      const auto& faces = mesh.edge_faces(mesh.side_edge(f, k));
      if (faces.size() != 2) return {};
      if (inside[faces[0]] && inside[faces[1]]) continue;
      after[mesh.face(f)[k]] = mesh.face(f)[(k + 1) % 3];
      ++edges;
    }
  if (after.empty() || static_cast<int>(after.size()) != edges) return {};
  std::vector<int> loop{after.begin()->first};
  do {
    loop.push_back(after.at(loop.back()));
  } while (loop.back() != loop.front());
  return static_cast<int>(loop.size()) == edges + 1 ? loop : std::vector<int>{};
}

TEST(FastMarching, LoopsOfEdgesAmongObtuseTrianglesHaveTheirRegionInside) {
  PolygonSoup soup = test::jittered_grid_soup(24, 24, 0.4, 5);
  for (int v = 0; v < soup.n_vertices(); ++v) soup.points(v, 0) *= 4;
  const SurfaceMesh mesh(soup);
  int loops = 0;
  for (int seed = 0; seed < 60; ++seed) {
    const Vec3 centre(1 + 2.0 * (seed % 10) / 9, 0.3 + 0.4 * (seed / 10) / 5, 0);
    const double radius = 0.12 + 0.002 * seed;
    std::vector<char> inside(mesh.n_faces(), 0), touched(mesh.n_vertices(), 0);
    for (int f = 0; f < mesh.n_faces(); ++f) {
      Vec3 middle = Vec3::Zero();
      for (int k = 0; k < 3; ++k) middle += mesh.point(mesh.face(f)[k]) / 3;
      middle = Vec3((middle.x() - centre.x()) / 4, middle.y() - centre.y(), 0);
      inside[f] = middle.norm() < radius;
      for (int k = 0; inside[f] && k < 3; ++k) touched[mesh.face(f)[k]] = 1;
    }
    const std::vector<int> loop = loop_around(mesh, inside);
    if (loop.empty()) continue;
    ++loops;
    Sources sources;
    sources.add(Curve::along_vertices(loop));
    const VecX d = test::marched(mesh, sources);
    std::vector<char> on(mesh.n_vertices(), 0);
    for (const int v : loop) on[v] = 1;
    int wrong = 0;
    const double outside = d.sum() > 0 ? 1 : -1;  // most vertices are
    for (int v = 0; v < mesh.n_vertices(); ++v)
      if (!on[v] && (outside * d[v] > 0) == (touched[v] != 0)) ++wrong;
    EXPECT_EQ(wrong, 0) << seed;
  }
  EXPECT_GE(loops, 20);
}

TEST(FastMarching, ItDoesNotMatterWhichFaceIsTheFirst) {
  const PolygonSoup soup = test::jittered_grid_soup(4, 4, 0.3);
  Sources corner;  // from the boundary to the middle and back to it, along edges
  corner.add(Curve::along_vertices({10, 11, 12, 17, 22}));
  const VecX expected = test::marched(SurfaceMesh(soup), corner);
  EXPECT_LT(expected.minCoeff(), -0.2);
  EXPECT_GT(expected.maxCoeff(), 0.2);
  for (int first = 1; first < soup.n_faces(); ++first) {
    PolygonSoup turned = soup;
    turned.corners.clear();
    turned.face_offsets = {0};
    for (int f = 0; f < soup.n_faces(); ++f)
      turned.add_face(soup.face((first + f) % soup.n_faces()));
    EXPECT_LT((test::marched(SurfaceMesh(turned), corner) - expected).cwiseAbs().maxCoeff(), 1e-12)
        << first;
  }
}

TEST(FastMarching, ErrorFallsWithTheEdgeLength) {
  double error[2];
  for (int i = 0; i < 2; ++i) {
    const SurfaceMesh mesh(test::octasphere_soup(3 + 2 * i));
    const VecX d = test::marched(mesh, test::vertex_points({4}));
    error[i] =
        worst_error(mesh, d, [](const Vec3& p) { return std::acos(std::clamp(p.z(), -1., 1.)); });
  }
  EXPECT_LT(error[1], 0.5 * error[0]);  // of order h log h from a point
  EXPECT_LT(error[1], 0.05);
}

TEST(FastMarching, RightAnglesAreSplitInAnyUnit) {
  constexpr int n = 8;
  const PolygonSoup soup = test::grid_soup(n, n, 1);
  const VecX d = test::marched(SurfaceMesh(soup), test::vertex_points({3}));
  const Vec3 source = soup.points.row(3);
  EXPECT_LT(worst_error(SurfaceMesh(soup), d, [&](const Vec3& p) { return (p - source).norm(); }),
            0.025);
  for (const double unit : {3., 0.7, 1e-40, 1e40}) {
    PolygonSoup scaled = soup;
    scaled.points *= unit;
    const VecX same = test::marched(SurfaceMesh(scaled), test::vertex_points({3}));
    EXPECT_LT((same / unit - d).cwiseAbs().maxCoeff(), 1e-12) << unit;
  }
}

TEST(FastMarching, PointsInFacesAndOnEdges) {
  const SurfaceMesh mesh(test::jittered_grid_soup(24, 24, 0.2));
  for (const SurfacePoint& p :
       {SurfacePoint::in_face(600, 0.2, 0.3, 0.5), SurfacePoint::on_edge(800, 0.4)}) {
    Sources sources;
    sources.points = {p};
    const Vec3 at = mesh.position(p);
    EXPECT_LT(worst_error(mesh, test::marched(mesh, sources),
                          [&](const Vec3& q) { return (q - at).norm(); }),
              0.03);
  }
}

TEST(FastMarching, GoesIntoEverySheetAtAnEdge) {
  // Three sheets on one edge: the front goes into each.
  PolygonSoup soup = test::grid_soup(8, 8);
  const int n = soup.n_vertices();
  soup.points.conservativeResize(2 * n, 3);
  for (int v = 0; v < n; ++v) soup.points.row(n + v) << soup.points(v, 0), 0, soup.points(v, 1);
  const int faces = soup.n_faces();
  for (int f = 0; f < faces; ++f) {
    const auto c = soup.face(f);
    auto lifted = [&](int v) { return v <= 8 ? v : n + v; };
    test::add_triangle(soup, lifted(c[0]), lifted(c[1]), lifted(c[2]));
  }
  const SurfaceMesh mesh(soup);
  const VecX d = test::marched(mesh, test::vertex_points({40})),
             e = test::exact(mesh, test::vertex_points({40}));
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (std::isfinite(e[v])) {
      EXPECT_NEAR(d[v], e[v], 0.1);
    }
}

TEST(FastMarching, ShareOfTheAreaWhereTheGradientIsOffUnitLength) {
  for (const double unit : {1.0, 1e-5, 1e7}) {
    PolygonSoup soup = test::grid_soup(8, 8);
    soup.points *= unit;
    const SurfaceMesh mesh(soup);
    Report report;
    const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
    const auto share = [&](const std::function<double(double)>& of_x) {
      VecX d(mesh.n_vertices());
      for (int v = 0; v < mesh.n_vertices(); ++v) d[v] = of_x(mesh.point(v).x() / unit) * unit;
      return off_unit_share(T, d);
    };
    for (const double slope : {0.76, 1.0, 1.24})
      EXPECT_EQ(share([&](double x) { return slope * x; }), 0) << slope;
    for (const double slope : {0.0, 0.74, 1.26, 100.0})
      EXPECT_EQ(share([&](double x) { return slope * x; }), 1) << slope;
    EXPECT_NEAR(share([](double x) { return std::max(x, 4 * x - 2.25); }), 0.25, 1e-12);
    // Of triangles through which the sign changes the gradient says nothing, nor beyond what is
    // reached.
    EXPECT_EQ(share([](double x) { return x < 0.6 ? x - 1 : x; }), 0);
    EXPECT_NEAR(share([](double x) { return x > 0.51 ? infinity : std::max(x, 4 * x - 0.75); }),
                0.5, 1e-12);
  }
}

TEST(FastMarching, TheMethodSaysWhereLongTrianglesMakeItWrong) {
  const int n = 12;
  for (const double shear : {0.0, 2.0}) {
    PolygonSoup soup = test::grid_soup(n, n);
    soup.points.col(0) += shear * soup.points.col(1);
    const SurfaceMesh mesh(soup);
    Sources corner;  // an obtuse one of the parallelogram, from which it is seen whole
    corner.points.push_back(SurfacePoint::at_vertex(n));
    Report report;
    const VecX d = test::surface_distance(mesh, corner, FastMarching{}, report);
    const Vec3 from = mesh.point(n);
    const double worst =
        worst_error(mesh, d, [&](const Vec3& p) { return (p - from).norm(); }) / d.maxCoeff();
    EXPECT_EQ(worst > 0.05, shear > 0) << worst;
    const auto n_warnings =
        std::ranges::count(report.warnings, "gradient-off-unit", &Warning::code);
    EXPECT_EQ(n_warnings, shear > 0 ? 1 : 0);
    EXPECT_EQ(report.residuals.back().first, "area fraction with gradient off unit length");
  }
}

TEST(FastMarching, SignsThatJumpAreCountedAndWarnedOf) {
  const int n = 20;
  const SurfaceMesh mesh(test::grid_soup(n, n));
  const auto jumps = [&](const MatX3& curve) {
    Report report;
    test::geodesic(fast_marching, mesh, test::space_curve(curve), report);
    const double count = test::size_named(report, "edges_where_the_sign_jumps");
    EXPECT_EQ(std::ranges::count(report.warnings, "sign-uncertain", &Warning::code), count > 0);
    return count;
  };
  MatX3 across(2, 3), half(2, 3);
  across << 0, 0.51, 0, 1, 0.51, 0;
  half << 0, 0.51, 0, 0.52, 0.51, 0;
  EXPECT_EQ(jumps(across), 0);
  EXPECT_EQ(jumps(test::circle(0.5, 0.5, 0, 0.3, 80)), 0);
  // Beyond its end sides meet on the straight line that goes on: in each column an upright edge and
  // a diagonal, in which the line is nearly half the way up.
  EXPECT_NEAR(jumps(half), 2 * n * (1 - 0.52), 3);
  // Two halves of a circle, of which one runs the other way, meet at two ends.
  const MatX3 circle = test::circle(0.5, 0.5, 0, 0.3, 80);
  Sources halves = test::space_curve(circle.topRows(41));
  const Sources other = test::space_curve(circle.bottomRows(41).colwise().reverse());
  halves.space_curves.push_back(other.space_curves[0]);
  Report report;
  test::geodesic(fast_marching, mesh, halves, report);
  EXPECT_GE(test::size_named(report, "edges_where_the_sign_jumps"), 10);
}

TEST(FastMarching, VerticesThatHangOnByTheCurveHaveNoSideAndAreWarnedOf) {
  // A square with a line along its diagonal, and a triangle at an end of it; or at another corner.
  MatX3 diagonal(2, 3);
  diagonal << 0, 0, 0, 1, 1, 0;
  for (const bool at_the_end : {true, false}) {
    const int n = 8, corner = at_the_end ? 0 : n;
    PolygonSoup soup = test::grid_soup(n, n);
    const int first = soup.n_vertices();
    soup.points.conservativeResize(first + 2, 3);
    const Vec3 at = soup.points.row(corner);
    soup.points.row(first) = at - Vec3(0.2, 0.3, 0);
    soup.points.row(first + 1) = at + Vec3(0.2, -0.3, 0);
    test::add_triangle(soup, corner, first, first + 1);
    Report report;
    const VecX d =
        test::geodesic(fast_marching, SurfaceMesh(soup), test::space_curve(diagonal), report);
    std::string said;
    for (const Warning& warning : report.warnings)
      if (warning.code == "sign-uncertain") said += warning.text;
    EXPECT_EQ(said.find("2 vertices are") != std::string::npos, at_the_end) << said;
    EXPECT_EQ(said.empty(), !at_the_end) << said;
    const double side = at_the_end ? 1 : -1;  // the corner is to the right of the line
    EXPECT_GT(side * d[first], 0);
    EXPECT_GT(side * d[first + 1], 0);
  }
}

TEST(FastMarching, StopsWhenAsked) {
  const SurfaceMesh mesh(test::octasphere_soup(6));
  CancelToken token;
  token.cancel();
  Report report;
  EXPECT_THROW(test::geodesic(fast_marching, mesh, test::vertex_points({0}), report, Task(token)),
               Cancelled);
}

}  // namespace
}  // namespace littoral
