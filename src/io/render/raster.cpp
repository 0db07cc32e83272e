#include "io/render/raster.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.h"
#include "base/parallel.h"

namespace littoral::io {

namespace {

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Twice the signed area of a, b, p in the picture.
double side(const Vec3& a, const Vec3& b, double x, double y) {
  return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

}  // namespace

MatX3 unsigned_normals(const MatX3& points, const MatX3i& triangles, double length_scale) {
  const Eigen::Index n = triangles.rows();
  MatX3 area(n, 3), largest = MatX3::Zero(points.rows(), 3);
  for (Eigen::Index t = 0; t < n; ++t) {
    const Vec3 a = points.row(triangles(t, 0)) / length_scale;
    const Vec3 b = points.row(triangles(t, 1)) / length_scale;
    const Vec3 c = points.row(triangles(t, 2)) / length_scale;
    area.row(t) = (b - a).cross(c - a).transpose();
    for (int k = 0; k < 3; ++k) {
      auto best = largest.row(triangles(t, k));
      if (area.row(t).squaredNorm() > best.squaredNorm()) best = area.row(t);
    }
  }
  MatX3 normals = MatX3::Zero(points.rows(), 3);
  for (Eigen::Index t = 0; t < n; ++t) {
    for (int k = 0; k < 3; ++k) {
      const int v = triangles(t, k);
      normals.row(v) += (area.row(t).dot(largest.row(v)) < 0 ? -1.0 : 1.0) * area.row(t);
    }
  }
  normals.rowwise().normalize();
  // Creases stay: where a face leans more than 40 degrees from the mean, there is no common normal.
  std::vector<bool> crease(std::size_t(points.rows()), false);
  for (Eigen::Index t = 0; t < n; ++t) {
    const double size = area.row(t).norm();
    for (int k = 0; k < 3; ++k) {
      const int v = triangles(t, k);
      if (std::abs(area.row(t).dot(normals.row(v))) < 0.766 * size) {
        crease[v] = true;
      }
    }
  }
  for (Eigen::Index v = 0; v < normals.rows(); ++v) {
    if (crease[v] || !normals.row(v).allFinite()) {
      normals.row(v).setZero();
    }
  }
  return normals;
}

Vec3 gradient_in_triangle(const Vec3& u, const Vec3& v, double p, double q) {
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
  const double area2 = uu * vv - uv * uv;
  if (!(area2 > 1e-14 * uu * vv) || !std::isfinite(p) || !std::isfinite(q)) return Vec3::Zero();
  return ((vv * p - uv * q) * u + (uu * q - uv * p) * v) / area2;
}

Eigen::Matrix<double, Eigen::Dynamic, 6> slope_tensors(const MatX3& points, const MatX3i& triangles,
                                                       const VecX& values, double length_scale) {
  Eigen::Matrix<double, Eigen::Dynamic, 6> sum;
  sum.setZero(points.rows(), 6);
  VecX weight = VecX::Zero(points.rows());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Vec3 a = points.row(triangles(t, 0));
    const Vec3 u = (Vec3(points.row(triangles(t, 1))) - a) / length_scale;
    const Vec3 v = (Vec3(points.row(triangles(t, 2))) - a) / length_scale;
    const double p = values[triangles(t, 1)] - values[triangles(t, 0)];
    const double q = values[triangles(t, 2)] - values[triangles(t, 0)];
    const double area = u.cross(v).norm();
    if (!(area > 0)) continue;
    const Vec3 g = gradient_in_triangle(u, v, p, q);
    for (int k = 0; k < 3; ++k) {
      const int i = triangles(t, k);
      sum.row(i) += area * Eigen::Matrix<double, 1, 6>{{g[0] * g[0], g[1] * g[1], g[2] * g[2],
                                                        g[0] * g[1], g[0] * g[2], g[1] * g[2]}};
      weight[i] += area;
    }
  }
  for (Eigen::Index i = 0; i < sum.rows(); ++i)
    if (weight[i] > 0) sum.row(i) /= weight[i];
  return sum;
}

float brightness(const Camera& camera, const Vec3& normal, double x, double y) {
  const Vec3 eye =
      Vec3((camera.cx - x) / camera.focal, (y - camera.cy) / camera.focal, 1).normalized();
  static const Vec3 lamp = Vec3(-0.25, 0.35, 1).normalized();
  const double turn = normal.dot(eye) < 0 ? -1 : 1;
  const double light = std::max(0.0, turn * normal.dot(lamp)) / lamp[2];
  return static_cast<float>(std::min(1.06, 0.5 + 0.5 * light));
}

SurfaceRaster::SurfaceRaster(const Scene& scene, Openness open, const Camera& camera,
                             const FieldStyle& style, double scale, int height, int rows)
    : scene_(scene),
      open_(std::move(open)),
      camera_(camera),
      style_(style),
      levels_(scene.levels),
      scale_(scale) {
  std::sort(levels_.begin(), levels_.end());
  screen_ = MatX3::Zero(scene.points.rows(), 3);
  parallel_for(std::size_t(scene.points.rows()), 8192, [&](std::size_t begin, std::size_t end) {
    for (auto v = index(begin); v < index(end); ++v) {
      screen_.row(v) = camera.project(scene.points.row(v)).transpose();
    }
  });
  normals_ = unsigned_normals(scene.points, scene.triangles, camera.radius);
  if (style.present && !style.discrete)
    slopes_ = slope_tensors(scene.points, scene.triangles, scene.values, camera.radius);

  const int bands = (height + rows - 1) / rows;
  const auto touched = [&](Eigen::Index t) {
    double low = screen_(scene.triangles(t, 0), 1), high = low;
    for (int k = 1; k < 3; ++k) {
      low = std::min(low, screen_(scene.triangles(t, k), 1));
      high = std::max(high, screen_(scene.triangles(t, k), 1));
    }
    const double first = std::clamp(low / rows, 0.0, bands - 1.0);
    return std::pair<int, int>(static_cast<int>(first),
                               static_cast<int>(std::clamp(high / rows, first, bands - 1.0)));
  };
  band_offsets_.assign(std::size_t(bands) + 1, 0);
  for (Eigen::Index t = 0; t < scene.triangles.rows(); ++t) {
    const auto [first, last] = touched(t);
    for (int b = first; b <= last; ++b) ++band_offsets_[std::size_t(b) + 1];
  }
  for (std::size_t b = 0; b < std::size_t(bands); ++b) {
    band_offsets_[b + 1] += band_offsets_[b];
  }
  band_triangles_.resize(std::size_t(band_offsets_.back()));
  std::vector<int> next(band_offsets_.begin(), band_offsets_.end() - 1);
  for (Eigen::Index t = 0; t < scene.triangles.rows(); ++t) {
    const auto [first, last] = touched(t);
    for (int b = first; b <= last; ++b) {
      band_triangles_[next[b]++] = static_cast<int>(t);
    }
  }
}

void SurfaceRaster::draw(int b, Band& band) const {
  std::vector<int> owner(band.nearness.size(), -1);
  for (int i = band_offsets_[b]; i < band_offsets_[std::size_t(b) + 1]; ++i) {
    cover(band_triangles_[i], band, owner);
  }
  for (int y = band.y0; y < band.y1; ++y) {
    for (int x = 0; x < band.width; ++x) {
      const std::size_t i = band.at(x, y);
      if (owner[i] >= 0) band.colour[i] = shade(owner[i], x + 0.5, y + 0.5);
    }
  }
}

void SurfaceRaster::cover(int t, Band& band, std::vector<int>& owner) const {
  Vec3 p[3];
  for (int k = 0; k < 3; ++k) p[k] = screen_.row(scene_.triangles(t, k));
  double area = side(p[0], p[1], p[2][0], p[2][1]);
  if (area < 0) {
    std::swap(p[1], p[2]);
    area = -area;
  }
  if (!(area > 1e-12)) return;
  const double low = std::min({p[0][1], p[1][1], p[2][1]});
  const double high = std::max({p[0][1], p[1][1], p[2][1]});
  const int first = static_cast<int>(std::max<double>(band.y0, std::ceil(low - 0.5)));
  const int last = static_cast<int>(std::min<double>(band.y1 - 1, std::floor(high - 0.5)));
  for (int y = first; y <= last; ++y) {
    // The row's part of the triangle: left of all three sides, a hair more so that no sample on a
    // common side is lost to rounding.
    double from = 0.5, to = band.width - 0.5;
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = p[k], &b = p[(k + 1) % 3];
      const double rise = b[1] - a[1];
      const double offset = (b[0] - a[0]) * (y + 0.5 - a[1]);
      if (rise == 0) {
        if (offset < -1e-9) to = -1;
        continue;
      }
      const double x = a[0] + offset / rise;
      if (rise > 0) {
        to = std::min(to, x + 1e-9);
      } else {
        from = std::max(from, x - 1e-9);
      }
    }
    const int end = static_cast<int>(std::floor(to - 0.5));
    for (int x = static_cast<int>(std::ceil(from - 0.5)); x <= end; ++x) {
      const double b1 = side(p[2], p[0], x + 0.5, y + 0.5) / area;
      const double b2 = side(p[0], p[1], x + 0.5, y + 0.5) / area;
      const double near = (1 - b1 - b2) / p[0][2] + b1 / p[1][2] + b2 / p[2][2];
      const std::size_t i = band.at(x, y);
      if (near > band.nearness[i]) {
        band.nearness[i] = near;
        owner[i] = t;
      }
    }
  }
}

