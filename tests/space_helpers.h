#pragma once
// Surfaces and samples with known distance in space.

#include <cmath>
#include <random>

#include "littoral/error.h"
#include "littoral/volume.h"
#include "sources/space/oriented_points.h"
#include "test_meshes.h"

namespace littoral::test {

inline MatX3 random_points(int n, double reach, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-reach, reach);
  MatX3 points(n, 3);
  for (double& x : points.reshaped()) x = u(random);
  return points;
}

/// The unit sphere as samples: points exactly on it, with exact normals.
inline OrientedPoints sphere_samples(int level) {
  Report report;
  OrientedPoints samples =
      sample_faces(octasphere_soup(level), std::numeric_limits<double>::infinity(), report);
  samples.points.rowwise().normalize();
  samples.normals = samples.points;
  return samples;
}

/// Axis-aligned box of six quads, outward.
inline PolygonSoup box_soup(const Vec3& half) {
  PolygonSoup soup;
  soup.points.resize(8, 3);
  for (int v = 0; v < 8; ++v)
    soup.points.row(v) << (v & 1 ? half[0] : -half[0]), (v & 2 ? half[1] : -half[1]),
        (v & 4 ? half[2] : -half[2]);
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) soup.add_face(q);
  return soup;
}

/// Closed cylinder about z, radius r, height 2 half, with n sides.
inline PolygonSoup cylinder_soup(int n, double r, double half) {
  PolygonSoup soup;
  soup.points.resize(2 * n, 3);
  std::vector<int> top, bottom;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::acos(-1.0) * i / n;
    soup.points.row(i) << r * std::cos(a), r * std::sin(a), -half;
    soup.points.row(n + i) << r * std::cos(a), r * std::sin(a), half;
    top.push_back(n + i);
    bottom.insert(bottom.begin(), i);
    const int side[4] = {i, (i + 1) % n, n + (i + 1) % n, n + i};
    soup.add_face(side);
  }
  soup.add_face(top);
  soup.add_face(bottom);
  return soup;
}

/// A torus that no symmetry plane or axis of shares nodes with grids about the origin.
inline PolygonSoup off_centre_torus() {
  PolygonSoup torus = torus_soup(40, 20, 0.7, 0.3);
  torus.points.rowwise() += Eigen::RowVector3d(0.013, 0.027, 0.031);
  return torus;
}

/// What a call throws, in words, or "no error".
template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

inline double box_distance(const Vec3& x, const Vec3& half) {
  const Vec3 q = x.cwiseAbs() - half;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}
inline double torus_distance(const Vec3& x, double R, double r) {
  return std::hypot(std::hypot(x[0], x[1]) - R, x[2]) - r;
}
inline double cylinder_distance(const Vec3& x, double r, double half) {
  const double a = std::hypot(x[0], x[1]) - r, b = std::abs(x[2]) - half;
  return std::hypot(std::max(a, 0.0), std::max(b, 0.0)) + std::min(std::max(a, b), 0.0);
}

/// n nodes a side over [-reach, reach]^3.
inline Grid cube_grid(int n, double reach) {
  Grid grid;
  grid.n = {n, n, n};
  grid.origin.setConstant(-reach);
  grid.spacing.setConstant(2 * reach / (n - 1));
  return grid;
}

/// Mean of |values - exact(node)| over the nodes.
template <class Exact>
double mean_error(const Grid& grid, const VecX& values, const Exact& exact) {
  double sum = 0;
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i)
        sum += std::abs(values[static_cast<Eigen::Index>(grid.node(i, j, k))] -
                        exact(grid.point(i, j, k)));
  return sum / static_cast<double>(grid.n_nodes());
}

}  // namespace littoral::test
