#include "io/render/scene_style.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace littoral::io {

namespace {

struct Stop {
  double at;
  int r, g, b;
};

// Interpolated in the OKLab space, where equal steps look equal (B. Ottosson, "A perceptual color
// space for image processing", 2020).
Vec3 to_oklab(const Stop& stop) {
  const auto linear = [](int byte) {
    const double c = byte / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  const double r = linear(stop.r), g = linear(stop.g), b = linear(stop.b);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

Rgb from_oklab(const Vec3& lab) {
  const double l = std::pow(lab[0] + 0.3963377774 * lab[1] + 0.2158037573 * lab[2], 3);
  const double m = std::pow(lab[0] - 0.1055613458 * lab[1] - 0.0638541728 * lab[2], 3);
  const double s = std::pow(lab[0] - 0.0894841775 * lab[1] - 1.2914855480 * lab[2], 3);
  const auto byte = [](double c) {
    c = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    return static_cast<unsigned char>(std::lround(255 * std::clamp(c, 0.0, 1.0)));
  };
  return {byte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          byte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          byte(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

std::array<Rgb, 256> blend(const std::vector<Stop>& stops) {
  std::array<Rgb, 256> map;
  for (int i = 0; i < 256; ++i) {
    const double x = i / 255.0;
    std::size_t k = 1;
    while (k + 1 < stops.size() && stops[k].at < x) ++k;
    const double t = (x - stops[k - 1].at) / (stops[k].at - stops[k - 1].at);
    const Vec3 lab = (1 - t) * to_oklab(stops[k - 1]) + t * to_oklab(stops[k]);
    map[static_cast<std::size_t>(i)] = from_oklab(lab);
  }
  return map;
}

}  // namespace

const std::array<Rgb, 256>& colour_map(ColourMap map) {
  static const std::array<Rgb, 256> two = blend({{0, 28, 52, 120},
                                                 {0.22, 52, 118, 190},
                                                 {0.40, 150, 196, 226},
                                                 {0.5, 246, 244, 238},
                                                 {0.60, 246, 196, 138},
                                                 {0.78, 222, 116, 48},
                                                 {1, 132, 38, 16}});
  static const std::array<Rgb, 256> one = blend({{0, 254, 248, 205},
                                                 {0.25, 168, 219, 170},
                                                 {0.5, 74, 168, 178},
                                                 {0.75, 52, 106, 164},
                                                 {1, 48, 44, 112}});
  static const std::array<Rgb, 256> grey = blend({{0, 245, 245, 245}, {1, 40, 40, 40}});
  static const std::array<Rgb, 256> heat = blend({{0, 20, 12, 30},
                                                  {0.35, 130, 24, 60},
                                                  {0.65, 226, 92, 32},
                                                  {0.85, 248, 186, 60},
                                                  {1, 255, 252, 220}});
  switch (map) {
    case ColourMap::diverging:
      return two;
    case ColourMap::grey:
      return grey;
    case ColourMap::heat:
      return heat;
    case ColourMap::automatic:
    case ColourMap::sequential:
      break;
  }
  return one;
}

FieldStyle field_style(const Scene& scene) {
  FieldStyle style;
  if (scene.values.size() == 0) return style;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (Eigen::Index i = 0; i < scene.triangles.size(); ++i) {
    const double value = scene.values[scene.triangles.data()[i]];
    if (std::isfinite(value)) {
      low = std::min(low, value);
      high = std::max(high, value);
    } else {
      style.infinite = true;
    }
  }
  if (scene.volume) {
    low = scene.volume->low;
    high = scene.volume->high;
    style.infinite = scene.volume->infinite;
  }
  if (low > high) return style;
  style.present = true;
  style.low = low;
  style.high = high;
  // A trace of negative values, as a solver leaves around zero, does not make a signed field.
  const double reach = std::max(std::abs(low), std::abs(high));
  style.diverging = scene.colour_map == ColourMap::automatic
                        ? low < -0.01 * reach
                        : scene.colour_map == ColourMap::diverging;
  style.map = scene.colour_map != ColourMap::automatic ? scene.colour_map
              : style.diverging                        ? ColourMap::diverging
                                                       : ColourMap::sequential;
  style.colour_low = style.diverging ? -reach : low;
  style.colour_high = style.diverging ? reach : high;
  if (!style.diverging && low < 0.2 * high) style.colour_low = std::min(0.0, low);
  if (scene.colour_range) {
    style.colour_low = (*scene.colour_range)[0];
    style.colour_high = (*scene.colour_range)[1];
  }
  if (scene.levels.empty()) style.spacing = nice_spacing(low, high, scene.isolines);
  return style;
}

double colour_position(const FieldStyle& style, double value) {
  // Halved, so that the range of huge numbers stays finite.
  const double range = 0.5 * style.colour_high - 0.5 * style.colour_low;
  if (!(range > 0)) return 0.5;
  return std::clamp((0.5 * value - 0.5 * style.colour_low) / range, 0.0, 1.0);
}

double nice_spacing(double low, double high, double count) {
  const double raw = high / count - low / count;
  if (!(count >= 1) || !(raw > std::numeric_limits<double>::min()) || !std::isfinite(raw)) return 0;
  const double magnitude = std::pow(10, std::floor(std::log10(raw)));
  double best = 0, miss = std::numeric_limits<double>::infinity();
  for (const double step : {1.0, 2.0, 2.5, 5.0, 10.0}) {
    const double off = std::abs(std::log(step * magnitude / raw));
    if (off < miss) {
      miss = off;
      best = step * magnitude;
    }
  }
  return std::isfinite(best) ? best : 0;
}

std::vector<double> nice_ticks(double low, double high, double step) {
  std::vector<double> ticks;
  if (!(step > 0) || !std::isfinite(low / step) || !std::isfinite(high / step)) return ticks;
  const double tolerance = 1e-9;
  const double first = std::ceil(low / step - tolerance);
  const double last = std::floor(high / step + tolerance);
  if (!(last - first < 1000)) return ticks;
  for (double k = first; k <= last; ++k) ticks.push_back(k == 0 ? 0.0 : k * step);
  return ticks;
}

std::string label_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.5g", value == 0 ? 0.0 : value);
  return text;
}

SourceMarks source_marks(const Scene& scene, double radius) {
  SourceMarks marks;
  const double dash = 0.03 * radius, arrow = 0.045 * radius, every = 0.45 * radius;
  for (const SceneCurve& curve : scene.curves) {
    const MatX3& p = curve.points;
    double length = 0;
    for (Eigen::Index i = 1; i < p.rows(); ++i) length += (p.row(i) - p.row(i - 1)).norm();
    // Heads at even distances, the last one at the end; a whole number of dashes.
    const double heads = std::max(1.0, std::round(length / every));
    const double head_step = length / heads;
    const double dashes = 2 * std::max(1.0, std::round(length / (2 * dash))) - 1;
    const double dash_step = length / dashes;
    double at = 0, next_head = head_step;
    for (Eigen::Index i = 1; i < p.rows(); ++i) {
      const Vec3 a = p.row(i - 1), b = p.row(i);
      const double piece = (b - a).norm();
      if (!(piece > 0)) continue;
      const Vec3 along = (b - a) / piece;
      if (curve.is_signed) {
        marks.strokes.push_back({a, b, true});
        while (next_head <= at + piece + 1e-9 * length && next_head <= length * (1 + 1e-9)) {
          const Vec3 tip = a + std::min(piece, next_head - at) * along;
          const double size = std::min(arrow, 0.5 * head_step);
          marks.arrows.push_back({tip - size * along, tip});
          next_head += head_step;
        }
      } else {
        for (double k = std::floor(at / dash_step); k * dash_step < at + piece; ++k) {
          if (std::fmod(k, 2) != 0) continue;
          const double from = std::max(at, k * dash_step),
                       to = std::min(at + piece, (k + 1) * dash_step);
          if (to > from)
            marks.strokes.push_back({a + (from - at) * along, a + (to - at) * along, false});
        }
      }
      at += piece;
    }
  }
  return marks;
}

}  // namespace littoral::io
