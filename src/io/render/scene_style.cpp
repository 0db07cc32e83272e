#include "io/render/scene_style.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/option_table.h"
#include "base/parallel.h"

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
    map[i] = from_oklab(lab);
  }
  return map;
}

}  // namespace

const std::array<Rgb, 256>& colour_map(ColourMap map) {
#define MAP(name, ...)                                             \
  case ColourMap::name: {                                          \
    static const std::array<Rgb, 256> made = blend({__VA_ARGS__}); \
    return made;                                                   \
  }
#define REGIONS(...)
  switch (map) {
#include "io/render/colour_maps.inc"
    case ColourMap::automatic:
      break;
  }
#undef MAP
#undef REGIONS
  return colour_map(ColourMap::sequential);
}

const char* colour_map_name(ColourMap map) {
#define MAP(name, ...)  \
  case ColourMap::name: \
    return #name;
#define REGIONS(...)
  switch (map) {
#include "io/render/colour_maps.inc"
    case ColourMap::automatic:
      break;
  }
#undef MAP
#undef REGIONS
  return "sequential";
}

Rgb region_colour(long number) {
#define MAP(...)
#define REGIONS(...) static const std::vector<Stop> regions = {__VA_ARGS__};
#include "io/render/colour_maps.inc"
#undef MAP
#undef REGIONS
  const auto n = static_cast<long>(regions.size()) - 1;
  const long i = number == 0 ? 0 : number > 0 ? 1 + (number - 1) % n : n - (-number - 1) % n;
  const Stop& stop = regions[i];
  const auto byte = [](int c) { return static_cast<unsigned char>(c); };
  return {byte(stop.r), byte(stop.g), byte(stop.b)};
}

Rgb value_colour(const FieldStyle& style, double value) {
  if (style.discrete) return region_colour(std::lround(value));
  return colour_map(style.map)[std::lround(255 * colour_position(style, value))];
}

namespace {

void widen(FieldStyle& style, double value) {
  if (!std::isfinite(value)) {
    style.infinite = true;
    return;
  }
  style.low = std::min(style.low, value);
  style.high = std::max(style.high, value);
  style.discrete = style.discrete && value == std::rint(value) && std::abs(value) < 1e6;
}

FieldStyle empty_style() {
  FieldStyle style;
  style.low = infinity;
  style.high = -style.low;
  style.discrete = true;
  return style;
}

// Which values a field takes on the triangles.
FieldStyle range_of_field(const Scene& scene, const VecX& values) {
  FieldStyle style = empty_style();
  if (values.size() == 0) return style;
  for (Eigen::Index i = 0; i < scene.triangles.size(); ++i)
    widen(style, values[scene.triangles.data()[i]]);
  return style;
}

// Integers are regions unless they are a distance or sure throughout; one number alone is one only
// by its name.
bool are_regions(const FieldStyle& style, const std::string& name) {
  constexpr double most = 255;
  if (!style.discrete || style.high - style.low > most) return false;
  return name == "region" || (style.high > style.low && name != "distance" && name != "confidence");
}

void choose_colours(FieldStyle& style, const std::string& name, ColourMap wanted) {
  // A trace of negative values, as a solver leaves around zero, does not make a signed field.
  const double reach = std::max(std::abs(style.low), std::abs(style.high));
  style.diverging =
      wanted == ColourMap::automatic ? style.low < -0.01 * reach : wanted == ColourMap::diverging;
  style.map = wanted != ColourMap::automatic ? wanted
              : style.diverging              ? ColourMap::diverging
                                             : ColourMap::sequential;
  style.colour_low = style.diverging ? -reach : style.low;
  style.colour_high = style.diverging ? reach : style.high;
  if (!style.diverging && style.low < 0.2 * style.high) style.colour_low = std::min(0.0, style.low);
  if (name == "confidence" && style.low >= 0 && style.high <= 1) {  // two of them compare
    style.colour_low = 0;
    style.colour_high = 1;
  }
}

}  // namespace

FieldStyle field_style(const Scene& scene) {
  FieldStyle style = range_of_field(scene, scene.values);
  if (scene.values.size() && scene.volume) {
    style.low = scene.volume->low;
    style.high = scene.volume->high;
    style.infinite = scene.volume->infinite;
  }
  const bool infinite = style.infinite;
  if (style.low > style.high) {
    style = {};
    style.infinite = infinite;
    return style;
  }
  style.present = true;
  style.discrete = !scene.volume && scene.colour_map == ColourMap::automatic &&
                   are_regions(style, scene.field_name);
  choose_colours(style, scene.field_name, scene.colour_map);
  if (scene.colour_range) {
    style.colour_low = (*scene.colour_range)[0];
    style.colour_high = (*scene.colour_range)[1];
  }
  if (scene.levels.empty() && !style.discrete)
    style.spacing = nice_spacing(style.low, style.high, scene.isolines);
  return style;
}

namespace {

FieldStyle style_of_range(FieldStyle style, const std::string& name, double isolines) {
  if (style.low > style.high) {
    FieldStyle none;
    none.infinite = style.infinite;
    return none;
  }
  style.present = true;
  style.discrete = are_regions(style, name);
  choose_colours(style, name, ColourMap::automatic);
  if (!style.discrete && name != "confidence")
    style.spacing = nice_spacing(style.low, style.high, isolines);
  return style;
}

}  // namespace

FieldStyle field_style(const Scene& scene, const SceneField& field) {
  return style_of_range(range_of_field(scene, field.values), field.name, scene.isolines);
}

FieldStyle field_style(const VecX& values, const std::string& name) {
  FieldStyle style = empty_style();
  for (const double value : values) widen(style, value);
  return style_of_range(style, name, 0);
}

std::vector<Rgb> value_colours(const VecX& values, const std::string& name) {
  const FieldStyle style = field_style(values, name);
  std::vector<Rgb> out(std::size_t(values.size()));
  parallel_for(out.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      out[v] =
          std::isfinite(values[index(v)]) ? value_colour(style, values[index(v)]) : infinite_colour;
  });
  return out;
}

double colour_position(const FieldStyle& style, double value) {
  // Halved, so that the range of huge numbers stays finite.
  const auto part = [value](double low, double high) {
    return std::clamp((0.5 * value - 0.5 * low) / (0.5 * high - 0.5 * low), 0.0, 1.0);
  };
  const double low = style.colour_low, high = style.colour_high;
  if (!(high > low)) return 0.5;
  if (!style.diverging) return part(low, high);
  // The hues meet at 0, however far from it the ends are.
  const double at = std::clamp(value, low, high), zero = std::clamp(0.0, low, high);
  if (at == zero) return 0.5;
  return at < zero ? 0.5 * part(low, zero) : 0.5 + 0.5 * part(zero, high);
}

double nice_spacing(double low, double high, double count) {
  const double raw = high / count - low / count;
  if (!(count >= 1) || !(raw > std::numeric_limits<double>::min()) || !std::isfinite(raw)) return 0;
  const double magnitude = std::pow(10, std::floor(std::log10(raw)));
  double best = 0, miss = infinity;
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

std::string label_text(double value, double fine) {
  int digits = 5;
  if (fine > 0 && value != 0 && std::isfinite(value)) {
    const double more = std::floor(std::log10(std::abs(value))) - std::floor(std::log10(fine)) + 1;
    digits = static_cast<int>(std::clamp(more, 5.0, 15.0));
  }
  return rounded_text(value == 0 ? 0.0 : value, digits);
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
