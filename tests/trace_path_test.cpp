#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "constants.h"
#include "littoral/error.h"
#include "sources/curves/trace.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::pi;

double path_length(const SurfaceMesh& mesh, const std::vector<SurfacePoint>& path) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    sum += (mesh.position(path[i + 1]) - mesh.position(path[i])).stableNorm();
  return sum;
}

SurfacePoint random_point(const SurfaceMesh& mesh, std::mt19937& random) {
  std::uniform_real_distribution<double> u(0, 1);
  switch (random() % 3) {
    case 0:
      return SurfacePoint::at_vertex(mesh.face(static_cast<int>(random() % mesh.n_faces()))[0]);
    case 1:
      return SurfacePoint::on_edge(static_cast<int>(random() % mesh.n_edges()), u(random));
    default: {
      double a = u(random), b = u(random);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      return SurfacePoint::in_face(static_cast<int>(random() % mesh.n_faces()), 1 - a - b, a, b);
    }
  }
}

void expect_path(const SurfaceMesh& mesh, const std::vector<SurfacePoint>& path,
                 const SurfacePoint& from, const SurfacePoint& to) {
  ASSERT_GE(path.size(), 2u);
  const double size = mesh.points().cwiseAbs().maxCoeff();
  EXPECT_LE((mesh.position(path.front()) - mesh.position(from)).norm(), 1e-11 * size);
  EXPECT_LE((mesh.position(path.back()) - mesh.position(to)).norm(), 1e-11 * size);
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    EXPECT_TRUE(share_face(mesh, path[i], path[i + 1])) << "step " << i;
    EXPECT_TRUE(mesh.position(path[i]).allFinite());
    if (i > 0) {
      EXPECT_NE(path[i].on, SurfacePoint::On::face);
    }
  }
}

TEST(TracePath, StraightOnThePlane) {
  std::mt19937 random(5);
  for (const PolygonSoup& soup : {test::grid_soup(40, 40), test::grid_soup(17, 60, 1),
                                  test::jittered_grid_soup(40, 40, 0.2)}) {
    const SurfaceMesh mesh{soup};
    const Tracer tracer(mesh);
    for (int i = 0; i < 40; ++i) {
      const SurfacePoint a = random_point(mesh, random), b = random_point(mesh, random);
      const auto path = tracer.trace(a, b);
      expect_path(mesh, path, a, b);
      const double straight = (mesh.position(a) - mesh.position(b)).norm();
      EXPECT_LE(path_length(mesh, path), straight * (1 + 1e-6) + 1e-12);
    }
  }
}

TEST(TracePath, GeodesicOnTheSphere) {
  std::mt19937 random(6);
  const SurfaceMesh mesh{test::octasphere_soup(5)};
  const Tracer tracer(mesh);
  for (int i = 0; i < 30; ++i) {
    const SurfacePoint a = random_point(mesh, random), b = random_point(mesh, random);
    const auto path = tracer.trace(a, b);
    expect_path(mesh, path, a, b);
    const double arc = std::acos(
        std::clamp(mesh.position(a).normalized().dot(mesh.position(b).normalized()), -1.0, 1.0));
    EXPECT_LE(path_length(mesh, path), arc * 1.01 + 1e-9);
    EXPECT_GE(path_length(mesh, path), arc * 0.99 - 1e-9);
  }
  EXPECT_NEAR(
      path_length(mesh, tracer.trace(SurfacePoint::at_vertex(4), SurfacePoint::at_vertex(5))), pi,
      0.01 * pi);
}

/// Six sides of [0,1]^3, n x n cells each, vertices shared.
SurfaceMesh cube(int n) {
  PolygonSoup soup;
  std::map<std::array<int, 3>, int> number;
  std::vector<Vec3> points;
  auto vertex = [&](std::array<int, 3> ijk) {
    const auto [it, added] = number.try_emplace(ijk, static_cast<int>(points.size()));
    if (added) points.push_back(Vec3(ijk[0], ijk[1], ijk[2]) / n);
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side <= n; side += n)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          auto at = [&](int di, int dj) {
            std::array<int, 3> ijk{};
            ijk[axis] = side;
            ijk[(axis + 1) % 3] = i + di;
            ijk[(axis + 2) % 3] = j + dj;
            return vertex(ijk);
          };
          test::add_triangle(soup, at(0, 0), at(1, 0), at(1, 1));
          test::add_triangle(soup, at(0, 0), at(1, 1), at(0, 1));
        }
  soup.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v)
    soup.points.row(static_cast<Eigen::Index>(v)) = points[v];
  return SurfaceMesh{std::move(soup)};
}

