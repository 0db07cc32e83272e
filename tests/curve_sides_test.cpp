// On which side of broken curves points lie; circulations around triangles.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "domain/mesh/face_orientation.h"
#include "heat_helpers.h"
#include "operators/jump_calculus.h"
#include "sources/curves/completed_curves.h"
#include "sources/curves/conform.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// Ends of what the line y = height has in a triangle of the plane, left to right; none: first
/// beyond second.
std::pair<double, double> part_in_triangle(const std::array<Vec3, 3>& corners, double height) {
  std::pair<double, double> ends{infinity, -infinity};
  for (int k = 0; k < 3; ++k) {
    const Vec3 &a = corners[k], &b = corners[(k + 1) % 3];
    if ((a.y() < height) == (b.y() < height)) continue;
    const double x = a.x() + (height - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    ends = {std::min(ends.first, x), std::max(ends.second, x)};
  }
  return ends;
}

TEST(CurveSides, AreThoseOfPiecesInTheTriangleAndElsewhereOfTheFunction) {
  // A curve to the right, up to the middle of a triangle; the function says the opposite.
  const SurfaceMesh mesh(test::jittered_grid_soup(6, 6, 0.2));
  const double height = 0.41, end = 0.63;
  MatX3 line(2, 3);
  line << 0, height, 0, end, height, 0;
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const PlacedSources placed = place_sources(mesh, test::space_curve(line), report);
  VecX phi(mesh.n_vertices()), expected_at_vertices(phi.size());
  for (int v = 0; v < mesh.n_vertices(); ++v) phi[v] = height - mesh.point(v).y();
  for (Eigen::Index v = 0; v < phi.size(); ++v) expected_at_vertices[v] = phi[v] < 0 ? -1 : 1;
  const CurveSides sides(mesh, T, placed, phi);
  int by_pieces = 0, by_function = 0, ahead = 0;
  for (int f = 0; f < T.n_faces(); ++f) {
    std::array<Vec3, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] = mesh.point(T.faces(f, k));
    auto [from, to] = part_in_triangle(corners, height);
    to = std::min(to, end);
    for (int i = 0; i <= 12; ++i)
      for (int j = 0; i + j <= 12; ++j) {
        const P2Shape<2>::Point b = P2Shape<2>::Point(i, j, 12 - i - j) / 12;
        const Vec3 x = b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2];
        const double above = x.y() - height;
        const double away = std::hypot(x.x() - std::clamp(x.x(), std::min(from, to), to), above);
        const bool has_piece = from < to - 1e-9, beside = std::abs(above) >= 0.5 * away;
        if (std::abs(above) < 1e-3 || std::abs(std::abs(above) - 0.5 * away) < 1e-6) continue;
        const bool by_piece = has_piece && beside;
        EXPECT_EQ(sides.at(f, b), (above > 0) == by_piece ? 1 : -1) << f << " at " << b.transpose();
        ++(by_piece ? by_pieces : has_piece ? ahead : by_function);
      }
  }
  EXPECT_GT(by_pieces, 100);
  EXPECT_GT(ahead, 5);
  EXPECT_GT(by_function, 500);
}

TEST(CurveSides, VerticesOfTrianglesWithPiecesLieBesideThem) {
  const SurfaceMesh mesh(test::grid_soup(4, 4));
  MatX3 line(2, 3);
  line << 0, 0.4, 0, 1, 0.4, 0;
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const PlacedSources placed = place_sources(mesh, test::space_curve(line), report);
  VecX phi(mesh.n_vertices());
  for (int v = 0; v < mesh.n_vertices(); ++v) phi[v] = 0.4 - mesh.point(v).y();
  const VecX sign = CurveSides(mesh, T, placed, phi).at_vertices();
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const double y = mesh.point(v).y();
    const bool near = y > 0.2 && y < 0.6;  // the rows of vertices next to the curve
    EXPECT_EQ(sign[v], (y > 0.4) == near ? 1 : -1) << v;
  }
  // Where the function is 0 and no curve is near, too.
  VecX zero = phi;
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (mesh.point(v).y() > 0.9) zero[v] = v % 2 ? 0.0 : -0.0;
  const VecX with_zeros = CurveSides(mesh, T, placed, zero).at_vertices();
  for (int v = 0; v < mesh.n_vertices(); ++v) EXPECT_EQ(with_zeros[v], zero[v] == 0 ? 1 : sign[v]);
  // No curve with sides: all is positive.
  const PlacedSources unsided = place_sources(mesh, test::space_curve(line, false), report);
  EXPECT_EQ(CurveSides(mesh, T, unsided, phi).at_vertices(), VecX::Ones(phi.size()));
}