Eigen::Vector3f SurfaceRaster::shade(int t, double x, double y) const {
  Vec3 p[3], q[3];
  int v[3];
  for (int k = 0; k < 3; ++k) {
    v[k] = scene_.triangles(t, k);
    p[k] = screen_.row(v[k]);
    q[k] = scene_.points.row(v[k]) / camera_.radius;
  }
  const double area = side(p[0], p[1], p[2][0], p[2][1]);
  double b[3], weight = 0;  // barycentric in the picture over w: linear in space once normalised
  for (int k = 0; k < 3; ++k) {
    b[k] = side(p[(k + 1) % 3], p[(k + 2) % 3], x, y) / area / p[k][2];
    weight += b[k];
  }

  Vec3 flat = (q[1] - q[0]).cross(q[2] - q[0]);
  if (flat.norm() > 0) flat.normalize();
  Vec3 smooth = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vec3 n = normals_.row(v[k]);
    smooth += b[k] / weight * (n.isZero() ? flat : n.dot(flat) < 0 ? Vec3(-n) : n);
  }
  const double part[3] = {b[0] / weight, b[1] / weight, b[2] / weight};
  const Vec3 shown = scene_.shading == Shading::flat ? flat : smooth.normalized();
  const float lit = brightness(camera_, camera_.to_eye * shown, x, y) * opening(t, part, shown);

  const auto unreachable = [&] {  // hatched, so that it is no colour of the map
    const double stripe = (x - y) / (9 * scale_);
    const float shade = stripe - std::floor(stripe) < 0.3 ? 0.72f : 1.f;
    return Eigen::Vector3f(as_vector(infinite_colour) * (lit * shade));
  };
  if (!style_.present)
    return scene_.values.size() ? unreachable() : Eigen::Vector3f(as_vector(plain_colour) * lit);
  // How much the corners count in the field; they count alike in a face without one that does.
  double counts[3] = {1, 1, 1}, total = 0;
  if (scene_.weights.size())
    for (int k = 0; k < 3; ++k) counts[k] = scene_.weights[v[k]];
  for (int k = 0; k < 3; ++k) total += counts[k] * b[k];
  if (!(total > 0)) {
    counts[0] = counts[1] = counts[2] = 1;
    total = weight;
  }
  double value = 0;
  for (int k = 0; k < 3; ++k)
    if (counts[k] > 0) value += counts[k] * b[k] / total * scene_.values[v[k]];
  if (!std::isfinite(value)) return unreachable();
  Eigen::Vector3f colour = as_vector(value_colour(style_, value));
  if (style_.discrete) return colour * lit;
  // Slope of the value per sample: value = N / D with N = sum c b v, D = sum c b linear in the
  // picture, where corners count c.
  double slope_x = 0, slope_y = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3 &a = p[(k + 1) % 3], &c = p[(k + 2) % 3];
    if (counts[k] == 0) continue;
    const double rest = counts[k] * (scene_.values[v[k]] - value) / (area * p[k][2] * total);
    slope_x -= (c[1] - a[1]) * rest;
    slope_y += (c[0] - a[0]) * rest;
  }
  double slope = std::hypot(slope_x, slope_y);
  // Where gradients at vertices are known, the slope is interpolated from them: then it is the same
  // on both sides of an edge, and lines have no seam there. At creases and corners of weight, the
  // triangle's.
  double known = 0;
  for (int k = 0; k < 3; ++k) {
    known += part[k] * normals_.row(v[k]).squaredNorm();
    if (counts[k] < 0.999) known = -1e9;
  }
  if (known > 0) {
    const double mean = mean_slope(t, part, smooth.normalized(), x, y);
    // Where the field has a kink, or is level, the triangle knows better.
    slope += known * known * (std::clamp(mean, 0.6 * slope, 1.7 * slope) - slope);
  }
  bool zero = false;
  const auto ink = static_cast<float>(line_strength(value, slope, zero));
  const float luminance = colour.dot(Eigen::Vector3f(0.30f, 0.59f, 0.11f));
  colour *= lit;
  const Eigen::Vector3f line =
      zero || luminance > 90 ? Eigen::Vector3f(18, 20, 28) : Eigen::Vector3f(235, 238, 245);
  return colour + ink * (line - colour);
}