TEST(TracePath, OppositeCornersOfTheCube) {
  for (int n : {1, 2, 7}) {
    const SurfaceMesh mesh = cube(n);
    int low = -1, high = -1;
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      if (mesh.point(v).isZero()) low = v;
      if (mesh.point(v).isOnes()) high = v;
    }
    const auto a = SurfacePoint::at_vertex(low), b = SurfacePoint::at_vertex(high);
    const auto path = trace(mesh, a, b);
    expect_path(mesh, path, a, b);
    EXPECT_NEAR(path_length(mesh, path), std::sqrt(5.0), 1e-9);
  }
}

TEST(TracePath, BookOfPagesCrossesTheSpine) {
  // Five half planes meeting in one line: a nonmanifold edge strip.
  const int n = 12, pages = 5;
  const auto vertex = [](int page, int i, int j) {
    return i == 0 ? j : (n + 1) * (1 + page * n + i - 1) + j;
  };
  const SurfaceMesh mesh{test::book_soup(pages, n, 1)};
  for (int page = 1; page < pages; ++page) {
    const auto a = SurfacePoint::at_vertex(vertex(0, 9, 2));
    const auto b = SurfacePoint::at_vertex(vertex(page, 6, 11));
    const auto path = trace(mesh, a, b);
    expect_path(mesh, path, a, b);
    EXPECT_NEAR(path_length(mesh, path), std::hypot(15.0 / n, 9.0 / n), 1e-9);
  }
}

TEST(TracePath, AroundACorner) {
  // A grid without its upper right quarter: the way bends at the inner corner.
  const int n = 20;
  const PolygonSoup whole = test::grid_soup(n, n, 1);
  PolygonSoup soup;
  soup.points = whole.points;
  for (int f = 0; f < whole.n_faces(); ++f) {
    Vec3 centre = Vec3::Zero();
    for (int v : whole.face(f)) centre += whole.points.row(v).transpose() / 3;
    if (centre[0] < 0.5 || centre[1] < 0.5) soup.add_face(whole.face(f));
  }
  const SurfaceMesh mesh{std::move(soup)};
  const auto a = SurfacePoint::at_vertex(n), b = SurfacePoint::at_vertex(n * (n + 1));
  const auto diagonal = trace(mesh, a, b);
  EXPECT_NEAR(path_length(mesh, diagonal), std::sqrt(2.0), 1e-9);
  const auto c = SurfacePoint::at_vertex(n + 9 * (n + 1)),
             d = SurfacePoint::at_vertex(9 + n * (n + 1));
  const auto bent = trace(mesh, c, d);
  expect_path(mesh, bent, c, d);
  EXPECT_NEAR(path_length(mesh, bent), std::hypot(0.5, 0.05) * 2, 1e-9);
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Angles on both sides of a path that passes a vertex of a closed surface, from one point beside
/// the vertex to another.
std::array<double, 2> angles_at(const SurfaceMesh& mesh, int v, const SurfacePoint& before,
                                const SurfacePoint& after) {
  // The faces in turn, each from one tip to the next.
  std::vector<std::array<int, 2>> fan;
  for (int f : mesh.vertex_faces(v))
    for (std::size_t k = 0; k < 3; ++k)
      if (mesh.face(f)[k] == v)
        fan.push_back({mesh.face(f)[(k + 1) % 3], mesh.face(f)[(k + 2) % 3]});
  for (std::size_t i = 1; i < fan.size(); ++i)
    for (std::size_t j = i; j < fan.size(); ++j)
      if (fan[j][0] == fan[i - 1][1]) {
        std::swap(fan[i], fan[j]);
        break;
      }
  const Vec3 x = mesh.point(v);
  const auto turn_to = [&](const SurfacePoint& p) {
    double turn = 0;
    for (const auto& [a, b] : fan) {
      const Vec3 d = mesh.position(p) - x, to_a = mesh.point(a) - x, to_b = mesh.point(b) - x;
      const double from_a = angle_between(to_a, d), to = angle_between(d, to_b);
      if (from_a + to < angle_between(to_a, to_b) + 1e-7) return turn + from_a;
      turn += angle_between(to_a, to_b);
    }
    return -1.0;
  };
  double all = 0;
  for (const auto& [a, b] : fan) all += angle_between(mesh.point(a) - x, mesh.point(b) - x);
  const double from = turn_to(before), to = turn_to(after);
  EXPECT_GE(from, 0);
  EXPECT_GE(to, 0);
  const double one = std::abs(to - from);
  return {one, all - one};
}

TEST(TracePath, StraightAcrossEdgesAndHalfATurnOnBothSidesOfVertices) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> radius(0.7, 1.3);
  int at_edges = 0, at_vertices = 0;
  for (int shape = 0; shape < 6; ++shape) {
    PolygonSoup soup = test::octasphere_soup(2);
    for (auto p : soup.points.rowwise()) p *= radius(random);
    const SurfaceMesh mesh{soup};
    const Tracer tracer(mesh);
    for (int i = 0; i < 60; ++i) {
      const SurfacePoint a = random_point(mesh, random), b = random_point(mesh, random);
      const auto path = tracer.trace(a, b);
      expect_path(mesh, path, a, b);
      for (std::size_t k = 1; k + 1 < path.size(); ++k) {
        const Vec3 x = mesh.position(path[k]);
        const int at = path[k].element;
        if (path[k].on == SurfacePoint::On::vertex) {
          for (const double angle : angles_at(mesh, at, path[k - 1], path[k + 1]))
            EXPECT_GT(angle, pi - 1e-5) << shape << ", " << i;
          ++at_vertices;
          continue;
        }
        const Vec3 along = mesh.point(mesh.edges()(at, 1)) - mesh.point(mesh.edges()(at, 0));
        const double in = angle_between(mesh.position(path[k - 1]) - x, along);
        const double out = angle_between(mesh.position(path[k + 1]) - x, along);
        EXPECT_NEAR(in + out, pi, 1e-5) << shape << ", " << i;
        ++at_edges;
      }
    }
  }
  EXPECT_GT(at_edges, 1000);
  EXPECT_GT(at_vertices, 100);
}

