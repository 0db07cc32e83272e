#include <algorithm>
#include <cmath>

#include "io/render/raster.h"

namespace littoral::io {

namespace {

struct Nearest {
  double distance;  // samples; negative inside
  double along;     // 0 at the first point, 1 at the second
};

Nearest to_segment(const Vec3& a, const Vec3& b, double x, double y) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], length2 = dx * dx + dy * dy;
  double t = 0;
  if (length2 > 0) t = std::clamp(((x - a[0]) * dx + (y - a[1]) * dy) / length2, 0.0, 1.0);
  return {std::hypot(x - a[0] - t * dx, y - a[1] - t * dy), t};
}

}  // namespace

MarkRaster::MarkRaster(const Scene& scene, const Camera& camera, double scale) : scale_(scale) {
  const SourceMarks marks = source_marks(scene, camera.radius);
  for (const auto& stroke : marks.strokes) {
    const Vec3 a = camera.project(stroke.a), b = camera.project(stroke.b);
    marks_.push_back({{a, b, b},
                      false,
                      1.8 * scale,
                      as_vector(stroke.is_signed ? signed_colour : unsigned_colour)});
  }
  for (const auto& arrow : marks.arrows) {
    const Vec3 base = camera.project(arrow.base), tip = camera.project(arrow.tip);
    Vec2 across(base[1] - tip[1], tip[0] - base[0]);
    if (!(across.norm() > 1e-9)) continue;
    const double size = (arrow.tip - arrow.base).norm() / camera.radius;
    across *= 0.32 * size * camera.focal / base[2] / across.norm();
    const Vec3 half(across[0], across[1], 0);
    marks_.push_back({{tip, base + half, base - half}, true, 0, as_vector(signed_colour)});
  }
  for (Eigen::Index i = 0; i < scene.source_points.rows(); ++i) {
    const Vec3 p = camera.project(scene.source_points.row(i));
    marks_.push_back({{p, p, p}, false, 5.5 * scale, as_vector(unsigned_colour)});
  }
}

void MarkRaster::draw(Band& band) const {
  const Eigen::Vector3f paper(255, 255, 255);
  for (const Mark& mark : marks_) {
    Mark rim = mark;
    rim.colour = paper;
    draw(rim, 1.1 * scale_, false, band);
  }
  for (const Mark& mark : marks_) draw(mark, 0, true, band);
}

void MarkRaster::draw(const Mark& mark, double rim, bool core, Band& band) const {
  const Vec3* p = mark.p;
  const double margin = mark.reach + rim + 1;
  const double low = std::min({p[0][1], p[1][1], p[2][1]}) - margin;
  const double high = std::max({p[0][1], p[1][1], p[2][1]}) + margin;
  const double left = std::min({p[0][0], p[1][0], p[2][0]}) - margin;
  const double right = std::max({p[0][0], p[1][0], p[2][0]}) + margin;
  if (high < band.y0 || low > band.y1 || right < 0 || left > band.width) return;
  const int y_end = static_cast<int>(std::min<double>(band.y1, high));
  const int x_end = static_cast<int>(std::min<double>(band.width, right));
  // Marks lie on the surface: lift them so that their thickness does not sink into it.
  constexpr double lift = 0.02;
  for (int y = static_cast<int>(std::max<double>(band.y0, low)); y < y_end; ++y) {
    for (int x = static_cast<int>(std::max(0.0, left)); x < x_end; ++x) {
      Nearest near = to_segment(p[0], p[1], x + 0.5, y + 0.5);
      if (mark.head) {
        const Nearest other[2] = {to_segment(p[1], p[2], x + 0.5, y + 0.5),
                                  to_segment(p[2], p[0], x + 0.5, y + 0.5)};
        bool left_of[3];
        for (int k = 0; k < 3; ++k) {
          const Vec3 &a = p[k], &b = p[(k + 1) % 3];
          left_of[k] = (b[0] - a[0]) * (y + 0.5 - a[1]) > (b[1] - a[1]) * (x + 0.5 - a[0]);
        }
        near.distance = std::min({near.distance, other[0].distance, other[1].distance});
        if (left_of[0] == left_of[1] && left_of[1] == left_of[2]) near.distance *= -1;
      }
      if (near.distance > mark.reach + rim) continue;
      const double w = p[0][2] + near.along * (p[1][2] - p[0][2]) - lift;
      const std::size_t i = band.at(x, y);
      if (1 / w < band.nearness[i]) continue;
      band.colour[i] = mark.colour;
      if (core) band.nearness[i] = 1 / w;
    }
  }
}

}  // namespace littoral::io
