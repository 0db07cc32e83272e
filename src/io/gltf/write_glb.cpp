// glTF 2.0 in one file: vertices once, triangles, lines and points over them.

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/index.h"
#include "io/binary.h"
#include "io/render/scene_style.h"
#include "io/surface/surface_writers.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

using Json = nlohmann::json;
constexpr int glb_float = 5126, glb_unsigned_int = 5125, glb_unsigned_short = 5123;
constexpr int glb_vertices = 34962, glb_elements = 34963;  // what a buffer view is for

void check_vertices(const PolygonSoup& soup) {
  for (Eigen::Index v = 0; v < soup.points.rows(); ++v) {
    const auto refuse = [&](const char* what) {
      throw UnsupportedError("vertex " + std::to_string(v) + " " + what, "unsupported-file");
    };
    if (!(soup.points.row(v).cwiseAbs().maxCoeff() <= std::numeric_limits<float>::max()))
      refuse("is not finite or beyond glTF's single precision; .ply holds doubles");
    if (soup.normals.rows() == 0) continue;
    const double length = soup.normals.row(v).stableNorm();
    if (!(length > 0 && std::isfinite(length))) refuse("has a normal without a direction");
  }
}

void check_triangles(const PolygonSoup& soup) {
  for (int f = 0; f < soup.n_faces(); ++f)
    if (soup.face(f).size() != 3)
      throw UnsupportedError("face " + std::to_string(f) + " has " +
                                 std::to_string(soup.face(f).size()) +
                                 " corners, glTF holds triangles only; .obj, .ply and .off hold "
                                 "polygons, --triangulate cuts them",
                             "unsupported-file");
}

/// "distance" is "_DISTANCE".
std::string attribute_name(const std::string& field) {
  std::string name = "_";
  for (const char c : field) {
    const bool small = c >= 'a' && c <= 'z';
    const bool plain = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    name += small ? static_cast<char>(c - 'a' + 'A') : plain ? c : '_';
  }
  return name;
}

// The standard has no room for infinity: the largest number stands for it.
float finite_float(double value, const std::string& field, Eigen::Index v) {
  constexpr float most = std::numeric_limits<float>::max();
  if (std::isnan(value) || value < -static_cast<double>(most))
    throw UnsupportedError("the scalar " + in_quotes(field) + " of vertex " + std::to_string(v) +
                               " is nothing that glTF can hold",
                           "unsupported-file");
  return value >= static_cast<double>(most) ? most : static_cast<float>(value);
}

/// The fraction of full light that an sRGB byte stands for, in 16 bits.
std::uint16_t linear(unsigned char byte) {
  const double c = byte / 255.0;
  const double light = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  return static_cast<std::uint16_t>(std::lround(65535 * light));
}

/// The buffer, and what the document says of its parts.
class GlbParts {
 public:
  /// An accessor of what is stored by `store`, an element a time.
  template <class Store>
  std::size_t add(int target, int component, const char* type, std::size_t count, Store store) {
    const auto begin = std::size_t(data_.tellp());
    for (std::size_t i = 0; i < count; ++i) store(data_, index(i));
    const std::size_t length = std::size_t(data_.tellp()) - begin;
    views_.push_back(
        {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", length}, {"target", target}});
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", component},
                          {"count", count},
                          {"type", type}});
    return accessors_.size() - 1;
  }
  Json& accessor(std::size_t number) { return accessors_[number]; }

  void write(std::ostream& out, Json document) {
    std::string data = data_.str();
    document["buffers"] = Json::array({{{"byteLength", data.size()}}});
    document["bufferViews"] = views_;
    document["accessors"] = accessors_;
    std::string text = document.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    data.append((4 - data.size() % 4) % 4, '\0');
    const std::uint64_t size = 12 + 8 + text.size() + 8 + data.size();
    if (size > std::numeric_limits<std::uint32_t>::max())
      throw UnsupportedError("more than 4 GiB, which .glb cannot hold; .ply can",
                             "unsupported-file");
    out << "glTF";
    for (const std::uint64_t x : std::initializer_list<std::uint64_t>{2, size, text.size()})
      store_little(out, static_cast<std::uint32_t>(x));
    out << "JSON" << text;
    store_little(out, static_cast<std::uint32_t>(data.size()));
    out.write("BIN", 4) << data;
  }

