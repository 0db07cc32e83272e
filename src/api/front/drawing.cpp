#include "littoral/drawing.h"

#include <filesystem>
#include <utility>

#include "api/front/prepared.h"
#include "api/front/running.h"
#include "api/report_json.h"
#include "api/surface/level_lines.h"
#include "api/surface/mesh_info.h"
#include "api/surface/surface_domain.h"
#include "base/index.h"
#include "io/formats.h"
#include "io/read.h"
#include "io/render/scene_style.h"
#include "io/sources/write_sources.h"
#include "littoral/error.h"
#include "sources/curves/trace.h"
#include "spatial/finite_box.h"
#include "spatial/triangulate.h"

namespace littoral {

Triangulation triangulation(const PolygonSoup& surface) {
  Triangulation out{triangles_of(triangulate(surface)), {}};
  out.polygons.resize(out.corners.rows());
  Eigen::Index t = 0;
  for (int f = 0; f < surface.n_faces(); ++f)
    for (std::size_t cut = 2; cut < surface.face(f).size(); ++cut) out.polygons[t++] = f;
  return out;
}

bool z_is_up(const MatX3& points) {
  const Eigen::AlignedBox3d box = finite_box(points);
  return !box.isEmpty() && io::upright_axis(box.min(), box.max())[2] > 0;
}

std::vector<SurfacePoint> path_through(const Mesh& mesh, const std::vector<SurfacePoint>& nodes,
                                       const Context& context) {
  return run(context, [&](Task task) {
    const Tracer tracer(*mesh.domain().mesh);
    std::vector<SurfacePoint> path;
    if (nodes.size() == 1) path.push_back(simplest(*mesh.domain().mesh, nodes[0]));
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      const Task stage = task.stage(1.0 / static_cast<double>(nodes.size() - 1), "joining nodes");
      const std::vector<SurfacePoint> piece = tracer.trace(nodes[k - 1], nodes[k], stage);
      path.insert(path.end(), piece.begin() + (path.empty() ? 0 : 1), piece.end());
    }
    return path;
  });
}

std::vector<LevelCurves> offset_curves(const DistanceSolver& solver, const Sources& curves,
                                       const std::vector<double>& distances,
                                       const Morphology& morphology, const Context& context) {
  return run(context, [&](const Task& task) {
    const SurfaceMesh& mesh = *solver.mesh().domain().mesh;
    Report report;
    std::vector<LevelCurves> out;
    for (const LevelLines& level : offset_lines(*solver.prepared().solver, mesh, curves, distances,
                                                morphology, report, task)) {
      LevelCurves& found = out.emplace_back(LevelCurves{level.level, {}});
      for (const Polyline& line : level.lines) found.lines.push_back(polyline_points(mesh, line));
    }
    return out;
  });
}

Sources parse_sources(std::string_view bytes, const std::string& name, const Mesh& mesh) {
  Report report;
  return io::read_sources_bytes(bytes, std::filesystem::path(name).extension().string(), name,
                                *mesh.domain().mesh, std::nullopt, report);
}

std::string sources_text(const Sources& sources, const std::string& name, const Mesh& mesh) {
  if (io::has_extension(name, ".txt")) return io::sources_txt(sources, *mesh.domain().mesh);
  if (io::has_extension(name, ".json")) return io::sources_json(sources, *mesh.domain().mesh);
  throw UnsupportedError(name + ": sources are written as .txt or .json", "unsupported-file");
}

std::string info_json(const Mesh& mesh) { return info_json(surface_info(mesh.soup())); }

std::vector<std::string> oddities(const Mesh& mesh) {
  if (mesh.n_faces() == 0) return {};
  const std::pair<const char*, const char*> counted[] = {
      {"isolated_vertices", " vertices belong to no face"},
      {"boundary_edges", " edges lie on a boundary"},
      {"nonmanifold_edges", " edges have more than two faces"},
      {"nonmanifold_vertices", " vertices join parts that share no edge there"},
      {"inconsistently_oriented_edges", " edges have faces that turn opposite ways"},
      {"degenerate_faces", " faces are degenerate"},
      {"duplicate_faces", " faces repeat another"},
      {"vertices_not_finite", " vertices are not finite"}};
  std::vector<std::string> out;
  for (const InfoEntry& fact : surface_info(mesh.soup())) {
    for (const auto& [key, text] : counted)
      if (const double* n = std::get_if<double>(&fact.value); fact.key == key && n && *n > 0)
        out.push_back(std::to_string(static_cast<long long>(*n)) + text);
    if (fact.key == "components" && mesh.n_components() > 1)
      out.push_back(std::to_string(mesh.n_components()) + " components are apart from each other");
    if (const bool* is = std::get_if<bool>(&fact.value); fact.key == "orientable" && is && !*is)
      out.emplace_back("the surface cannot be oriented");
  }
  return out;
}

std::string sources_extensions() { return io::read_extensions({io::Kind::sources}); }
std::string volume_extensions() { return io::read_extensions({io::Kind::volume}); }

}  // namespace littoral
