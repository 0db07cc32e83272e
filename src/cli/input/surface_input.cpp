#include "cli/input/surface_input.h"

#include "base/option_table.h"
#include "domain/volume/voxels.h"
#include "io/formats.h"
#include "io/read.h"
#include "littoral/error.h"

namespace littoral::cli {

SurfaceMesh read_mesh(const std::filesystem::path& path) {
  return mesh_of(io::read_surface(path), path);
}

SurfaceInput read_domain(const std::filesystem::path& path) {
  io::format_to_read(io::extension_to_read(path), path.string(),
                     {io::Kind::surface, io::Kind::cloud, io::Kind::voxels});
  if (!io::holds(path, io::Kind::voxels)) return {read_mesh(path)};
  const io::VoxelMask mask = io::read_voxels(path);
  VoxelSurface surface = boundary_of_voxels(mask.grid, mask.inside);
  return {std::move(surface.mesh), std::move(surface.face_normals)};
}

SurfaceMesh mesh_of(PolygonSoup soup, const std::filesystem::path& path) {
  try {
    return SurfaceMesh(std::move(soup));
  } catch (const InputError& e) {
    throw InputError(path.filename().string() + ": " + e.what(), e.code());
  }
}

Sources read_all_sources(const std::vector<std::string>& files, const SurfaceMesh& mesh,
                         Session& session) {
  Sources all;
  for (const std::string& file : files)
    all.add(io::read_sources(file, mesh, session.index_base, session.report));
  return all;
}

PolygonSoup read_surfaces(const std::vector<std::string>& files) {
  PolygonSoup all;
  for (const std::string& file : files) {
    const PolygonSoup more = io::read_surface(file);
    if (all.n_vertices() > 0 && (more.n_faces() > 0) != (all.n_faces() > 0))
      throw InputError(
          "option sources: " + file + " is a cloud and others are meshes, or the other way round",
          "options-conflict");
    const int first = all.n_vertices();
    const auto append = [first](MatX3& to, const MatX3& from) {
      to.conservativeResize(first + from.rows(), 3);
      to.bottomRows(from.rows()) = from;
    };
    append(all.points, more.points);
    if (more.n_faces() == 0) {
      if (more.normals.rows() == 0)
        throw InputError(file + " has neither faces nor normals", "no-normals");
      append(all.normals, more.normals);
    }
    for (int f = 0; f < more.n_faces(); ++f) {
      for (int v : more.face(f)) all.corners.push_back(first + v);
      all.face_offsets.push_back(static_cast<int>(all.corners.size()));
    }
  }
  return all;
}

std::vector<int> checked_vertices(const std::vector<long long>& given, int n_vertices,
                                  const std::string& file, const Session& session) {
  const long long base = session.index_base.value_or(0);
  std::vector<int> vertices;
  for (long long v : given) {
    if (v < base || v - base >= n_vertices)
      throw InputError("option vertex: there is no vertex " + std::to_string(v) + "; " + file +
                           " has " + std::to_string(n_vertices) + ", counted from " +
                           std::to_string(base),
                       "no-such-element");
    vertices.push_back(static_cast<int>(v - base));
  }
  return vertices;
}

std::string choose_field(const PolygonSoup& soup, const std::string& wanted,
                         const std::string& file, bool optional) {
  const std::string known = listed_names(soup.scalars);
  if (!wanted.empty()) {
    if (soup.scalars.count(wanted) != 0) return wanted;
    throw InputError(
        file + " has no field '" + wanted + "'; it has: " + (known.empty() ? "none" : known),
        "unknown-name");
  }
  for (const char* name : {"distance", "u"})
    if (soup.scalars.count(name) != 0) return name;
  if (soup.scalars.size() == 1) return soup.scalars.begin()->first;
  if (optional) return "";
  throw InputError(known.empty()
                       ? file + " holds no field with one value per vertex"
                       : file + " has the fields " + known + ": choose one with option field",
                   "no-field");
}

}  // namespace littoral::cli