 private:
  std::ostringstream data_;
  Json views_ = Json::array(), accessors_ = Json::array();
};

Json attributes_of(const PolygonSoup& soup, const std::string& field, GlbParts& parts) {
  const auto n = std::size_t(soup.points.rows());
  Json attributes;
  const auto vectors = [&](const MatX3& rows, bool unit) {
    return parts.add(glb_vertices, glb_float, "VEC3", n, [&](std::ostream& out, Eigen::Index v) {
      Vec3 row = rows.row(v);
      if (unit) row.stableNormalize();
      for (const double x : row) store_little(out, static_cast<float>(x));
    });
  };
  const std::size_t positions = vectors(soup.points, false);
  attributes["POSITION"] = positions;
  Json low, high;
  for (int k = 0; k < 3; ++k) {
    low.push_back(static_cast<float>(soup.points.col(k).minCoeff()));
    high.push_back(static_cast<float>(soup.points.col(k).maxCoeff()));
  }
  parts.accessor(positions)["min"] = low;
  parts.accessor(positions)["max"] = high;
  if (soup.normals.rows() > 0) attributes["NORMAL"] = vectors(soup.normals, true);
  for (const auto& [name, values] : soup.scalars) {
    const std::string key = attribute_name(name);
    if (attributes.contains(key))
      throw UnsupportedError(
          "two scalars would be the attribute " + in_quotes(key) + "; rename one",
          "unsupported-file");
    attributes[key] =
        parts.add(glb_vertices, glb_float, "SCALAR", n,
                  [&, &given = name, &all = values](std::ostream& out, Eigen::Index v) {
                    store_little(out, finite_float(all[v], given, v));
                  });
  }
  if (const auto shown = soup.scalars.find(field); shown != soup.scalars.end()) {
    const std::vector<Rgb> colours = value_colours(shown->second, field);
    const std::size_t number = parts.add(glb_vertices, glb_unsigned_short, "VEC4", n,
                                         [&](std::ostream& out, Eigen::Index v) {
                                           for (const unsigned char byte : colours[v])
                                             store_little(out, linear(byte));
                                           store_little(out, std::uint16_t{65535});
                                         });
    parts.accessor(number)["normalized"] = true;
    attributes["COLOR_0"] = number;
  }
  return attributes;
}

}  // namespace

void write_glb(std::ostream& out, const PolygonSoup& soup, const std::string& field) {
  if (soup.n_vertices() == 0) throw UnsupportedError("there are no vertices", "unsupported-file");
  check_vertices(soup);
  check_triangles(soup);
  GlbParts parts;
  const Json attributes = attributes_of(soup, field, parts);
  Json primitives = Json::array();
  const auto add = [&](int mode, const std::vector<int>& indices) {
    const std::size_t accessor =
        parts.add(glb_elements, glb_unsigned_int, "SCALAR", indices.size(),
                  [&](std::ostream& to, Eigen::Index i) {
                    store_little(to, static_cast<std::uint32_t>(indices[i]));
                  });
    primitives.push_back(
        {{"attributes", attributes}, {"indices", accessor}, {"mode", mode}, {"material", 0}});
  };
  constexpr int strip = 3, triangles = 4;
  if (soup.n_faces() > 0) add(triangles, soup.corners);
  for (const auto& line : soup.lines) add(strip, line);
  if (primitives.empty())
    primitives.push_back({{"attributes", attributes}, {"mode", 0}, {"material", 0}});
  // A surface that is neither metal nor mirror, seen from both sides.
  const Json material = {{"doubleSided", true},
                         {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}};
  parts.write(out, {{"asset", {{"version", "2.0"}, {"generator", "littoral"}}},
                    {"scene", 0},
                    {"scenes", Json::array({{{"nodes", {0}}}})},
                    {"nodes", Json::array({{{"mesh", 0}}})},
                    {"materials", Json::array({material})},
                    {"meshes", Json::array({{{"primitives", primitives}}})}});
}

}  // namespace littoral::io
