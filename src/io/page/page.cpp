#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "io/page/page_parts.h"
#include "io/page/page_template.h"
#include "io/render/openness.h"
#include "io/render/scene.h"
#include "io/render/scene_style.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::io {

std::string base64(const void* data, std::size_t size) {
  static constexpr char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* byte = static_cast<const unsigned char*>(data);
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const std::size_t left = size - i;
    const std::uint32_t bits = std::uint32_t{byte[i]} << 16 |
                               (left > 1 ? std::uint32_t{byte[i + 1]} << 8 : 0) |
                               (left > 2 ? std::uint32_t{byte[i + 2]} : 0);
    text += digits[bits >> 18];
    text += digits[bits >> 12 & 63];
    text += left > 1 ? digits[bits >> 6 & 63] : '=';
    text += left > 2 ? digits[bits & 63] : '=';
  }
  return text;
}

namespace {

using nlohmann::json;

constexpr int scene_version = 2;                       // viewer/src/scene.ts refuses others
constexpr Eigen::Index most_for_openness = 1'000'000;  // triangles: it takes seconds from there on

// Positions relative to the centre in units of the radius: single precision is then always enough
// for the screen, wherever and however large the model is.
class Packer {
 public:
  explicit Packer(const SceneFrame& frame) : frame_(frame) {}
  void add(const Vec3& p) {
    for (int k = 0; k < 3; ++k) {
      const double x = (p[k] - frame_.centre[k]) / frame_.radius;
      items_.push_back(std::isfinite(x) ? static_cast<float>(x) : 0.f);
    }
  }
  std::string text() const { return base64(items_); }

