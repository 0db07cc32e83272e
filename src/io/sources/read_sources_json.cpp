// Sources as JSON.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "base/index.h"
#include "io/sources/source_nodes.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

using Json = nlohmann::json;

class JsonReader {
 public:
  JsonReader(const std::string& name, const SurfaceMesh& mesh, std::optional<int> base)
      : name_(name), make_(mesh, [this] { return name_ + ": " + at_; }), base_(base.value_or(0)) {}

  Sources read(const Json& root) {
    at_ = "the document";
    expect_keys(root, {"curves", "points"});
    if (root.contains("curves")) {
      expect_array(root["curves"], "curves");
      std::size_t i = 0;
      for (const Json& curve : root["curves"]) read_curve(curve, i++);
    }
    if (root.contains("points")) {
      expect_array(root["points"], "points");
      std::size_t i = 0;
      for (const Json& node : root["points"]) {
        at_ = "points[" + std::to_string(i++) + "]";
        const double value = value_of(node);
        sources_.add(read_node(node, true), value);
      }
    }
    return std::move(sources_);
  }

 private:
  [[noreturn]] void fail(const std::string& text) const { make_.fail(text); }

  void expect_keys(const Json& value, const std::vector<std::string>& known) const {
    if (!value.is_object()) fail("expected an object");
    for (const auto& [key, unused] : value.items()) {
      if (std::find(known.begin(), known.end(), key) == known.end()) {
        fail("unknown key " + in_quotes(key));
      }
    }
  }
  void expect_array(const Json& value, const char* what) const {
    if (!value.is_array()) fail(std::string("'") + what + "' must be an array");
  }
  bool flag(const Json& curve, const char* key, bool fallback) const {
    if (!curve.contains(key)) return fallback;
    if (!curve[key].is_boolean()) fail(std::string("'") + key + "' must be true or false");
    return curve[key].get<bool>();
  }
  std::int64_t index(const Json& value) const {
    // Numbers beyond 63 bits are stored as unsigned and would wrap.
    const bool huge = value.is_number_unsigned() && value.get<std::uint64_t>() > INT32_MAX;
    if (!value.is_number_integer() || huge) fail("expected an index");
    return value.get<std::int64_t>();
  }
  double number(const Json& value) const {
    if (!value.is_number()) fail("expected a number");
    return value.get<double>();
  }
  /// What distance is counted from.
  double value_of(const Json& source) const {
    if (!source.is_object() || !source.contains("value")) return 0;
    const double value = number(source["value"]);
    if (!std::isfinite(value)) fail("the value is not finite");
    return value;
  }
  const Json& array_of(const Json& value, std::size_t size) const {
    if (!value.is_array() || value.size() != size) {
      fail("expected an array of " + std::to_string(size) + " numbers");
    }
    return value;
  }

  SurfacePoint read_node(const Json& node, bool may_have_value) const {
    expect_keys(node, {"v", "e", "t", "f", "b", "value"});
    const std::size_t size = node.size() - (may_have_value && node.contains("value") ? 1 : 0);
    if (node.contains("v") && size == 1) return make_.vertex(index(node["v"]), base_);
    if (node.contains("e") && node.contains("t") && size == 2) {
      const Json& edge = array_of(node["e"], 2);
      return make_.edge(index(edge[0]), index(edge[1]), number(node["t"]), base_);
    }
    if (node.contains("f") && node.contains("b") && size == 2) {
      const Json& b = array_of(node["b"], 3);
      return make_.face(index(node["f"]), {number(b[0]), number(b[1]), number(b[2])}, base_);
    }
    fail(R"(a node is {"v":i}, {"e":[i,j],"t":t} or {"f":i,"b":[a,b,c]})");
  }

  void read_curve(const Json& curve, std::size_t i) {
    const std::string origin = "curves[" + std::to_string(i) + "]";
    at_ = origin;
    expect_keys(curve, {"signed", "closed", "points", "nodes", "value"});
    if (curve.contains("points") == curve.contains("nodes")) {
      fail("a curve has either 'points' (in space) or 'nodes' (on the mesh)");
    }
    const char* kind = curve.contains("points") ? "points" : "nodes";
    const bool is_signed = flag(curve, "signed", true), closed = flag(curve, "closed", false);
    const double value = value_of(curve);
    const Json& items = curve[kind];
    expect_array(items, kind);
    if (items.size() < 2) {
      fail("the curve has " + counted(items.size(), "node", "nodes") + ", at least 2 are needed");
    }
    const auto name_item = [&](std::size_t k) {
      at_ = origin + "." + kind + "[" + std::to_string(k) + "]";
    };
    if (curve.contains("nodes")) {
      Curve result{{}, is_signed, name_ + ":" + origin, value};
      for (std::size_t k = 0; k < items.size(); ++k) {
        name_item(k);
        result.nodes.push_back(read_node(items[k], false));
      }
      if (closed) result.nodes.push_back(result.nodes.front());
      sources_.curves.push_back(std::move(result));
    } else {
      const auto n = index(items.size());
      SpaceCurve result{MatX3(closed ? n + 1 : n, 3), is_signed, name_ + ":" + origin, value};
      for (std::size_t k = 0; k < items.size(); ++k) {
        name_item(k);
        const Json& p = array_of(items[k], 3);
        result.points.row(index(k)) << number(p[0]), number(p[1]), number(p[2]);
      }
      if (closed) result.points.row(n) = result.points.row(0);
      sources_.space_curves.push_back(std::move(result));
    }
  }

  const std::string& name_;
  std::string at_;  // the element being read
  NodeMaker make_;
  int base_;
  Sources sources_;
};

}  // namespace

Sources read_sources_json(std::string_view bytes, const std::string& name, const SurfaceMesh& mesh,
                          std::optional<int> index_base) {
  const std::string_view text = without_byte_order_mark(bytes, name);
  // Each bracket of a deep nest takes many times its byte in memory, and no valid file has more
  // than 5.
  const auto check_depth = [&](int depth, Json::parse_event_t, const Json&) {
    if (depth > 8) throw InputError(name + ": the JSON is nested too deeply", "bad-file");
    return true;
  };
  Json root;
  try {
    root = Json::parse(text.begin(), text.end(), check_depth);
  } catch (const Json::parse_error& error) {
    throw InputError(name + ": byte " + std::to_string(error.byte) + ": not valid JSON",
                     "bad-file");
  } catch (const Json::exception&) {  // a number beyond the doubles
    throw InputError(name + ": a number in it is out of range", "bad-file");
  }
  return JsonReader(name, mesh, index_base).read(root);
}

}  // namespace littoral::io
