#include "io/render/openness.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"

namespace littoral::io {

namespace {

constexpr int directions = 64;
constexpr float nothing = -std::numeric_limits<float>::infinity();

// Evenly spread, along a spiral from pole to pole.
Vec3 direction(int i) {
  const double z = 1 - (2 * i + 1.0) / directions, r = std::sqrt(1 - z * z);
  const double angle = i * 3.14159265358979323846 * (3 - std::sqrt(5.0));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

// How far up, towards the sky, the highest surface is at each pixel; all in pixels.
class HeightMap {
 public:
  explicit HeightMap(int side)
      : side_(side), heights_(std::size_t(side) * std::size_t(side), nothing) {}

  void add(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
    const auto [left, right] = std::minmax({a[0], b[0], c[0]});
    const auto [below, above] = std::minmax({a[1], b[1], c[1]});
    const int x0 = first(left), x1 = last(right), y0 = first(below), y1 = last(above);
    if (x0 > x1 || y0 > y1) return;  // between the middles of pixels, as most small ones are
    const float area = cross(a, b, c);
    if (!(std::abs(area) > 1e-12f)) return;
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const Eigen::Vector3f p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0);
        const float u = cross(p, b, c) / area, v = cross(a, p, c) / area, w = 1 - u - v;
        if (u < -1e-5f || v < -1e-5f || w < -1e-5f) continue;
        float& height = at(x, y);
        height = std::max(height, u * a[2] + v * b[2] + w * c[2]);
      }
    }
  }

  // Takes the lowest of each pixel and its neighbours: then nothing that is flat hides itself.
  void lower() {
    std::vector<float> row(side_);
    for (const bool across : {true, false}) {
      for (int j = 0; j < side_; ++j) {
        const auto item = [&](int i) -> float& { return across ? at(i, j) : at(j, i); };
        for (int i = 0; i < side_; ++i) row[i] = item(i);
        for (int i = 0; i < side_; ++i) {
          const auto before = std::size_t(std::max(0, i - 1));
          const auto after = std::size_t(std::min(side_ - 1, i + 1));
          item(i) = std::min({row[before], row[i], row[after]});
        }
      }
    }
  }

  bool seen(const Eigen::Vector3f& p) const {
    const int x = std::clamp(static_cast<int>(p[0]), 0, side_ - 1);
    const int y = std::clamp(static_cast<int>(p[1]), 0, side_ - 1);
    return p[2] >= heights_[index(x, y)] - 1;
  }

 private:
  static float cross(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  }
  // Of pixels whose middle is not before, not behind a place x > 0.
  static int first(float x) { return static_cast<int>(x + 0.5f); }
  int last(float x) const { return std::min(side_ - 1, static_cast<int>(x + 0.5f) - 1); }
  std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(side_) + std::size_t(x);
  }
  float& at(int x, int y) { return heights_[index(x, y)]; }

  int side_;
  std::vector<float> heights_;
};

}  // namespace

Openness openness(const MatX3& points, const MatX3i& triangles) {
  const auto n = std::size_t(points.rows());
  Openness out = Openness::Zero(points.rows(), 4);
  out.col(3).setOnes();
  std::vector<char> used(n, 0);
  Vec3 low = Vec3::Constant(infinity), high = -low;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = points.row(triangles(t, k));
      used[triangles(t, k)] = 1;
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  const Vec3 centre = 0.5 * low + 0.5 * high;
  double size = 0;  // of the ball about all
  for (std::size_t v = 0; v < n; ++v)
    if (used[v]) size = std::max(size, (points.row(index(v)).transpose() - centre).norm());
  if (!(size > 0) || !std::isfinite(size)) return out;
  const int side = n < 50'000 ? 256 : 512;
  const double scale = 0.5 * (side - 4) / size;
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
  const Rows scaled = (scale * (points.rowwise() - centre.transpose())).cast<float>();

  std::vector<std::vector<char>> seen(directions);
  parallel_for(directions, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 up = direction(static_cast<int>(i)), across = up.unitOrthogonal();
      Eigen::Matrix3d axes;
      axes << across, up.cross(across), up;
      Rows p(points.rows(), 3);
      p.noalias() = scaled * axes.cast<float>();
      p.leftCols<2>().array() += 0.5f * static_cast<float>(side);
      HeightMap map(side);
      for (Eigen::Index t = 0; t < triangles.rows(); ++t)
        map.add(p.row(triangles(t, 0)), p.row(triangles(t, 1)), p.row(triangles(t, 2)));
      map.lower();
      seen[i].resize(n);
      for (std::size_t v = 0; v < n; ++v)
        if (used[v]) seen[i][v] = map.seen(p.row(index(v)));
    }
  });

  for (std::size_t v = 0; v < n; ++v) {
    if (!used[v]) continue;
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();  // 3 (mean of d), mean of 1
    for (int i = 0; i < directions; ++i) {
      if (!seen[i][v]) continue;
      sum += Eigen::Vector4d(0, 0, 0, 1);
      sum.head<3>() += 3 * direction(i);
    }
    out.row(index(v)) = (sum / directions).cast<float>().transpose();
  }
  return out;
}

float open_part(const Eigen::Vector4f& openness, const Vec3& normal) {
  const float part = openness[3] + openness.head<3>().dot(normal.cast<float>()) * 2 / 3;
  return std::clamp(part, 0.f, 1.f);
}

}  // namespace littoral::io