TEST(JumpCalculus, CirculationsOfARotationAreAreas) {
  const SurfaceMesh mesh(test::jittered_grid_soup(5, 4, 0.2));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const JumpCalculus J = jump_calculus(T);
  VecX omega(J.n_edges);  // of x dy
  for (int e = 0; e < J.n_edges; ++e) {
    const Vec3 a = mesh.point(T.edges(e, 0)), b = mesh.point(T.edges(e, 1));
    omega[e] = 0.5 * (a.x() + b.x()) * (b.y() - a.y());
  }
  const VecX around = J.d1(omega);
  for (int f = 0; f < J.n_faces; ++f) {
    const Vec3 a = mesh.point(T.faces(f, 0)), b = mesh.point(T.faces(f, 1)),
               c = mesh.point(T.faces(f, 2));
    EXPECT_NEAR(around[f], 0.5 * (b - a).cross(c - a).z(), 1e-14) << f;
    // The transpose, by what it does to single faces.
    EXPECT_NEAR(J.d1_transpose(VecX::Unit(J.n_faces, f)).dot(omega), around[f], 1e-14) << f;
  }
}

/// A walk over the first faces of a mesh: each node lies in a face with the one before. It begins
/// and ends inside faces.
std::vector<SurfacePoint> random_walk(const SurfaceMesh& mesh, int faces, std::size_t steps,
                                      std::mt19937& random) {
  const auto any = [&](std::size_t n) { return std::size_t(random() % n); };
  std::uniform_real_distribution<double> some(0.1, 0.9);
  const auto inside = [&](int f) {
    const double b = some(random) / 2, c = some(random) / 2;
    return SurfacePoint::in_face(f, 1 - b - c, b, c);
  };
  std::vector<SurfacePoint> out{inside(int(any(std::size_t(faces))))};
  while (out.size() < steps || out.back().on != SurfacePoint::On::face) {
    const SurfacePoint& at = out.back();
    std::vector<int> near;
    for (int f = 0; f < faces; ++f) {
      bool has = at.on == SurfacePoint::On::face && at.element == f;
      for (int k = 0; k < 3; ++k)
        has = has || (at.on == SurfacePoint::On::vertex
                          ? mesh.face(f)[std::size_t(k)] == at.element
                          : at.on == SurfacePoint::On::edge && mesh.side_edge(f, k) == at.element);
      if (has) near.push_back(f);
    }
    const int f = near[any(near.size())], k = int(any(3));
    const SurfacePoint to[3] = {SurfacePoint::at_vertex(mesh.face(f)[std::size_t(k)]),
                                SurfacePoint::on_edge(mesh.side_edge(f, k), some(random)),
                                inside(f)};
    const SurfacePoint next = to[any(3)];
    if ((mesh.position(next) - mesh.position(at)).norm() > 1e-9) out.push_back(next);
  }
  return out;
}

