// What there is: methods, formats; and conversions that the other files share.

#include "bindings.h"

namespace littoral::web {

AnyMethod method_of(const std::string& name, const val& options) {
  OptionValues values;
  const val names = val::global("Object").call<val>("keys", options);
  const auto n = names["length"].as<std::size_t>();
  for (std::size_t k = 0; k < n; ++k)
    values.emplace_back(names[k].as<std::string>(), options[names[k]].as<std::string>());
  return name.empty() && values.empty() ? AnyMethod() : AnyMethod::named(name, values);
}

val lines_of(const std::vector<LevelCurves>& levels) {
  std::vector<double> positions, level_of;
  std::vector<unsigned> offsets{0};
  for (const LevelCurves& curves : levels)
    for (const MatX3& line : curves.lines) {
      positions.insert(positions.end(), line.data(), line.data() + line.size());
      offsets.push_back(static_cast<unsigned>(positions.size() / 3));
      level_of.push_back(curves.level);
    }
  val out = val::object();
  out.set("positions", array_of(positions.data(), positions.size()));
  out.set("offsets", array_of(offsets.data(), offsets.size()));
  out.set("levels", array_of(level_of.data(), level_of.size()));
  return out;
}

val lines_of(const std::vector<MatX3>& lines) {
  val out = lines_of(std::vector<LevelCurves>{{0, lines}});
  out.set("levels", array_of<double>(nullptr, 0));
  return out;
}

val drawn(const PolygonSoup& soup) {
  const Triangulation triangles = triangulation(soup);
  val out = val::object(), scalars = val::object();
  for (const auto& [name, values] : soup.scalars) scalars.set(name, array_of(values));
  out.set("positions", array_of(soup.points));
  out.set("triangles", array_of(reinterpret_cast<const unsigned*>(triangles.corners.data()),
                                static_cast<std::size_t>(triangles.corners.size())));
  out.set("triangleFaces", array_of(reinterpret_cast<const unsigned*>(triangles.polygons.data()),
                                    static_cast<std::size_t>(triangles.polygons.size())));
  out.set("scalars", scalars);
  return out;
}

PolygonSoup soup_of_triangles(const val& drawn) {
  PolygonSoup soup;
  soup.points = points_of(drawn["positions"]);
  soup.corners = numbers_of<int>(drawn["triangles"]);
  for (std::size_t end = 3; end <= soup.corners.size(); end += 3)
    soup.face_offsets.push_back(static_cast<int>(end));
  return soup;
}

namespace {

val about() {
  val out = val::object();
  out.set("version", std::string(LITTORAL_VERSION));
  out.set("methods", methods_json(method_families()));
  out.set("surfaces", mesh_extensions());
  out.set("volumes", volume_extensions());
  out.set("sources", sources_extensions());
  return out;
}

}  // namespace

}  // namespace littoral::web

EMSCRIPTEN_BINDINGS(littoral_module) { emscripten::function("about", littoral::web::about); }
