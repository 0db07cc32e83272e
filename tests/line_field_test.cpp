// Directions through sparse ones, and the Hessian energy of curved surfaces.

#include "operators/line_field.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "operators/curved_hessian.h"
#include "regularized_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(LineField, InterpolatesOnAPlaneAndForgetsSigns) {
  const SurfaceMesh mesh(test::jittered_grid_soup(8, 8, 0.2));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const Vec3 x(0.6, 0.8, 0);
  const VecX V = interpolate_line_field(
      T, {{3, tangent_part(mesh, T, 3, x)}, {100, tangent_part(mesh, T, 100, -x)}}, {});
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const Complex expected = tangent_part(mesh, T, f, x), v(V[2 * f], V[2 * f + 1]);
    EXPECT_NEAR(std::abs((std::conj(expected) * v).real()), 1, 1e-4) << f;
  }
}

TEST(CurvedHessian, LinearFunctionsOnThePlaneAndConstantsCostNothing) {
  const SurfaceMesh mesh(test::jittered_grid_soup(7, 6, 0.3));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const SpMat W = curved_hessian(T, triangle_operators(T).vector);
  for (int axis = 0; axis < 2; ++axis) {
    const VecX u = mesh.points().col(axis);
    EXPECT_LT((W.selfadjointView<Eigen::Lower>() * u).cwiseAbs().maxCoeff(), 1e-9);
  }
  const SurfaceMesh sphere(test::octasphere_soup(4));
  const IntrinsicTriangulation S = intrinsic_triangulation(sphere, report);
  const SpMat H = curved_hessian(S, triangle_operators(S).vector);
  // z is an eigenfunction of Delta with eigenvalue -2: the energy is the integral of (2 z)^2.
  const VecX z = sphere.points().col(2);
  const double energy = z.dot(H.selfadjointView<Eigen::Lower>() * z);
  EXPECT_NEAR(energy * S.unit * S.unit / (16 * std::numbers::pi / 3), 1, 0.05);
}

/// A band of n x width squares with half a twist, its points moved at random.
PolygonSoup twisted_band(int n, int width, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.03, 0.03);
  PolygonSoup soup;
  soup.points.resize(n * (width + 1), 3);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= width; ++j) {
      const double u = 2 * std::numbers::pi * i / n, w = 0.8 * j / width - 0.4;
      soup.points.row(i * (width + 1) + j)
          << (1 + w * std::cos(u / 2)) * std::cos(u) + jitter(random),
          (1 + w * std::cos(u / 2)) * std::sin(u) + jitter(random),
          w * std::sin(u / 2) + jitter(random);
    }
  const auto at = [&](int i, int j) {
    return i < n ? i * (width + 1) + j : (i - n) * (width + 1) + width - j;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < width; ++j) {
      test::add_triangle(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1));
      test::add_triangle(soup, at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return soup;
}

PolygonSoup bumpy_sphere(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> radius(0.8, 1.2);
  PolygonSoup soup = test::octasphere_soup(2);
  for (auto p : soup.points.rowwise()) p *= radius(random);
  return soup;
}

/// The same faces in another order, begun at other corners, and some of them turned.
PolygonSoup reordered(const PolygonSoup& soup, unsigned seed, std::vector<int>& order) {
  std::mt19937 random(seed);
  order.resize(static_cast<std::size_t>(soup.n_faces()));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  PolygonSoup out;
  out.points = soup.points;
  for (const int f : order) {
    std::array<int, 3> c{soup.face(f)[0], soup.face(f)[1], soup.face(f)[2]};
    std::rotate(c.begin(), c.begin() + static_cast<int>(random() % 3), c.end());
    if (random() % 2) std::swap(c[0], c[1]);
    out.add_face(c);
  }
  return out;
}

TEST(CurvedHessian, TheOrderAndTheSidesOfFacesMakeNoDifference) {
  for (const PolygonSoup& soup :
       {twisted_band(14, 3, 1), bumpy_sphere(2), test::jittered_grid_soup(5, 4, 0.2),
        test::book_soup(3, 3, 0.7)}) {
    Report report;
    const auto hessian = [&](const PolygonSoup& of) {
      const IntrinsicTriangulation T = intrinsic_triangulation(SurfaceMesh(of), report);
      const SpMat W = curved_hessian(T, triangle_operators(T).vector);
      const SpMat whole = W.selfadjointView<Eigen::Lower>();
      return MatX(MatX(whole) * T.unit * T.unit);
    };
    const MatX W = hessian(soup);
    EXPECT_LT((W * VecX::Ones(W.cols())).cwiseAbs().maxCoeff(), 1e-9 * W.cwiseAbs().maxCoeff());
    for (const unsigned seed : {1u, 2u, 3u}) {
      std::vector<int> order;
      EXPECT_LT((hessian(reordered(soup, seed, order)) - W).cwiseAbs().maxCoeff(),
                1e-9 * W.cwiseAbs().maxCoeff());
    }
  }
}

TEST(LineField, TheOrderAndTheSidesOfFacesMakeNoDifference) {
  for (const PolygonSoup& soup : {twisted_band(14, 3, 1), bumpy_sphere(2)}) {
    Report report;
    const std::vector<int> given{3, 31};
    const auto lines = [&](const PolygonSoup& of, const std::vector<int>& order) {
      const SurfaceMesh mesh(of);
      const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
      std::vector<std::pair<int, Complex>> directions;
      for (int f = 0; f < mesh.n_faces(); ++f)
        if (std::find(given.begin(), given.end(), order[f]) != given.end()) {
          const Complex v = tangent_part(mesh, T, f, Vec3(0.3, -0.5, 0.7));
          directions.emplace_back(T.triangle_of_face[f], v / std::abs(v));
        }
      EXPECT_EQ(directions.size(), given.size());
      const VecX V = interpolate_line_field(T, directions, {});
      const MatX3 frames = face_frames(mesh, T);
      MatX3 out(mesh.n_faces(), 3);
      for (int f = 0; f < mesh.n_faces(); ++f) {
        const int t = T.triangle_of_face[f];
        out.row(order[f]) = V[2 * t] * frames.row(2 * t) + V[2 * t + 1] * frames.row(2 * t + 1);
      }
      return out;
    };
    std::vector<int> order(static_cast<std::size_t>(soup.n_faces()));
    std::iota(order.begin(), order.end(), 0);
    const MatX3 first = lines(soup, order);
    for (const unsigned seed : {1u, 2u, 3u}) {
      const PolygonSoup other = reordered(soup, seed, order);
      const MatX3 again = lines(other, order);
      for (int f = 0; f < soup.n_faces(); ++f)
        EXPECT_NEAR(std::abs(first.row(f).dot(again.row(f))), 1, 1e-6) << f;
    }
    for (const int f : given) {
      const Vec3 a = soup.points.row(soup.face(f)[0]), b = soup.points.row(soup.face(f)[1]),
                 c = soup.points.row(soup.face(f)[2]);
      const Vec3 n = (b - a).cross(c - a).normalized(), v(0.3, -0.5, 0.7);
      EXPECT_NEAR(std::abs(first.row(f).dot((v - v.dot(n) * n).normalized())), 1, 1e-4);
    }
  }
}

}  // namespace
}  // namespace littoral