float SurfaceRaster::opening(int t, const double* part, const Vec3& normal) const {
  if (open_.rows() == 0) return 1;
  Eigen::Vector4f open = Eigen::Vector4f::Zero();
  Vec3 place = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const int v = scene_.triangles(t, k);
    open += static_cast<float>(part[k]) * open_.row(v).transpose();
    place += part[k] * scene_.points.row(v).transpose();
  }
  const bool away = normal.dot(camera_.eye() - place) < 0;
  return occlusion(open, away ? Vec3(-normal) : normal);
}

double SurfaceRaster::mean_slope(int t, const double* part, const Vec3& normal, double x,
                                 double y) const {
  Eigen::Matrix<double, 6, 1> m = Eigen::Matrix<double, 6, 1>::Zero();
  Vec3 place = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const int v = scene_.triangles(t, k);
    m += part[k] * slopes_.row(v).transpose();
    place += part[k] * scene_.points.row(v).transpose();
  }
  // The places of the tangent plane one sample to the right and one down, relative to this one, in
  // units of the radius.
  const Vec3 from = (place - camera_.eye()) / camera_.radius;
  double facing = normal.dot(from);
  facing = (facing < 0 ? -1 : 1) * std::max(std::abs(facing), 0.08 * from.norm());
  const double depth = camera_.project(place)[2];
  const Vec3 here = camera_.unproject(x, y, depth);
  double sum = 0;
  for (const Vec3& there :
       {camera_.unproject(x + 1, y, depth), camera_.unproject(x, y + 1, depth)}) {
    const Vec3 step = (there - here) / camera_.radius;
    const Vec3 d = step - from * (normal.dot(step) / facing);
    sum += m[0] * d[0] * d[0] + m[1] * d[1] * d[1] + m[2] * d[2] * d[2] +
           2 * (m[3] * d[0] * d[1] + m[4] * d[0] * d[2] + m[5] * d[1] * d[2]);
  }
  return std::sqrt(std::max(0.0, sum));
}

