// Surfaces: meshes, sources, distance, lines, regions.

#include "bindings.h"

namespace littoral::web {

namespace {

constexpr const char* sources_name = "sources.json";

val made(const val& positions, const val& corners, const val& offsets, const val& normals) {
  return answered([&] {
    PolygonSoup soup;
    soup.points = points_of(positions);
    soup.normals = points_of(normals);
    soup.corners = numbers_of<int>(corners);
    if (!offsets.isUndefined()) {
      soup.face_offsets = numbers_of<int>(offsets);
    } else {
      if (soup.corners.size() % 3 != 0)
        throw InputError("triangles have three corners each, there are " +
                         std::to_string(soup.corners.size()) + " corners");
      for (std::size_t end = 3; end <= soup.corners.size(); end += 3)
        soup.face_offsets.push_back(static_cast<int>(end));
    }
    return val(Mesh(std::move(soup)));
  });
}

val described(const Mesh& mesh) {
  return answered([&] {
    const PolygonSoup& soup = mesh.soup();
    val out = drawn(soup), warnings = val::array();
    for (const std::string& text : oddities(mesh)) warnings.call<void>("push", text);
    out.set("kind", mesh.kind());
    out.set("vertices", mesh.n_vertices());
    out.set("faces", mesh.n_faces());
    out.set("edges", mesh.n_edges());
    out.set("components", mesh.n_components());
    out.set("corners",
            array_of(reinterpret_cast<const unsigned*>(soup.corners.data()), soup.corners.size()));
    out.set("offsets", array_of(reinterpret_cast<const unsigned*>(soup.face_offsets.data()),
                                soup.face_offsets.size()));
    out.set("normals", array_of(soup.normals));
    out.set("up", std::string(z_is_up(soup.points) ? "z" : "y"));
    out.set("warnings", warnings);
    return out;
  });
}

/// Sources come and go as the text of a .json source file, but for chains, which it does not hold.
Sources sources_of(const Mesh& mesh, const std::string& json, const val& chains) {
  const auto n = chains["length"].as<std::size_t>();
  Sources sources = json.empty() ? Sources() : parse_sources(json, sources_name, mesh);
  for (std::size_t k = 0; k < n; ++k)
    sources.add(FaceChain{numbers_of<int>(chains[k]), "chain " + std::to_string(k)});
  return sources;
}

val sources_out(const Mesh& mesh, Sources sources) {
  val out = val::object(), chains = val::array();
  for (const FaceChain& chain : sources.chains)
    chains.call<void>("push", array_of(chain.faces.data(), chain.faces.size()));
  sources.chains.clear();
  out.set("json", sources_text(sources, sources_name, mesh));
  out.set("chains", chains);
  return out;
}

val read_source_file(const Mesh& mesh, const std::string& bytes, const std::string& name) {
  return answered([&] { return sources_out(mesh, parse_sources(bytes, name, mesh)); });
}

val write_source_file(const Mesh& mesh, const std::string& json, const val& chains,
                      const std::string& name) {
  return answered([&] { return val(sources_text(sources_of(mesh, json, chains), name, mesh)); });
}

val located(const Mesh& mesh, const std::string& json) {
  return answered([&] {
    const Sources sources = parse_sources(json, sources_name, mesh);
    MatX3 out(std::ssize(sources.points), 3);
    for (Eigen::Index i = 0; i < out.rows(); ++i)
      out.row(i) = mesh.position(sources.points[static_cast<std::size_t>(i)]);
    return array_of(out);
  });
}

val path(const Mesh& mesh, const std::string& json, const val& progress) {
  return answered([&] {
    const Sources sources = parse_sources(json, sources_name, mesh);
    Sources joined;
    joined.points = path_through(mesh, sources.curves.at(0).nodes, context_of(progress));
    MatX3 positions(std::ssize(joined.points), 3);
    double length = 0;
    for (Eigen::Index i = 0; i < positions.rows(); ++i) {
      positions.row(i) = mesh.position(joined.points[static_cast<std::size_t>(i)]);
      if (i > 0) length += (positions.row(i) - positions.row(i - 1)).norm();
    }
    val out = val::object();
    out.set("json", sources_text(joined, sources_name, mesh));
    out.set("positions", array_of(positions));
    out.set("length", length);
    return out;
  });
}

/// A field from its values, on the mesh or, where there is one, on the refined surface.
Field field_of(const Mesh& mesh, const val& values, const val& refined) {
  const std::vector<double> numbers = numbers_of<double>(values);
  Field field{mesh, {}, Eigen::Map<const VecX>(numbers.data(), std::ssize(numbers)), {}, {}, {}};
  if (field.values.size() != mesh.n_vertices())
    throw InputError("there are " + std::to_string(numbers.size()) + " values for " +
                     std::to_string(mesh.n_vertices()) + " vertices");
  if (refined.isNull() || refined.isUndefined()) return field;
  field.refined = soup_of_triangles(refined);
  const std::vector<double> finer = numbers_of<double>(refined["scalars"]["distance"]);
  field.refined->scalars["distance"] = Eigen::Map<const VecX>(finer.data(), std::ssize(finer));
  return field;
}

val isolines(const Mesh& mesh, const val& values, const val& refined, const val& levels) {
  return answered([&] {
    Field field = field_of(mesh, values, refined);
    if (field.refined) {
      field.values = field.refined->scalars["distance"];
      field.mesh = Mesh(std::move(*field.refined));
    }
    std::vector<LevelCurves> out;
    for (const double level : numbers_of<double>(levels))
      out.push_back({level, field.isolines(level)});
    return lines_of(out);
  });
}

val write_field(const Mesh& mesh, const val& values, const val& refined, const std::string& path) {
  return answered([&] {
    write(field_of(mesh, values, refined), path);
    return val::undefined();
  });
}

val write_mesh(const Mesh& mesh, const std::string& path) {
  return answered([&] {
    write(mesh, path);
    return val::undefined();
  });
}

val write_lines(const val& lines, const std::string& path) {
  return answered([&] {
    PolygonSoup soup;
    soup.points = points_of(lines["positions"]);
    const std::vector<int> offsets = numbers_of<int>(lines["offsets"]);
    const std::vector<double> levels = numbers_of<double>(lines["levels"]);
    VecX level_of = VecX::Zero(soup.points.rows());
    for (std::size_t l = 0; l + 1 < offsets.size(); ++l) {
      std::vector<int>& line = soup.lines.emplace_back();
      for (int at = offsets[l]; at < offsets[l + 1]; ++at) {
        if (at < 0 || at >= soup.n_vertices())
          throw InputError("line " + std::to_string(l) + " reaches beyond the points");
        line.push_back(at);
        if (!levels.empty()) level_of[at] = levels.at(l);
      }
    }
    if (!levels.empty()) soup.scalars["level"] = level_of;
    write(soup, path);
    return val::undefined();
  });
}

val info(const Mesh& mesh) {
  return answered([&] { return val(info_json(mesh)); });
}

val prepare(const Mesh& mesh, const std::string& method, const val& options, const val& progress) {
  return answered(
      [&] { return val(DistanceSolver(mesh, method_of(method, options), context_of(progress))); });
}

val solver_report(const DistanceSolver& solver) {
  return answered([&] { return val(report_json(solver.report())); });
}

val solve(const DistanceSolver& solver, const std::string& json, const val& chains,
          const val& progress) {
  return answered([&] {
    const Field field = solver.solve(sources_of(solver.mesh(), json, chains), context_of(progress));
    val out = val::object();
    out.set("values", array_of(field.values));
    out.set("confidence", field.confidence.size() > 0 ? array_of(field.confidence) : val::null());
    out.set("refined", field.refined ? drawn(*field.refined) : val::null());
    out.set("report", report_json(field.report));
    return out;
  });
}

val offsets(const DistanceSolver& solver, const std::string& json, const val& distances,
            double open, double close, const val& progress) {
  return answered([&] {
    return lines_of(offset_curves(solver, sources_of(solver.mesh(), json, val::array()),
                                  numbers_of<double>(distances), {open, close},
                                  context_of(progress)));
  });
}

val regions(const Mesh& mesh, const std::string& json, const val& chains, const std::string& method,
            const val& options, const val& progress) {
  return answered([&] {
    const Regions found = winding(mesh, sources_of(mesh, json, chains), method_of(method, options),
                                  context_of(progress));
    val out = val::object();
    out.set("region", array_of(found.region));
    out.set("surface", drawn(found.surface));
    out.set("bounding", lines_of(found.bounding));
    out.set("nonbounding", lines_of(found.nonbounding));
    out.set("completed", lines_of(found.completed));
    out.set("boundingSources", sources_out(mesh, found.bounding_sources));
    out.set("report", report_json(found.report));
    return out;
  });
}

val read_surface(const std::string& path) {
  return answered([&] { return val(read_mesh(path)); });
}

}  // namespace

}  // namespace littoral::web

EMSCRIPTEN_BINDINGS(littoral_surfaces) {
  using namespace littoral::web;  // NOLINT: the module's only scope
  emscripten::class_<littoral::Mesh>("Mesh");
  emscripten::class_<littoral::DistanceSolver>("DistanceSolver");
  emscripten::function("made", made);
  emscripten::function("readSurface", read_surface);
  emscripten::function("described", described);
  emscripten::function("info", info);
  emscripten::function("readSourceFile", read_source_file);
  emscripten::function("writeSourceFile", write_source_file);
  emscripten::function("located", located);
  emscripten::function("path", path);
  emscripten::function("isolines", isolines);
  emscripten::function("writeMesh", write_mesh);
  emscripten::function("writeField", write_field);
  emscripten::function("writeLines", write_lines);
  emscripten::function("prepare", prepare);
  emscripten::function("solverReport", solver_report);
  emscripten::function("solve", solve);
  emscripten::function("offsets", offsets);
  emscripten::function("regions", regions);
}
