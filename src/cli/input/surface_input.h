#pragma once
// Reading a surface and the sources on it, as several verbs do.

#include <filesystem>
#include <string>
#include <vector>

#include "cli/session.h"
#include "domain/mesh/surface_mesh.h"
#include "littoral/polygon_soup.h"
#include "littoral/sources.h"

namespace littoral::cli {

/// Reads a surface and its connectivity; errors about the mesh name the file.
SurfaceMesh read_mesh(const std::filesystem::path& path);
SurfaceMesh mesh_of(PolygonSoup soup, const std::filesystem::path& path);

/// A surface of any kind: the boundary of voxels has normals of its own.
struct SurfaceInput {
  SurfaceMesh mesh;
  MatX3 face_normals{0, 3};
  const MatX3* normals() const { return face_normals.rows() ? &face_normals : nullptr; }
};
SurfaceInput read_domain(const std::filesystem::path& path);

/// All sources of several files together.
Sources read_all_sources(const std::vector<std::string>& files, const SurfaceMesh& mesh,
                         Session& session);

/// Sources without a file, as given.
struct NamedSources {
  std::vector<long long> vertices;
  std::vector<std::string> at, faces, edges, curves;
  bool empty() const {
    return vertices.empty() && at.empty() && faces.empty() && edges.empty() && curves.empty();
  }
};
/// Adds --vertex, --at, --face, --edge and --curve-vertices.
void add_named_sources(CLI::App& verb, NamedSources& named);
/// Adds --curve-vertices alone.
void add_named_curves(CLI::App& verb, NamedSources& named);
/// The sources on a mesh. Throws InputError for an element that the mesh of `file` has not.
Sources named_sources(const NamedSources& named, const SurfaceMesh& mesh, const std::string& file,
                      Session& session);

/// The surfaces of several files in one soup, or the clouds; not both.
PolygonSoup read_surfaces(const std::vector<std::string>& files);

/// Vertices given as options, counted as the session says; throws InputError naming one that the
/// mesh has not.
std::vector<int> checked_vertices(const std::vector<long long>& given, int n_vertices,
                                  const std::string& file, const Session& session);

/// The scalar to use: `wanted`, or without that "distance", an OBJ's texture "u", or the only one.
/// Throws InputError listing those that exist; with `optional` an empty name where there is none.
std::string choose_field(const PolygonSoup& soup, const std::string& wanted,
                         const std::string& file, bool optional = false);

}  // namespace littoral::cli