double SurfaceRaster::line_strength(double value, double slope, bool& zero) const {
  if (!(slope > 1e-9 * (style_.high - style_.low))) return 0;  // less is rounding
  const auto ink = [&](double level, double width, double strength) {
    const double away = std::abs(value - level) / slope / scale_;  // pixels
    return strength * std::clamp(0.5 * width + 0.5 - away, 0.0, 1.0);
  };
  double strength = 0;
  if (style_.spacing > 0) {
    const double level = std::round(value / style_.spacing) * style_.spacing;
    // Where a field is as small or large as it gets, it may be so all over: no lines of rounding.
    const double margin = 1e-6 * (style_.high - style_.low);
    if (level > style_.low + margin && level < style_.high - margin)
      strength = ink(level, 1.0, 0.6) * smooth_step(2, 5, style_.spacing / slope / scale_);
  } else if (!levels_.empty()) {
    const auto above = std::lower_bound(levels_.begin(), levels_.end(), value);
    if (above != levels_.end()) strength = ink(*above, 1.0, 0.6);
    if (above != levels_.begin()) strength = std::max(strength, ink(*(above - 1), 1.0, 0.6));
  }
  const bool wanted = levels_.empty() ? style_.spacing > 0
                                      : std::binary_search(levels_.begin(), levels_.end(), 0.0);
  if (style_.diverging && wanted) {
    const double main = ink(0, 2.6, 0.95);
    zero = main > strength;
    strength = std::max(strength, main);
  }
  return strength;
}

}  // namespace littoral::io
