// 3MF (3MF Consortium, "3D Manufacturing Format, Core Specification", 1.3): an archive of XML.

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "base/index.h"
#include "io/surface/most_copies.h"
#include "io/surface/surface_formats.h"
#include "io/text_scan.h"
#include "io/xml_tags.h"
#include "io/zip_archive.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

/// Section 4.1: a point p becomes p linear + shift.
struct PlacedBy {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();  // acts on rows
  Eigen::RowVector3d shift = Eigen::RowVector3d::Zero();
  /// First this, then the other one.
  PlacedBy then(const PlacedBy& next) const {
    return {linear * next.linear, shift * next.linear + next.shift};
  }
};

struct PlacedObject {
  std::string part;  // of the archive
  std::int64_t id = 0;
  PlacedBy by;
};

struct PrintedObject {
  std::vector<double> coordinates;
  std::vector<int> corners;
  std::vector<PlacedObject> components;
};

struct ModelPart {
  double millimetres = 1;  // of its unit
  std::map<std::int64_t, PrintedObject> objects;
  std::vector<PlacedObject> items;
};

class ModelReader {
 public:
  ModelReader(std::string_view bytes, const std::string& name)
      : members_(zip_members(bytes, name)), name_(name), most_(most_copied(bytes.size())) {}

  PolygonSoup read() {
    const std::string root = root_part();
    const ModelPart& model = part(root);
    millimetres_ = model.millimetres;
    if (model.items.empty()) fail("there is no item to build");
    for (const PlacedObject& item : model.items) place(item, 0);
    if (points_.empty()) fail("no vertices");
    soup_.points =
        model.millimetres * Eigen::Map<const MatX3>(points_.data(), index(points_.size() / 3), 3);
    return std::move(soup_);
  }

 private:
  [[noreturn]] void fail(const std::string& text) const {
    throw InputError(name_ + ": " + text, "bad-file");
  }

  const ZipMember* member(const std::string& part) const {
    const std::string path = part.starts_with('/') ? part.substr(1) : part;
    const auto found = std::ranges::find_if(
        members_, [&](const ZipMember& m) { return lower_case(m.name) == lower_case(path); });
    return found == members_.end() ? nullptr : &*found;
  }

  /// The part that the archive's relationships name as its model.
  std::string root_part() const {
    if (const ZipMember* relations = member("_rels/.rels")) {
      const std::string text = unpacked(*relations, name_);
      const XmlTags tags(text, name_ + ": _rels/.rels");
      XmlTag tag;
      for (std::size_t at = 0; tags.next(at, tag); at = tag.end)
        if (tag.local_name() == "Relationship" &&
            tag.attribute("Type").ends_with("/2013/01/3dmodel"))
          return tag.attribute("Target");
    }
    return "/3D/3dmodel.model";
  }

  const ModelPart& part(const std::string& path) {
    const auto found = parts_.find(path);
    if (found != parts_.end()) return found->second;
    const ZipMember* held = member(path);
    if (held == nullptr) fail("the archive has no part " + in_quotes(path));
    return parts_.emplace(path, read_part(unpacked(*held, name_), path)).first->second;
  }

  ModelPart read_part(const std::string& bytes, const std::string& path) const {
    const std::string where = name_ + ": " + path;
    const XmlTags tags(without_byte_order_mark(bytes, where), where);
    ModelPart model;
    XmlTag tag;
    bool seen_model = false;
    PrintedObject* object = nullptr;
    std::int64_t id = 0;
    for (std::size_t at = 0; tags.next(at, tag); at = tag.end) {
      const std::string_view name = tag.local_name();
      const auto integer = [&](const char* key, const std::string& of) {
        const auto value = parse_integer(tag.attribute(key));
        if (!value) tags.fail(of + " has no whole number '" + key + "'");
        return *value;
      };
      const auto object_name = [&] { return "object " + std::to_string(id); };
      if (name == "model") {
        seen_model = true;
        read_head(tags, tag, model);
      } else if (!seen_model) {
        tags.fail("the part does not begin with the element model");
      } else if (name == "object") {
        id = integer("id", "an object");
        const auto [entry, is_new] = model.objects.try_emplace(id);
        if (!is_new) tags.fail(object_name() + " appears twice");
        object = tag.empty ? nullptr : &entry->second;
      } else if (name == "/object" || tag.name.ends_with(":object")) {
        object = nullptr;
      } else if (name == "item") {
        model.items.push_back(placed(tags, tag, path, "an item"));
      } else if (object == nullptr) {
        continue;
      } else if (name == "vertex") {
        const std::size_t number = object->coordinates.size() / 3;
        for (const char* key : {"x", "y", "z"}) {
          const auto value = parse_double(tag.attribute(key));
          if (!value)
            tags.fail(object_name() + ", vertex " + std::to_string(number) + ": '" + key + "' is " +
                      in_quotes(tag.attribute(key)));
          object->coordinates.push_back(*value);
        }
      } else if (name == "triangle") {
        const std::string label =
            object_name() + ", triangle " + std::to_string(object->corners.size() / 3);
        const auto n = static_cast<std::int64_t>(object->coordinates.size() / 3);
        for (const char* key : {"v1", "v2", "v3"}) {
          const std::int64_t v = integer(key, label);
          if (v < 0 || v >= n)
            tags.fail(label + " refers to vertex " + std::to_string(v) + ", it has " +
                      std::to_string(n) + " (counted from 0)");
          object->corners.push_back(static_cast<int>(v));
        }
      } else if (name == "component") {
        object->components.push_back(placed(tags, tag, path, object_name()));
      }
    }
    if (!seen_model) tags.fail("there is no element model");
    return model;
  }

