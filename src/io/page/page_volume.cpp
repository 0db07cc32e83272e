#include <algorithm>
#include <cmath>
#include <cstdint>

#include "io/page/page_parts.h"

namespace littoral::io {

namespace {

using nlohmann::json;

// Where a value lies from low to high, 0 to 1.
double part_of(double value, double low, double high) {
  const double half = 0.5 * high - 0.5 * low;
  return half > 0 ? std::clamp((0.5 * value - 0.5 * low) / half, 0.0, 1.0) : 0.0;
}

// Values in 65534 steps from low to high; 65535 is infinite.
std::string steps_text(const VecX& values, double low, double high) {
  std::vector<std::uint16_t> steps;
  steps.reserve(std::size_t(values.size()));
  for (const double value : values)
    steps.push_back(static_cast<std::uint16_t>(
        std::isfinite(value) ? std::lround(65534 * part_of(value, low, high)) : 65535));
  return base64(steps);
}

// A cloud in the page's units.
json cloud_json(const TracedCloud& cloud, const SceneFrame& frame) {
  std::vector<float> numbers;
  numbers.reserve(std::size_t(cloud.tori.size()));
  for (Eigen::Index i = 0; i < cloud.tori.rows(); ++i) {
    for (int k = 0; k < 16; ++k) {
      const double x = cloud.tori(i, k);
      const bool place = k < 3 || (k >= 4 && k < 7), curvature = k == 11 || k == 15;
      const double scaled = place       ? (x - frame.centre[k % 4]) / frame.radius
                            : curvature ? x * frame.radius
                            : k == 3    ? x / frame.radius
                                        : x;
      constexpr double most = 1e30;  // a lone point's plane has an infinite patch
      numbers.push_back(static_cast<float>(std::clamp(scaled, -most, most)));
    }
  }
  json out = {{"operation", cloud.operation}, {"tori", base64(numbers)}};
  if (cloud.samples.size() > 0) {
    const double low = cloud.samples.minCoeff(), high = cloud.samples.maxCoeff();
    out["low"] = low / frame.radius;
    out["range"] = high / frame.radius - low / frame.radius;
    out["values"] = steps_text(cloud.samples, low, high);
  }
  return out;
}

}  // namespace

json volume_json(const SceneVolume& volume, const SceneFrame& frame, const FieldStyle& style) {
  const Grid& grid = volume.thin.grid;
  const Vec3 low = grid.origin, high = grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1);
  const Vec3 origin = (low - frame.centre) / frame.radius, spacing = grid.spacing / frame.radius;
  const auto triple = [](const Vec3& v) { return json{v[0], v[1], v[2]}; };
  return {{"n", grid.n},
          {"origin", triple(origin)},
          {"spacing", triple(spacing)},
          {"low", triple(low)},
          {"high", triple(high)},
          {"values", steps_text(volume.thin.values, style.low, style.high)},
          {"axis", volume.axis},
          {"position", volume.position},
          {"level", part_of(volume.level, style.low, style.high)},
          {"isosurface", volume.isosurface}};
}

json trace_json(const SceneTrace& trace, const SceneFrame& frame, const FieldStyle& style) {
  json clouds = json::array();
  for (const TracedCloud& cloud : trace.clouds) clouds.push_back(cloud_json(cloud, frame));
  return {{"clouds", clouds},
          {"blend", trace.blend / frame.radius},
          {"offset", trace.offset / frame.radius},
          {"steepness", trace.steepness},
          {"low", style.low / frame.radius},
          {"range", style.high / frame.radius - style.low / frame.radius}};
}

}  // namespace littoral::io
