// Shapes made anew: repaired surfaces, and samples for learning.

#include <algorithm>

#include "desk/call.h"

namespace littoral::desk {

namespace {

/// Numbers and flags by name, each of which has to be one of those there are.
class Named {
 public:
  explicit Named(const json& values) : values_(values) {}

  bool has(const char* name) {
    known_.emplace_back(name);
    return values_.is_object() && values_.contains(name) && !values_[name].is_null();
  }
  const json& operator[](const char* name) const { return values_[name]; }
  void read(const char* name, double& into) {
    if (has(name)) into = Call::number_of(values_[name]);
  }
  template <class Whole>
  void read_whole(const char* name, Whole& into, double most) {
    if (!has(name)) return;
    const double x = Call::number_of(values_[name]);
    if (!(x >= 0 && x <= most) || x != std::floor(x))
      throw InputError(std::string(name) + " is a whole number, not " + std::to_string(x));
    into = static_cast<Whole>(x);
  }
  void read(const char* name, bool& into) {
    if (!has(name)) return;
    if (!values_[name].is_boolean()) throw InputError(std::string(name) + " is true or false");
    into = values_[name].get<bool>();
  }
  /// After all that there is has been read.
  void check() const {
    if (!values_.is_object()) return;
    for (const auto& [name, value] : values_.items())
      if (std::find(known_.begin(), known_.end(), name) == known_.end())
        throw InputError("there is no option '" + name + "'");
  }

 private:
  const json& values_;
  std::vector<std::string> known_;
};

json repaired(Call& call) {
  RepairOptions options;
  Named named(call[5]);
  constexpr double most_nodes = 4096;
  if (named.has("resolution"))
    named.read_whole("resolution", options.grid.resolution.emplace(), most_nodes);
  if (named.has("spacing")) named.read("spacing", options.grid.spacing.emplace());
  named.read("error", options.error);
  named.read("thicken", options.thicken);
  named.read("smallestPart", options.smallest_part);
  named.read("cavities", options.cavities);
  named.read("remesh", options.remesh);
  named.read("fit", options.fit);
  named.check();
  Repaired made = repair(call.object<Mesh>(0).soup(), options, call.method(1, 2),
                         {call.flag(3), call.flag(4)}, call.context());
  json out = made_surface(call, std::move(made.surface));
  out["report"] = report_json(made.report);
  return out;
}

SampleOptions sample_options(const Call& call, const json& values) {
  SampleOptions options;
  Named named(values);
  constexpr double most_points = 1e9, most_seed = 9007199254740991;
  named.read_whole("resolution", options.resolution, most_points);
  named.read_whole("surface", options.surface, most_points);
  named.read_whole("space", options.space, most_points);
  named.read("sharp", options.sharp);
  named.read("uniform", options.uniform);
  named.read("curvature", options.curvature);
  if (named.has("scales")) options.scales = call.doubles(named["scales"]);
  named.read("margin", options.margin);
  named.read_whole("seed", options.seed, most_seed);
  if (named.has("numbers")) {
    const std::vector<std::string> words{"float16", "float32", "float64"};
    const auto found = std::find(words.begin(), words.end(), named["numbers"]);
    if (found == words.end()) throw InputError("numbers are float16, float32 or float64");
    options.numbers = static_cast<SampleNumbers>(found - words.begin());
  }
  named.check();
  return options;
}

json kinds_out(Call& call, const std::vector<SampleKind>& kinds) {
  return call.put(reinterpret_cast<const unsigned char*>(kinds.data()), kinds.size());
}

json sampled_shape(Call& call) {
  const std::string name = call.text(6), input = file_name(call.text(7));
  if (name.ends_with(".zarr"))
    throw UnsupportedError(name + " would be a folder: samples are given as .npz or .tar");
  const Samples made = sample(call.object<Mesh>(0).soup(), sample_options(call, call[5]),
                              call.method(1, 2), {call.flag(3), call.flag(4)}, call.context());
  json out{{"centre", {made.centre[0], made.centre[1], made.centre[2]}},
           {"halfSide", made.half_side},
           {"surfacePoints", call.put(made.surface_points)},
           {"surfaceNormals", call.put(made.surface_normals)},
           {"surfaceConfidence", call.put(made.surface_confidence)},
           {"surfaceKinds", kinds_out(call, made.surface_kinds)},
           {"points", call.put(made.points)},
           {"distances", call.put(made.distances)},
           {"confidence", call.put(made.confidence)},
           {"kinds", kinds_out(call, made.kinds)},
           {"deviations", call.put(made.deviations)},
           {"card", samples_card(made, input)},
           {"report", report_json(made.report)}};
  out["file"] = written(call, name, [&](const auto& path) { write(made, path, input); });
  return out;
}

}  // namespace

void add_shape_operations(Operations& operations) {
  operations.merge(Operations{{"repair", repaired}, {"samples", sampled_shape}});
}

}  // namespace littoral::desk