 private:
  const SceneFrame& frame_;
  std::vector<float> items_;
};

// Values as 0..1 between the least and the greatest; infinite ones as +inf.
std::string values_text(const VecX& values, const FieldStyle& style) {
  const double half = 0.5 * style.high - 0.5 * style.low;
  std::vector<float> parts;
  parts.reserve(std::size_t(values.size()));
  for (const double value : values) {
    const double t = half > 0 ? (0.5 * value - 0.5 * style.low) / half : 0;
    parts.push_back(std::isfinite(value) ? static_cast<float>(std::clamp(t, 0.0, 1.0))
                                         : std::numeric_limits<float>::infinity());
  }
  return base64(parts);
}

json style_json(const std::string& name, const FieldStyle& style) {
  return {{"name", name},
          {"at", "vertex"},
          {"diverging", style.diverging},
          {"discrete", style.discrete},
          {"infinite", style.infinite},
          {"map", colour_map_name(style.map)},
          {"low", style.low},
          {"high", style.high},
          {"colourLow", style.colour_low},
          {"colourHigh", style.colour_high},
          {"spacing", style.spacing},
          {"levels", json::array()}};
}

std::string weights_text(const VecX& weights) {
  std::vector<unsigned char> bytes;
  for (const double w : weights) bytes.push_back(static_cast<unsigned char>(std::lround(255 * w)));
  return base64(bytes);
}

json fields_json(const Scene& scene) {
  json fields = json::array();
  const FieldStyle style = field_style(scene);
  if (scene.volume || scene.values.size()) {
    json field = style_json(scene.field_name, style);
    field["levels"] = scene.levels;
    if (!scene.volume) field["values"] = values_text(scene.values, style);
    if (!scene.volume && scene.weights.size() && (scene.weights.array() != 1).any())
      field["weights"] = weights_text(scene.weights);
    fields.push_back(field);
  }
  if (scene.volume) return fields;
  for (const SceneField& more : scene.more) {
    const FieldStyle other = field_style(scene, more);
    json field = style_json(more.name, other);
    field["values"] = values_text(more.values, other);
    fields.push_back(field);
  }
  return fields;
}

json sources_json(const Scene& scene, const SceneFrame& frame) {
  const SourceMarks marks = source_marks(scene, frame.radius);
  Packer signed_strokes(frame), unsigned_strokes(frame), arrows(frame), points(frame);
  for (const auto& stroke : marks.strokes) {
    Packer& packer = stroke.is_signed ? signed_strokes : unsigned_strokes;
    packer.add(stroke.a);
    packer.add(stroke.b);
  }
  for (const auto& arrow : marks.arrows) {
    arrows.add(arrow.base);
    arrows.add(arrow.tip);
  }
  for (Eigen::Index i = 0; i < scene.source_points.rows(); ++i)
    points.add(scene.source_points.row(i));
  return {{"signed", signed_strokes.text()}, {"unsigned", unsigned_strokes.text()},
          {"arrows", arrows.text()},         {"points", points.text()},
          {"signedColour", signed_colour},   {"unsignedColour", unsigned_colour}};
}

// The box of a volume, as a surface to place the view by.
Scene box_of(const Scene& scene) {
  Scene box;
  box.volume = scene.volume;
  box.up = scene.up;
  box.towards_eye = scene.towards_eye;
  box.points.resize(8, 3);
  box.triangles.resize(4, 3);
  box.triangles << 0, 1, 3, 2, 3, 7, 4, 5, 7, 6, 5, 7;  // every corner
  const Grid& grid = scene.volume->thin.grid;
  for (int c = 0; c < 8; ++c)
    box.points.row(c) = grid.point((c & 1) ? grid.n[0] - 1 : 0, (c & 2) ? grid.n[1] - 1 : 0,
                                   (c & 4) ? grid.n[2] - 1 : 0);
  return box;
}

// In bytes: b + 3/4 in units of 3/2, as |b| <= 3/4 on a wall, and a.
std::string openness_text(const Scene& scene) {
  std::vector<unsigned char> bytes;
  const auto byte = [](float part) {
    return static_cast<unsigned char>(std::lround(255 * std::clamp(part, 0.f, 1.f)));
  };
  const Openness open = openness(scene.points, scene.triangles);
  for (Eigen::Index v = 0; v < open.rows(); ++v) {
    for (int k = 0; k < 3; ++k) bytes.push_back(byte((open(v, k) + 0.75f) / 1.5f));
    bytes.push_back(byte(open(v, 3)));
  }
  return base64(bytes);
}

std::string discs_text(const Scene& scene, const SceneFrame& frame) {
  std::vector<float> numbers;
  for (Eigen::Index v = 0; v < scene.discs.rows(); ++v) {
    for (int k = 0; k < 3; ++k) numbers.push_back(static_cast<float>(scene.discs(v, k)));
    numbers.push_back(static_cast<float>(scene.discs(v, 3) / frame.radius));
  }
  return base64(numbers);
}

json surface_json(const Scene& scene, const SceneFrame& frame, SceneNodes nodes) {
  static_assert(sizeof(int) == sizeof(std::uint32_t));
  Packer positions(frame);
  for (Eigen::Index v = 0; v < scene.points.rows(); ++v) positions.add(scene.points.row(v));
  json surface;
  surface["positions"] = positions.text();
  surface["triangles"] =
      base64(scene.triangles.data(), std::size_t(scene.triangles.size()) * sizeof(int));
  if (!scene.inner_sides.empty()) surface["innerSides"] = base64(scene.inner_sides);
  if (!scene.faces.empty()) surface["faces"] = base64(scene.faces);
  const bool asked = scene.shading == Shading::occluded;
  if (!scene.volume && (asked || scene.triangles.rows() <= most_for_openness))
    surface["openness"] = openness_text(scene);
  if (scene.discs.rows() > 0) surface["discs"] = discs_text(scene, frame);
  surface["nodes"] = nodes == SceneNodes::faces      ? "faces"
                     : nodes == SceneNodes::vertices ? "vertices"
                                                     : "none";
  return surface;
}

json pairs_json(const std::vector<std::pair<std::string, std::string>>& pairs) {
  json list = json::array();
  for (const auto& [key, value] : pairs) list.push_back({key, value});
  return list;
}

// The ball about two frames, seen as the first one is.
SceneFrame joined(const SceneFrame& a, const SceneFrame& b) {
  SceneFrame frame = a;
  const Vec3 across = b.centre - a.centre;
  const double apart = across.norm();
  if (apart + b.radius <= a.radius * (1 + 1e-9)) return frame;
  if (apart + a.radius <= b.radius) {
    frame.centre = b.centre;
    frame.radius = b.radius;
    return frame;
  }
  frame.radius = 0.5 * (apart + a.radius + b.radius);
  frame.centre = a.centre + (frame.radius - a.radius) / apart * across;
  return frame;
}

/// What is drawn as triangles, and places the view: of a volume its box.
Scene drawn_part(const Scene& scene) { return scene.volume ? box_of(scene) : Scene{}; }

json part_json(const Scene& all, const Scene& box, const SceneFrame& frame) {
  const FieldStyle style = field_style(all);
  const auto triple = [](const Vec3& v) { return json{v[0], v[1], v[2]}; };
  json page;
  page["title"] = all.title;
  page["facts"] = pairs_json(all.facts);
  page["options"] = pairs_json(all.options);
  page["warnings"] = all.warnings;
  page["frame"] = {{"centre", triple(frame.centre)},
                   {"radius", frame.radius},
                   {"towardsEye", triple(frame.towards_eye)},
                   {"up", triple(frame.up)}};
  page["surface"] =
      surface_json(all.volume ? box : all, frame, all.volume ? SceneNodes::none : all.nodes);
  page["fields"] = fields_json(all);
  page["sources"] = sources_json(all, frame);
  if (all.volume) page["volume"] = volume_json(*all.volume, frame, style);
  if (all.volume && all.trace && !all.trace->clouds.empty())
    page["trace"] = trace_json(*all.trace, frame, style);
  page["plainColour"] = plain_colour;
  page["infiniteColour"] = infinite_colour;
  page["shading"] = all.shading == Shading::flat       ? "flat"
                    : all.shading == Shading::occluded ? "occluded"
                                                       : "smooth";
  return page;
}

// docs/reference/scene.md
json scene_json(const Scene& scene) {
  const Scene box = drawn_part(scene);
  SceneFrame frame = scene_frame(scene.volume ? box : scene);
  const Scene* beside = scene.beside.get();
  const Scene other = beside ? drawn_part(*beside) : Scene{};
  if (beside) frame = joined(frame, scene_frame(beside->volume ? other : *beside));
  json page = part_json(scene, box, frame);
  if (beside) page["beside"] = part_json(*beside, other, frame);
  page["format"] = "littoral scene";
  page["version"] = scene_version;
  return page;
}

// JSON that cannot end the script element it stands in.
std::string script_text(const json& value) {
  const std::string plain = value.dump(-1, ' ', false, json::error_handler_t::replace);
  std::string text;
  text.reserve(plain.size());
  for (const char c : plain) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

std::string escape_html(std::string_view plain) {
  std::string text;
  for (const char c : plain) {
    switch (c) {
      case '&':
        text += "&amp;";
        break;
      case '<':
        text += "&lt;";
        break;
      case '>':
        text += "&gt;";
        break;
      case '"':
        text += "&quot;";
        break;
      case '\'':
        text += "&#39;";
        break;
      default:
        text += c;
    }
  }
  return text;
}

}  // namespace

#ifndef LITTORAL_HAS_VIEWER
std::string_view page_template() { return {}; }
#endif

bool has_viewer() { return !page_template().empty(); }

void write_page(const std::filesystem::path& path, const Scene& scene) {
  check_scene(scene);
  const std::string_view page = page_template();
  if (page.empty()) {
    throw UnsupportedError(
        "cannot write " + path.string() +
            ": this build lacks the viewer (configure with LITTORAL_VIEWER=ON and "
            "npm installed); pictures (.png) work",
        "cannot-write");
  }
  constexpr std::string_view title_mark = "LITTORAL_TITLE", data_mark = "\"LITTORAL_DATA\"";
  const std::size_t title = page.find(title_mark);
  const std::size_t data = page.find(data_mark, title);
  if (data == std::string_view::npos) throw IoError("the built-in viewer page is damaged");
  const std::string heading = escape_html(scene.title.empty() ? "littoral" : scene.title);
  const std::string content = script_text(scene_json(scene));
  write_atomically(path, [&](std::ostream& out) {
    out << page.substr(0, title) << heading
        << page.substr(title + title_mark.size(), data - title - title_mark.size()) << content
        << page.substr(data + data_mark.size());
  });
}

}  // namespace littoral::io
