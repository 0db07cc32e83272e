// Surfaces, lines and points of a glTF scene, where its nodes put them.

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/option_table.h"
#include "io/gltf/gltf_file.h"
#include "io/surface/most_copies.h"
#include "io/surface/point_merger.h"
#include "io/surface/surface_formats.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

using Json = GltfFile::Json;

/// A primitive as stored; section 3.7.2.
struct GltfPart {
  int mode = 4;
  MatX3 points{0, 3}, normals{0, 3};
  std::map<std::string, VecX> scalars;
  std::vector<int> indices;
};

enum GltfMode { points = 0, lines, loop, strip, triangles, triangle_strip, triangle_fan };

class GltfReader {
 public:
  GltfReader(std::string_view bytes, const std::string& name, const std::filesystem::path* folder)
      : file_(bytes, name, folder) {}

  PolygonSoup read() {
    walk();
    if (coordinates_.empty()) file_.fail("no vertices");
    const auto n = index(coordinates_.size() / 3);
    soup_.points = Eigen::Map<const MatX3>(coordinates_.data(), n, 3);
    if (keep_normals_) soup_.normals = Eigen::Map<const MatX3>(normals_.data(), n, 3);
    for (const auto& [field, values] : scalars_)
      if (index(values.size()) == n)
        soup_.scalars[field] = Eigen::Map<const VecX>(values.data(), n);
    return std::move(soup_);
  }

 private:
  // The nodes of the scene are a forest; every one is met once.
  void walk() {
    const std::size_t n = file_.count("nodes");
    std::vector<std::pair<std::uint64_t, Eigen::Affine3d>> open;
    std::vector<bool> met(n, false);
    const auto enter = [&](const Json& list, const std::string& where,
                           const Eigen::Affine3d& to_world) {
      if (!list.is_array()) file_.fail(where + " must be an array of nodes");
      for (std::size_t i = list.size(); i-- > 0;) {  // the stack turns the order round
        if (!list[i].is_number_unsigned() || list[i].get<std::uint64_t>() >= n)
          file_.fail(where + ": entry " + std::to_string(i) + " is no node, the file has " +
                     std::to_string(n));
        const auto node = list[i].get<std::uint64_t>();
        if (met[node]) file_.fail("node " + std::to_string(node) + " stands in two places");
        met[node] = true;
        open.emplace_back(node, to_world);
      }
    };
    if (file_.count("scenes") > 0) {
      const std::uint64_t scene = file_.natural(file_.root(), "scene", "the document", 0);
      const Json& entry = file_.item("scenes", scene);
      if (entry.contains("nodes"))
        enter(entry["nodes"], "scene " + std::to_string(scene), Eigen::Affine3d::Identity());
    } else {
      // A library of meshes: each as it is.
      for (std::uint64_t m = 0; m < file_.count("meshes"); ++m)
        place(m, Eigen::Affine3d::Identity());
    }
    while (!open.empty()) {
      const auto [number, parent] = open.back();
      open.pop_back();
      const std::string where = "node " + std::to_string(number);
      const Json& node = file_.item("nodes", number);
      const Eigen::Affine3d to_world = parent * transform(node, where);
      if (node.contains("mesh")) {
        if (node.contains("skin"))
          file_.unsupported(where + " has a skin; export the mesh without its skeleton");
        check_unmorphed(node, where);
        if (node.contains("extensions") && node["extensions"].contains("EXT_mesh_gpu_instancing"))
          file_.unsupported(where + " uses the extension 'EXT_mesh_gpu_instancing'");
        place(file_.natural(node, "mesh", where), to_world);
      }
      if (node.contains("children")) enter(node["children"], where + ": 'children'", to_world);
    }
  }

  void check_unmorphed(const Json& entry, const std::string& where) const {
    if (!entry.contains("weights")) return;
    for (const Json& weight : entry["weights"])
      if (weight != Json(0))
        file_.unsupported(where + " is morphed; export the mesh with its shape applied");
  }

  template <int n>
  Eigen::Matrix<double, n, 1> vector(const Json& node, const char* key, const std::string& where,
                                     Eigen::Matrix<double, n, 1> value) const {
    if (!node.contains(key)) return value;
    const Json& list = node[key];
    if (!list.is_array() || list.size() != n)
      file_.fail(where + ": '" + key + "' must be " + std::to_string(n) + " numbers");
    for (int i = 0; i < n; ++i) {
      const Json& number = list[i];
      if (!number.is_number())
        file_.fail(where + ": '" + key + "' must be " + std::to_string(n) + " numbers");
      value[i] = number.get<double>();
    }
    return value;
  }

