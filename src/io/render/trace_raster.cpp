#include "io/render/trace_raster.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/index.h"

namespace littoral::io {

TraceRaster::TraceRaster(const Scene& scene, Openness open, const Camera& camera,
                         const FieldStyle& style, int samples)
    : trace_(scene.trace.get()), open_(std::move(open)), camera_(camera), samples_(samples) {
  if (trace_ && trace_->triangles.rows() > 0 && open_.rows() > 0)
    near_.emplace(scene.points, trace_->triangles);
  const Rgb rgb = trace_ && style.present ? value_colour(style, trace_->level) : plain_colour;
  colour_ = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
}

TraceRaster::Seen TraceRaster::look(double x, double y) const {
  const Vec3 eye = camera_.eye();
  const Vec3 to = camera_.unproject(x, y, 1) - eye;  // per unit of w
  const double length = to.norm();
  const Vec3 direction = to / length;
  double from = 0, end = infinity;
  for (int a = 0; a < 3; ++a) {
    const double one = (trace_->low[a] - eye[a]) / direction[a];
    const double two = (trace_->high[a] - eye[a]) / direction[a];
    if (direction[a] == 0) {
      if (eye[a] < trace_->low[a] || eye[a] > trace_->high[a]) return {};
      continue;
    }
    from = std::max(from, std::min(one, two));
    end = std::min(end, std::max(one, two));
  }
  if (!(from < end)) return {};
  const double pixel = samples_ * camera_.radius * (from / length) / camera_.focal;
  Vec3 normal;
  const double t = trace_->hit(eye, direction, from, end, pixel, normal);
  if (!std::isfinite(t)) return {};
  Seen seen{length / t, camera_.to_eye * normal};
  if (near_) {
    const Vec3 towards = normal.dot(direction) > 0 ? Vec3(-normal) : normal;
    const NearestPoint nearest = near_->closest_point(eye + t * direction);
    Eigen::Vector4f open = Eigen::Vector4f::Zero();
    for (int k = 0; k < 3; ++k)
      open += static_cast<float>(nearest.barycentric[k]) *
              open_.row(trace_->triangles(nearest.face, k)).transpose();
    seen.lit = occlusion(open, towards);
  }
  return seen;
}

void TraceRaster::put(const Seen& seen, int x, int y, Band& band) const {
  const std::size_t i = band.at(x, y);
  if (!(seen.nearness > band.nearness[i])) return;
  band.nearness[i] = seen.nearness;
  band.colour[i] = colour_ * (seen.lit * brightness(camera_, seen.normal, x + 0.5, y + 0.5));
}

void TraceRaster::draw(Band& band) const {
  if (trace_ == nullptr) return;
  const int columns = band.width / samples_, rows = (band.y1 - band.y0) / samples_;
  std::vector<Seen> seen(std::size_t(columns) * std::size_t(rows));
  const auto at = [&](int i, int j) -> Seen& {
    return seen[std::size_t(j) * std::size_t(columns) + std::size_t(i)];
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      at(i, j) = look((i + 0.5) * samples_, band.y0 + (j + 0.5) * samples_);
  const auto alike = [](const Seen& a, const Seen& b) {
    if ((a.nearness > 0) != (b.nearness > 0)) return false;
    if (!(a.nearness > 0)) return true;
    return a.normal.dot(b.normal) > 0.97 &&
           std::abs(a.nearness - b.nearness) < 0.02 * std::max(a.nearness, b.nearness);
  };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      bool even = true;  // the first and last row of a band lack a neighbour and are refined
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di) {
          const int ni = std::clamp(i + di, 0, columns - 1), nj = j + dj;
          even = even && nj >= 0 && nj < rows && alike(at(i, j), at(ni, nj));
        }
      if (even && !(at(i, j).nearness > 0)) continue;
      for (int sj = 0; sj < samples_; ++sj) {
        for (int si = 0; si < samples_; ++si) {
          const int x = i * samples_ + si, y = band.y0 + j * samples_ + sj;
          put(even || samples_ == 1 ? at(i, j) : look(x + 0.5, y + 0.5), x, y, band);
        }
      }
    }
  }
}

}  // namespace littoral::io