  // Section 3.4.
  void read_head(const XmlTags& tags, const XmlTag& tag, ModelPart& model) const {
    static constexpr std::array<std::pair<const char*, double>, 6> units{{{"micron", 1e-3},
                                                                          {"millimeter", 1},
                                                                          {"centimeter", 10},
                                                                          {"inch", 25.4},
                                                                          {"foot", 304.8},
                                                                          {"meter", 1000}}};
    const std::string unit = tag.attribute("unit", "millimeter");
    const auto found =
        std::ranges::find_if(units, [&](const auto& known) { return unit == known.first; });
    if (found == units.end()) tags.fail("there is no unit " + in_quotes(unit));
    model.millimetres = found->second;
    const std::string required = tag.attribute("requiredextensions");
    LineScanner words(required, name_, '\0');
    if (!words.next()) return;
    for (std::string_view word; !(word = words.word()).empty();) {
      const std::string space = tag.attribute("xmlns:" + std::string(word));
      if (space.find("/production/") == std::string::npos &&
          space.find("/material/") == std::string::npos)
        throw UnsupportedError(
            tags.name() + ": requires the extension " + in_quotes(space) + ", which is not read",
            "unsupported-file");
    }
  }

  PlacedObject placed(const XmlTags& tags, const XmlTag& tag, const std::string& path,
                      const std::string& where) const {
    PlacedObject out;
    const auto id = parse_integer(tag.attribute("objectid"));
    if (!id) tags.fail(where + " has no whole number 'objectid'");
    out.id = *id;
    out.part = path;
    for (const auto& [key, value] : tag.attributes)
      if (key == "path" || key.ends_with(":path")) out.part = tag.attribute(key);
    if (!tag.has("transform")) return out;
    const std::string text = tag.attribute("transform");
    LineScanner words(text, name_, '\0');
    std::array<double, 12> m{};
    bool good = words.next();
    for (double& x : m) {
      const auto number = parse_double(good ? words.word() : std::string_view());
      good = good && number;
      x = number.value_or(0);
    }
    if (!good || !words.rest_of_line().empty())
      tags.fail(where + ": 'transform' must be 12 numbers");
    out.by.linear = Eigen::Map<const Rows<double, 3>>(m.data(), 3, 3);
    out.by.shift = Eigen::Map<const Eigen::RowVector3d>(m.data() + 9);
    return out;
  }

  // Components may be nested without end, or so that few lines make many copies.
  void place(const PlacedObject& placed, int depth) {
    constexpr int deepest = 100, most = 1000000;
    const std::string where = "object " + std::to_string(placed.id);
    if (depth > deepest) fail(where + ": components stand within each other without end");
    if (++copies_ > most) fail(where + ": components make more than a million copies");
    const ModelPart& model = part(placed.part);
    if (model.millimetres != millimetres_)
      throw UnsupportedError(name_ + ": " + placed.part + " has another unit than the model",
                             "unsupported-file");
    const auto found = model.objects.find(placed.id);
    if (found == model.objects.end()) fail("there is no " + where + " in " + placed.part);
    const PrintedObject& object = found->second;
    const std::size_t first = points_.size() / 3, n = object.coordinates.size() / 3;
    if (first + n > most_ || soup_.corners.size() + object.corners.size() > most_)
      fail(where + ": copies make more than " + std::to_string(most_) + " vertices or corners");
    for (std::size_t v = 0; v < n; ++v) {
      const Eigen::RowVector3d p =
          Eigen::Map<const Eigen::RowVector3d>(&object.coordinates[3 * v]) * placed.by.linear +
          placed.by.shift;
      points_.insert(points_.end(), p.begin(), p.end());
    }
    // A mirror image still has its outside where it was.
    const bool mirrored = placed.by.linear.determinant() < 0;
    for (std::size_t t = 0; t < object.corners.size(); t += 3) {
      std::array<int, 3> face{};
      for (std::size_t k = 0; k < 3; ++k) face[k] = static_cast<int>(first) + object.corners[t + k];
      if (mirrored) std::swap(face[1], face[2]);
      soup_.add_face(face);
    }
    for (const PlacedObject& component : object.components) {
      PlacedObject inner = component;
      inner.by = component.by.then(placed.by);
      place(inner, depth + 1);
    }
  }

  std::vector<ZipMember> members_;
  std::string name_;
  std::size_t most_;
  std::map<std::string, ModelPart> parts_;
  std::vector<double> points_;
  PolygonSoup soup_;
  double millimetres_ = 1;
  int copies_ = 0;
};

}  // namespace

PolygonSoup read_3mf(std::string_view bytes, const std::string& name) {
  return ModelReader(bytes, name).read();
}

}  // namespace littoral::io