TEST(TracePath, DifferentComponentsAreNamed) {
  PolygonSoup soup = test::grid_soup(2, 2);
  const int n = soup.n_vertices();
  MatX3 points(2 * n, 3);
  points << soup.points, soup.points;
  soup.points = points;
  const int faces = soup.n_faces();
  for (int f = 0; f < faces; ++f)
    test::add_triangle(soup, soup.face(f)[0] + n, soup.face(f)[1] + n, soup.face(f)[2] + n);
  const SurfaceMesh mesh{std::move(soup)};
  try {
    trace(mesh, SurfacePoint::at_vertex(0), SurfacePoint::at_vertex(n));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("component 0"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("component 1"), std::string::npos);
  }
}

TEST(TracePath, CancelledWhileSearching) {
  const SurfaceMesh mesh{test::octasphere_soup(4)};
  CancelToken token;
  token.cancel();
  EXPECT_THROW(trace(mesh, SurfacePoint::at_vertex(4), SurfacePoint::at_vertex(5), Task(token)),
               Cancelled);
}

TEST(TracePath, PropertyDegenerateMeshes) {
  // Random vertices of a sphere and of a torus moved onto others, random faces given repeated
  // corners, tiny and huge coordinates: paths stay paths and are never longer than the way along
  // edges.
  EXPECT_TRUE(rc::check([] {
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    PolygonSoup soup =
        *rc::gen::arbitrary<bool>() ? test::octasphere_soup(3) : test::torus_soup(16, 9);
    const int damage = *rc::gen::inRange(0, 80);
    for (int i = 0; i < damage; ++i) {
      const int a = static_cast<int>(random() % soup.n_vertices());
      const int b = static_cast<int>(random() % soup.corners.size());
      if (i % 3 == 0) soup.points.row(a) = soup.points.row(soup.corners[b]);
      if (i % 3 == 1) soup.corners[b] = soup.corners[b / 3 * 3];
      if (i % 3 == 2) {
        const auto f = soup.face(b / 3);
        soup.points.row(f[0]) = 0.5 * (soup.points.row(f[1]) + soup.points.row(f[2]));
      }
    }
    soup.points *= std::pow(10.0, *rc::gen::element(0, -30, 30, -200, 200));
    const SurfaceMesh mesh{soup};
    const Tracer tracer(mesh);
    const SurfacePoint a = simplest(mesh, random_point(mesh, random));
    const SurfacePoint b = simplest(mesh, random_point(mesh, random));
    if (tracer.component(a) != tracer.component(b)) return;
    const auto path = tracer.trace(a, b);
    const double size = soup.points.cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
      RC_ASSERT(share_face(mesh, path[i], path[i + 1]));
    RC_ASSERT((mesh.position(path.front()) - mesh.position(a)).isZero(1e-12 * size));
    RC_ASSERT((mesh.position(path.back()) - mesh.position(b)).isZero(1e-12 * size));
    const double there = path_length(mesh, path) / size;
    RC_ASSERT(std::isfinite(there));
    RC_ASSERT(there < 40);
    const double back = path_length(mesh, tracer.trace(b, a)) / size;
    RC_ASSERT(std::abs(there - back) <= 0.35 * (there + back));
  }));
}

}  // namespace
}  // namespace littoral