TEST(CarrySides, InThePlaneCurvesStayOnTheirSideWhateverIsFlippedAndAttachedThere) {
  std::mt19937 random(3);
  int down = 0;
  for (int round = 0; round < 40; ++round) {
    // Some faces are flipped, and pages stand on some edges.
    const SurfaceMesh plane(test::jittered_grid_soup(5, 5, 0.2));
    const int faces = plane.n_faces();
    PolygonSoup soup;
    soup.points = plane.points();
    for (int f = 0; f < faces; ++f) {
      std::vector<int> corners(plane.face(f).begin(), plane.face(f).end());
      if (random() % 2) std::swap(corners[0], corners[1]);
      soup.add_face(corners);
    }
    for (int e = 0; e < plane.n_edges(); ++e) {
      if (random() % 2) continue;
      const int n = soup.n_vertices();
      soup.points.conservativeResize(n + 1, 3);
      soup.points.row(n) = plane.position(SurfacePoint::on_edge(e, 0.5)) + 0.1 * Vec3::UnitZ();
      test::add_triangle(soup, plane.edges()(e, 0), plane.edges()(e, 1), n);
    }
    const SurfaceMesh mesh(soup);
    Sources sources;
    const auto add = [&](const std::vector<SurfacePoint>& nodes) {
      sources.curves.emplace_back();
      sources.curves.back().nodes = nodes;
    };
    const auto some_walk = [&](std::size_t steps) {
      return random_walk(mesh, faces, steps, random);
    };
    // 0 and 1: one curve in two parts, the second first. 2 and 3: there and back.
    std::vector<SurfacePoint> walk = some_walk(30);
    add({walk.begin() + 14, walk.end()});
    add({walk.begin(), walk.begin() + 15});
    walk = some_walk(8);
    add(walk);
    add({walk.rbegin(), walk.rend()});
    // 4: two begin where it ends. 7 and 8 end where 9 begins. None goes on as another.
    walk = some_walk(20);
    add({walk.begin(), walk.begin() + 6});
    add({walk.begin() + 5, walk.begin() + 12});
    add({walk.begin() + 5, walk.end()});
    walk = some_walk(20);
    add({walk.begin(), walk.begin() + 11});
    add({walk.begin() + 5, walk.begin() + 11});
    add({walk.begin() + 10, walk.end()});
    Report report;
    const PlacedSources placed = place_sources(mesh, sources, report);
    const FaceOrientation& orientation = face_orientation(mesh);
    const auto is_left = [&](const CurvePiece& p) {  // seen from above
      const auto c = mesh.face(p.face);
      const Vec3 a = mesh.point(c[0]);
      const double up = (mesh.point(c[1]) - a).cross(mesh.point(c[2]) - a).z();
      return (up * orientation.sign[std::size_t(p.face)] > 0) == p.left;
    };
    std::vector<const CurvePiece*> first(sources.curves.size(), nullptr);
    for (const CurvePiece& p : placed.pieces) {
      ASSERT_LT(p.face, faces);
      if (!first[std::size_t(p.curve)]) first[std::size_t(p.curve)] = &p;
    }
    const auto leader = [&](int curve) { return curve == 0 ? 1 : curve == 3 ? 2 : curve; };
    for (std::size_t c = 1; c < first.size(); ++c)
      if (c != 3) {
        EXPECT_TRUE(first[c]->left) << c;
      }
    for (const CurvePiece& p : placed.pieces) {
      EXPECT_EQ(is_left(p), is_left(*first[std::size_t(leader(p.curve))])) << "curve " << p.curve;
      down += !p.left;
    }
    const auto told = [&](const std::string& code) {
      return std::any_of(report.warnings.begin(), report.warnings.end(),
                         [&](const auto& warning) { return warning.code == code; });
    };
    EXPECT_EQ(told("flipped-faces"), orientation.flipped > 0);
    EXPECT_FALSE(told("not-orientable"));
  }
  EXPECT_GT(down, 500);
}

TEST(Conform, SegmentsThatAreACurveByThemselvesAreHalved) {
  // Along one edge there is no vertex between the ends, at which all would be held.
  const SurfaceMesh mesh(test::grid_soup(4, 4));
  Report report;
  const auto conforming = [&](std::initializer_list<int> vertices) {
    Sources sources;
    sources.curves.emplace_back();
    for (const int v : vertices) sources.curves[0].nodes.push_back(SurfacePoint::at_vertex(v));
    return conform(mesh, pieces_with_sides(place_sources(mesh, sources, report)));
  };
  const auto edges = [](const ConformingCurves& of) {
    return std::count_if(of.times.begin(), of.times.end(), [](double t) { return t != 0; });
  };
  for (const auto& [a, b] : {std::pair(6, 7), {7, 6}, {6, 11}, {11, 6}, {6, 12}, {12, 6}}) {
    const ConformingCurves one = conforming({a, b});
    EXPECT_EQ(one.cut.mesh.n_vertices(), mesh.n_vertices() + 1) << a << " " << b;
    EXPECT_EQ(edges(one), 2);
    EXPECT_TRUE(one.is_cut);
    // It leads from a to b.
    VecX ends = VecX::Zero(one.cut.mesh.n_vertices());
    for (int e = 0; e < one.cut.mesh.n_edges(); ++e) {
      ends[one.cut.mesh.edges()(e, 0)] -= one.times[e];
      ends[one.cut.mesh.edges()(e, 1)] += one.times[e];
    }
    EXPECT_EQ(ends[a], -1);
    EXPECT_EQ(ends[b], 1);
    EXPECT_EQ(ends.cwiseAbs().sum(), 2);
  }
  EXPECT_EQ(conforming({6, 7, 8}).cut.mesh.n_vertices(), mesh.n_vertices());
  EXPECT_EQ(edges(conforming({6, 7, 8})), 2);
  EXPECT_FALSE(conforming({6, 7, 12, 6}).is_cut);
}

}  // namespace
}  // namespace littoral