  // Section 3.5.2: a matrix by columns, or scale, then rotation, then translation.
  Eigen::Affine3d transform(const Json& node, const std::string& where) const {
    Eigen::Affine3d out = Eigen::Affine3d::Identity();
    if (node.contains("matrix")) {
      const auto numbers = vector<16>(node, "matrix", where, Eigen::Matrix<double, 16, 1>::Zero());
      out.matrix() = numbers.reshaped(4, 4);
      if (out.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
        file_.fail(where + ": the last row of 'matrix' must be 0 0 0 1");
      return out;
    }
    const auto q = vector<4>(node, "rotation", where, Eigen::Vector4d(0, 0, 0, 1));
    if (!(q.norm() > 0)) file_.fail(where + ": 'rotation' is no rotation");
    out.translate(vector<3>(node, "translation", where, Vec3::Zero()));
    out.rotate(Eigen::Quaterniond(q).normalized());
    out.scale(vector<3>(node, "scale", where, Vec3::Ones()));
    return out;
  }

  const std::vector<GltfPart>& parts(std::uint64_t mesh) {
    const auto found = meshes_.find(mesh);
    if (found != meshes_.end()) return found->second;
    const std::string where = "mesh " + std::to_string(mesh);
    const Json& entry = file_.item("meshes", mesh);
    check_unmorphed(entry, where);
    if (!entry.contains("primitives") || !entry["primitives"].is_array())
      file_.fail(where + " has no 'primitives'");
    std::vector<GltfPart> out;
    for (const Json& primitive : entry["primitives"])
      out.push_back(part(primitive, where + ", primitive " + std::to_string(out.size())));
    return meshes_.emplace(mesh, std::move(out)).first->second;
  }

  GltfPart part(const Json& primitive, const std::string& where) const {
    if (!primitive.is_object() || !primitive.contains("attributes") ||
        !primitive["attributes"].is_object())
      file_.fail(where + " has no 'attributes'");
    const Json& attributes = primitive["attributes"];
    GltfPart out;
    const std::uint64_t mode = file_.natural(primitive, "mode", where, triangles);
    if (mode > triangle_fan) file_.fail(where + ": there is no mode " + std::to_string(mode));
    out.mode = static_cast<int>(mode);
    if (!attributes.contains("POSITION")) return out;  // section 3.7.2.1: nothing to show
    out.points = file_.numbers(file_.natural(attributes, "POSITION", where), "VEC3");
    const auto same_count = [&](Eigen::Index count, const std::string& what) {
      if (count != out.points.rows())
        file_.fail(where + ": " + std::to_string(count) + " of " + what + " for " +
                   std::to_string(out.points.rows()) + " positions");
    };
    for (const auto& [key, accessor] : attributes.items()) {
      const std::uint64_t number = file_.natural(attributes, key.c_str(), where);
      if (key == "NORMAL") {
        out.normals = file_.numbers(number, "VEC3");
        same_count(out.normals.rows(), key);
      } else if (key.size() > 1 && key[0] == '_' &&
                 GltfFile::text(file_.item("accessors", number), "type") == "SCALAR") {
        const VecX values = file_.numbers(number, "SCALAR").col(0);
        same_count(values.size(), key);
        out.scalars[lower_case(key.substr(1))] = values.unaryExpr(
            [](double x) { return x >= std::numeric_limits<float>::max() ? infinity : x; });
      }
    }
    read_indices(primitive, where, out);
    return out;
  }

  void read_indices(const Json& primitive, const std::string& where, GltfPart& out) const {
    const auto n = static_cast<double>(out.points.rows());
    if (primitive.contains("indices")) {
      const VecX indices =
          file_.numbers(file_.natural(primitive, "indices", where), "SCALAR").col(0);
      for (Eigen::Index i = 0; i < indices.size(); ++i) {
        if (!(indices[i] >= 0 && indices[i] < n) || indices[i] != std::floor(indices[i]))
          file_.fail(where + ": index " + std::to_string(i) + " refers to vertex " +
                     number_text(indices[i]) + ", it has " + std::to_string(out.points.rows()) +
                     " (counted from 0)");
        out.indices.push_back(static_cast<int>(indices[i]));
      }
    } else {
      for (int v = 0; v < static_cast<int>(out.points.rows()); ++v) out.indices.push_back(v);
    }
    if (out.mode == triangles && out.indices.size() % 3 != 0)
      file_.fail(where + ": " + std::to_string(out.indices.size()) +
                 " indices are no whole number of triangles");
    if (out.mode == lines && out.indices.size() % 2 != 0)
      file_.fail(where + ": " + std::to_string(out.indices.size()) +
                 " indices are no whole number of lines");
  }

  // Exporters give a vertex as often as it has normals or texture coordinates: within a mesh, those
  // at one place with the same values are one. Points that stand alone are kept as they are.
  void place(std::uint64_t mesh, const Eigen::Affine3d& to_world) {
    PointMerger merger;
    std::vector<int> numbers;  // of the soup, by those of the merger
    const Eigen::Matrix3d for_normals =
        to_world.linear().determinant() != 0
            ? Eigen::Matrix3d(to_world.linear().inverse().transpose())
            : Eigen::Matrix3d::Identity();
    const bool mirrored = to_world.linear().determinant() < 0;
    const std::vector<GltfPart>& all = parts(mesh);
    most_ = most_copied(file_.size());
    for (const GltfPart& part : all) {
      std::vector<int> vertices(std::size_t(part.points.rows()), -1);
      const auto vertex = [&](int v) {
        int& known = vertices[v];
        if (known >= 0) return known;
        const Vec3 p = to_world * Vec3(part.points.row(v));
        const Vec3 normal =
            part.normals.rows() > 0 ? Vec3(for_normals * Vec3(part.normals.row(v))) : Vec3::Zero();
        if (part.mode == points) return known = add(part, v, p, normal);
        const int merged = merger.vertex(p[0], p[1], p[2], tag(part, v));
        if (merged == static_cast<int>(numbers.size())) numbers.push_back(add(part, v, p, normal));
        known = numbers[merged];
        // Normals are kept where each vertex has exactly one.
        const std::size_t at = 3 * std::size_t(known);
        if (keep_normals_ && Eigen::Map<const Vec3>(&normals_[at]) != normal) keep_normals_ = false;
        return known;
      };
      add_elements(part, vertex, mirrored);
    }
  }

  /// Vertices with other values stay apart.
  std::uint64_t tag(const GltfPart& part, int v) {
    std::uint64_t out = 0;
    for (const auto& [field, values] : part.scalars)
      out = 1 + static_cast<std::uint64_t>(tags_.vertex(values[v], 0, 0, out));
    return out;
  }

  int add(const GltfPart& part, int v, const Vec3& p, const Vec3& normal) {
    const std::size_t number = coordinates_.size() / 3;
    if (number >= most_) file_.fail("more than " + std::to_string(most_) + " vertices");
    coordinates_.insert(coordinates_.end(), p.begin(), p.end());
    keep_normals_ = keep_normals_ && part.normals.rows() > 0;
    normals_.insert(normals_.end(), normal.begin(), normal.end());
    // Values that a part lacks end there, and are then fewer than the vertices.
    for (const auto& [field, values] : part.scalars)
      if (auto& all = scalars_[field]; all.size() == number) all.push_back(values[v]);
    return static_cast<int>(number);
  }

  template <class Vertex>
  void add_elements(const GltfPart& part, const Vertex& vertex, bool mirrored) {
    const std::vector<int>& all = part.indices;
    const std::size_t n = all.size();
    const auto face = [&](std::size_t a, std::size_t b, std::size_t c) {
      if (mirrored) std::swap(b, c);
      soup_.add_face(std::array<int, 3>{vertex(all[a]), vertex(all[b]), vertex(all[c])});
      if (soup_.corners.size() > most_)
        file_.fail("more than " + std::to_string(most_) + " corners");
    };
    switch (part.mode) {
      case points:
        for (const int v : all) vertex(v);
        break;
      case lines:
        for (std::size_t i = 0; i + 1 < n; i += 2)
          soup_.lines.push_back({vertex(all[i]), vertex(all[i + 1])});
        break;
      case loop:
      case strip:
        if (n < 2) break;
        soup_.lines.emplace_back();
        for (const int v : all) soup_.lines.back().push_back(vertex(v));
        if (part.mode == loop) soup_.lines.back().push_back(vertex(all.front()));
        break;
      case triangles:
        for (std::size_t i = 0; i + 2 < n; i += 3) face(i, i + 1, i + 2);
        break;
      case triangle_strip:
        for (std::size_t i = 0; i + 2 < n; ++i) face(i, i + 1 + i % 2, i + 2 - i % 2);
        break;
      default:
        for (std::size_t i = 0; i + 2 < n; ++i) face(i + 1, i + 2, 0);
    }
  }

  GltfFile file_;
  std::size_t most_ = 0;  // vertices, and corners
  std::map<std::uint64_t, std::vector<GltfPart>> meshes_;
  PolygonSoup soup_;
  std::vector<double> coordinates_, normals_;
  bool keep_normals_ = true;
  std::map<std::string, std::vector<double>> scalars_;
  PointMerger tags_;
};

}  // namespace

PolygonSoup read_gltf(std::string_view bytes, const std::string& name) {
  return GltfReader(bytes, name, nullptr).read();
}

PolygonSoup read_gltf_beside(std::string_view bytes, const std::filesystem::path& path) {
  const std::filesystem::path folder = path.parent_path();
  return GltfReader(bytes, path.string(), &folder).read();
}

}  // namespace littoral::io
