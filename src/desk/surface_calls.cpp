// Surfaces: meshes, sources, distance, lines, regions.

#include <algorithm>
#include <utility>

#include "desk/call.h"
#include "io/render/scene_style.h"

namespace littoral::desk {

namespace {

constexpr const char* sources_name = "sources.json";

json lines_of(Call& call, const std::vector<LevelCurves>& levels) {
  std::vector<double> positions, level_of;
  std::vector<std::uint32_t> offsets{0};
  for (const LevelCurves& curves : levels)
    for (const MatX3& line : curves.lines) {
      positions.insert(positions.end(), line.data(), line.data() + line.size());
      offsets.push_back(static_cast<std::uint32_t>(positions.size() / 3));
      level_of.push_back(curves.level);
    }
  return {{"positions", call.put(positions)},
          {"offsets", call.put(offsets)},
          {"levels", call.put(level_of)}};
}

json lines_of(Call& call, const std::vector<MatX3>& lines) {
  json out = lines_of(call, std::vector<LevelCurves>{{0, lines}});
  out["levels"] = call.put(std::vector<double>());
  return out;
}

PolygonSoup soup_of_triangles(const Call& call, const json& drawn) {
  PolygonSoup soup;
  soup.points = call.points(drawn.at("positions"));
  soup.corners = call.numbers<int>(drawn.at("triangles"));
  for (std::size_t end = 3; end <= soup.corners.size(); end += 3)
    soup.face_offsets.push_back(static_cast<int>(end));
  return soup;
}

/// The first view, as pages and pictures of results have it.
json first_view(const PolygonSoup& soup, const Triangulation& triangles) {
  io::Scene scene;
  scene.points = soup.points;
  scene.triangles = triangles.corners;
  if (scene.triangles.rows() == 0) {
    scene.source_points = soup.points;
    Eigen::Index kept = 0;
    for (Eigen::Index i = 0; i < soup.points.rows(); ++i)
      if (soup.points.row(i).allFinite()) scene.source_points.row(kept++) = soup.points.row(i);
    scene.source_points.conservativeResize(kept, 3);
  }
  const io::SceneFrame frame = io::scene_frame(scene);
  const auto triple = [](const Vec3& v) { return json{v[0], v[1], v[2]}; };
  return {{"centre", triple(frame.centre)},
          {"radius", frame.radius},
          {"towardsEye", triple(frame.towards_eye)},
          {"up", triple(frame.up)}};
}

json made_of_arrays(Call& call) {
  PolygonSoup soup;
  soup.points = call.points(call[0]);
  soup.normals = call.points(call[3]);
  soup.corners = call.numbers<int>(call[1]);
  if (!call[2].is_null()) {
    soup.face_offsets = call.numbers<int>(call[2]);
  } else {
    if (soup.corners.size() % 3 != 0)
      throw InputError("triangles have three corners each, there are " +
                       std::to_string(soup.corners.size()) + " corners");
    for (std::size_t end = 3; end <= soup.corners.size(); end += 3)
      soup.face_offsets.push_back(static_cast<int>(end));
  }
  return made_surface(call, Mesh(std::move(soup)));
}

json loaded(Call& call) {
  json out;
  with_file(call, [&](const auto& path) { out = made_surface(call, read_mesh(path)); });
  return out;
}

/// Sources come and go as the text of a .json source file, but for chains, which it does not hold:
/// arguments 1 and 2.
Sources sources_of(const Call& call, const Mesh& mesh) {
  const std::string text = call.text(1);
  Sources sources = text.empty() ? Sources() : parse_sources(text, sources_name, mesh);
  for (std::size_t k = 0; k < call[2].size(); ++k)
    sources.add(FaceChain{call.numbers<int>(call[2][k]), "chain " + std::to_string(k)});
  return sources;
}

json sources_out(Call& call, const Mesh& mesh, Sources sources) {
  json chains = json::array();
  for (const FaceChain& chain : sources.chains) chains.push_back(call.put(chain.faces));
  sources.chains.clear();
  return {{"json", sources_text(sources, sources_name, mesh)}, {"chains", chains}};
}

json read_source_file(Call& call) {
  const Mesh& mesh = call.object<Mesh>(0);
  return sources_out(call, mesh, parse_sources(call.bytes(1), file_name(call.text(2)), mesh));
}

json write_source_file(Call& call) {
  const Mesh& mesh = call.object<Mesh>(0);
  return sources_text(sources_of(call, mesh), file_name(call.text(3)), mesh);
}

json located(Call& call) {
  const Mesh& mesh = call.object<Mesh>(0);
  const Sources sources = parse_sources(call.text(1), sources_name, mesh);
  MatX3 out(std::ssize(sources.points), 3);
  for (Eigen::Index i = 0; i < out.rows(); ++i) out.row(i) = mesh.position(sources.points[i]);
  return call.put(out);
}

json path_along(Call& call) {
  const Mesh& mesh = call.object<Mesh>(0);
  const Sources sources = parse_sources(call.text(1), sources_name, mesh);
  if (sources.curves.empty()) throw InputError("a path has nodes");
  Sources joined;
  joined.points = path_through(mesh, sources.curves.front().nodes, call.context());
  MatX3 positions(std::ssize(joined.points), 3);
  double length = 0;
  for (Eigen::Index i = 0; i < positions.rows(); ++i) {
    positions.row(i) = mesh.position(joined.points[i]);
    if (i > 0) length += (positions.row(i) - positions.row(i - 1)).norm();
  }
  return {{"json", sources_text(joined, sources_name, mesh)},
          {"positions", call.put(positions)},
          {"length", length}};
}

VecX vector_of(const Call& call, const json& values) {
  const std::vector<double> numbers = call.doubles(values);
  return Eigen::Map<const VecX>(numbers.data(), std::ssize(numbers));
}

/// A field from its values (1), on the mesh or, where there is one, on the refined surface (2).
Field field_of(const Call& call) {
  Field field{call.object<Mesh>(0), {}, vector_of(call, call[1]), {}, {}, {}};
  if (field.values.size() != field.mesh.n_vertices())
    throw InputError("there are " + std::to_string(field.values.size()) + " values for " +
                     std::to_string(field.mesh.n_vertices()) + " vertices");
  if (call[2].is_null()) return field;
  field.refined = soup_of_triangles(call, call[2]);
  field.refined->scalars["distance"] = vector_of(call, call[2].at("scalars").at("distance"));
  return field;
}

json isolines(Call& call) {
  Field field = field_of(call);
  if (field.refined) {
    field.values = field.refined->scalars["distance"];
    field.mesh = Mesh(std::move(*field.refined));
  }
  std::vector<LevelCurves> out;
  for (const double level : call.doubles(call[3])) out.push_back({level, field.isolines(level)});
  return lines_of(call, out);
}

json write_field(Call& call) {
  return written(call, call.text(3), [&](const auto& path) { write(field_of(call), path); });
}

json write_mesh(Call& call) {
  return written(call, call.text(1), [&](const auto& path) { write(call.object<Mesh>(0), path); });
}

json write_lines(Call& call) {
  const json& lines = call[0];
  PolygonSoup soup;
  soup.points = call.points(lines.at("positions"));
  const std::vector<int> offsets = call.numbers<int>(lines.at("offsets"));
  const std::vector<double> levels = call.doubles(lines.at("levels"));
  VecX level_of = VecX::Zero(soup.points.rows());
  for (std::size_t l = 0; l + 1 < offsets.size(); ++l) {
    std::vector<int>& line = soup.lines.emplace_back();
    for (int at = offsets[l]; at < offsets[l + 1]; ++at) {
      if (at < 0 || at >= soup.n_vertices())
        throw InputError("line " + std::to_string(l) + " reaches beyond the points");
      line.push_back(at);
      if (levels.empty()) continue;
      if (l >= levels.size()) throw InputError("line " + std::to_string(l) + " has no level");
      level_of[at] = levels[l];
    }
  }
  if (!levels.empty()) soup.scalars["level"] = level_of;
  return written(call, call.text(1), [&](const auto& path) { write(soup, path); });
}

json info(Call& call) { return info_json(call.object<Mesh>(0)); }

json prepare(Call& call) {
  const DistanceSolver& solver =
      call.make(DistanceSolver(call.object<Mesh>(0), call.method(1, 2), call.context()));
  return {{"report", report_json(solver.report())}};
}

json solve(Call& call) {
  const auto& solver = call.object<DistanceSolver>(0);
  const Field field = solver.solve(sources_of(call, solver.mesh()), call.context());
  return {{"values", call.put(field.values)},
          {"confidence", field.confidence.size() > 0 ? call.put(field.confidence) : json()},
          {"refined", field.refined ? drawn(call, *field.refined) : json()},
          {"report", report_json(field.report)}};
}

json offsets(Call& call) {
  const auto& solver = call.object<DistanceSolver>(0);
  const Sources curves = parse_sources(call.text(1), sources_name, solver.mesh());
  return lines_of(call, offset_curves(solver, curves, call.doubles(call[2]),
                                      {call.number(3), call.number(4)}, call.context()));
}

json regions(Call& call) {
  const Mesh& mesh = call.object<Mesh>(0);
  const Regions found = winding(mesh, sources_of(call, mesh), call.method(3, 4), call.context());
  return {{"region", call.put(found.region)},
          {"surface", drawn(call, found.surface)},
          {"bounding", lines_of(call, found.bounding)},
          {"nonbounding", lines_of(call, found.nonbounding)},
          {"completed", lines_of(call, found.completed)},
          {"boundingSources", sources_out(call, mesh, found.bounding_sources)},
          {"report", report_json(found.report)}};
}

}  // namespace

json drawn(Call& call, const PolygonSoup& soup) {
  const Triangulation triangles = triangulation(soup);
  json scalars = json::object();
  for (const auto& [name, values] : soup.scalars) scalars[name] = call.put(values);
  return {{"positions", call.put(soup.points)},
          {"triangles",
           call.put_indices(triangles.corners.data(), std::size_t(triangles.corners.size()))},
          {"triangleFaces",
           call.put_indices(triangles.polygons.data(), std::size_t(triangles.polygons.size()))},
          {"scalars", scalars}};
}

json made_surface(Call& call, Mesh made) {
  const Mesh& mesh = call.make(std::move(made));
  const PolygonSoup& soup = mesh.soup();
  json out = drawn(call, soup);
  out["warnings"] = oddities(mesh);
  out["kind"] = mesh.kind();
  out["vertices"] = mesh.n_vertices();
  out["faces"] = mesh.n_faces();
  out["edges"] = mesh.n_edges();
  out["components"] = mesh.n_components();
  out["corners"] = call.put_indices(soup.corners.data(), soup.corners.size());
  out["offsets"] = call.put_indices(soup.face_offsets.data(), soup.face_offsets.size());
  out["normals"] = call.put(soup.normals);
  out["up"] = z_is_up(soup.points) ? "z" : "y";
  out["view"] = first_view(soup, triangulation(soup));
  return out;
}

void add_surface_operations(Operations& operations) {
  operations.merge(Operations{{"loadSurface", loaded},
                              {"makeSurface", made_of_arrays},
                              {"info", info},
                              {"readSources", read_source_file},
                              {"writeSources", write_source_file},
                              {"locate", located},
                              {"path", path_along},
                              {"isolines", isolines},
                              {"writeMesh", write_mesh},
                              {"writeField", write_field},
                              {"writeLines", write_lines},
                              {"prepare", prepare},
                              {"solve", solve},
                              {"offsets", offsets},
                              {"regions", regions}});
}

}  // namespace littoral::desk
