#include "io/render/discs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "io/render/raster.h"
#include "io/render/scene_style.h"

namespace littoral::io {

namespace {

constexpr double overlap = 1.05;  // of discs, where the surface bends between them

// Sums over the triangles at each vertex, each with the sign that agrees with the sum so far: the
// triangles of a cloud have no common orientation, and about a point they are nearly flat.
MatX3 mean_normals(const MatX3& points, const MatX3i& triangles) {
  MatX3 sum = MatX3::Zero(points.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Vec3 a = points.row(triangles(t, 0)), b = points.row(triangles(t, 1));
    const Vec3 c = points.row(triangles(t, 2)), u = b - a, v = c - a;
    const double size = std::max(u.norm(), v.norm());
    if (!(size > 0)) continue;
    const Vec3 area = (u / size).cross(v / size);
    for (int k = 0; k < 3; ++k) {
      auto n = sum.row(triangles(t, k));
      n += (n.dot(area) < 0 ? -1 : 1) * area.transpose();
    }
  }
  return sum;
}

/// Radius of discs about the corners that cover a triangle.
double covering_radius(const Vec3& a, const Vec3& b, const Vec3& c) {
  std::array<double, 3> s{(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()};
  std::sort(s.begin(), s.end());
  if (s[0] + s[1] <= s[2]) return std::sqrt(s[2]) / 2;  // obtuse: half of the longest side will do
  return std::sqrt(s[0]) * std::sqrt(s[1]) * std::sqrt(s[2]) / (2 * (b - a).cross(c - a).norm());
}

double middle(std::vector<double>& numbers) {
  const auto at = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), at, numbers.end());
  return *at;
}

// Of a field that is linear on triangles, the mean gradient at each vertex; 0 where it is not
// known.
MatX3 mean_gradients(const Scene& scene, const VecX& values) {
  MatX3 sum = MatX3::Zero(scene.points.rows(), 3);
  VecX count = VecX::Zero(scene.points.rows());
  for (Eigen::Index t = 0; t < scene.triangles.rows(); ++t) {
    const auto corner = scene.triangles.row(t);
    const Vec3 a = scene.points.row(corner[0]);
    const Vec3 u = Vec3(scene.points.row(corner[1])) - a, v = Vec3(scene.points.row(corner[2])) - a;
    const double p = values[corner[1]] - values[corner[0]];
    const double q = values[corner[2]] - values[corner[0]];
    const Vec3 g = gradient_in_triangle(u, v, p, q);
    for (int k = 0; k < 3; ++k) {
      sum.row(corner[k]) += g.transpose();
      ++count[corner[k]];
    }
  }
  for (Eigen::Index v = 0; v < sum.rows(); ++v) sum.row(v) /= std::max(1.0, count[v]);
  return sum;
}

}  // namespace

void show_as_discs(Scene& scene) {
  const Eigen::Index n = scene.points.rows();
  scene.discs.setZero(n, 4);
  scene.discs.leftCols<3>() = mean_normals(scene.points, scene.triangles);
  std::vector<std::vector<double>> around(n);
  VecX covering = VecX::Zero(n);
  for (Eigen::Index t = 0; t < scene.triangles.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int i = scene.triangles(t, k), j = scene.triangles(t, (k + 1) % 3);
      const double length = (scene.points.row(i) - scene.points.row(j)).norm();
      for (const int v : {i, j}) around[v].push_back(length);
    }
    const auto corner = scene.triangles.row(t);
    const double radius = covering_radius(scene.points.row(corner[0]), scene.points.row(corner[1]),
                                          scene.points.row(corner[2]));
    for (const int v : corner) covering[v] = std::max(covering[v], radius);
  }
  std::vector<double> known;
  for (Eigen::Index v = 0; v < n; ++v) {
    auto& lengths = around[v];
    if (lengths.empty()) continue;
    scene.discs(v, 3) = std::min(overlap * covering[v], 2 * middle(lengths));
    known.push_back(scene.discs(v, 3));
  }
  const double usual = known.empty() ? 0 : middle(known);
  for (Eigen::Index v = 0; v < n; ++v) {
    auto normal = scene.discs.row(v).head<3>();
    if (normal.norm() > 0)
      normal.normalize();
    else
      normal = scene.towards_eye.value_or(Vec3::UnitZ()).normalized().transpose();
    if (!(scene.discs(v, 3) > 0)) scene.discs(v, 3) = scene.points.row(v).allFinite() ? usual : 0;
  }
}

Scene discs_as_triangles(const Scene& scene) {
  constexpr int rim = disc_corners;
  Scene out = scene;
  const Eigen::Index n = scene.points.rows();
  const bool valued = scene.values.size() > 0;
  const MatX3 slope = valued ? mean_gradients(scene, scene.values) : MatX3();
  const bool regions = field_style(scene).discrete;
  out.points.resize(rim * n, 3);
  out.triangles.resize((rim - 2) * n, 3);
  out.values.resize(valued ? rim * n : 0);
  out.weights.resize(0);
  out.inner_sides.clear();
  out.faces.clear();
  out.more.clear();
  for (Eigen::Index v = 0; v < n; ++v) {
    const Vec3 normal = scene.discs.row(v).head<3>(), a = normal.unitOrthogonal();
    const Vec3 b = normal.cross(a), p = scene.points.row(v);
    for (int k = 0; k < rim; ++k) {
      const double angle = 2 * std::numbers::pi * k / rim;
      const Vec3 away = scene.discs(v, 3) * (std::cos(angle) * a + std::sin(angle) * b);
      const Eigen::Index i = rim * v + k;
      out.points.row(i) = (p + away).transpose();
      if (valued) {
        out.values[i] = scene.values[v];
        if (!regions && std::isfinite(scene.values[v])) out.values[i] += slope.row(v).dot(away);
      }
    }
    for (int k = 0; k < rim - 2; ++k) {
      const int i = static_cast<int>(rim * v);
      out.triangles.row((rim - 2) * v + k) << i, i + k + 1, i + k + 2;
    }
  }
  return out;
}

}  // namespace littoral::io
