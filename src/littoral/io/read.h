#pragma once
// Reading files. Every reader answers any bytes with a value or an InputError naming file and line.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "littoral/base/report.h"
#include "littoral/domain/polygon_soup.h"
#include "littoral/domain/surface_mesh.h"
#include "littoral/sources/surface_sources.h"

namespace littoral::io {

/// Reads .obj .off .ply .stl by extension (any case). STL corners that are bit-equal are merged.
PolygonSoup read_surface(const std::filesystem::path& path);

/// The same from memory; `name` is used in messages, `extension` is ".obj" and so on. Never
/// allocates more than a small multiple of bytes.size().
PolygonSoup read_surface_bytes(std::string_view bytes, const std::string& extension,
                               const std::string& name);

/// Reads sources for a mesh: signed-heat .txt, surface-winding-number .txt, .obj/.ply with lines
/// (on the mesh's own vertices when the file is the mesh itself, otherwise free polylines in
/// space), .json. `index_base` overrides the formats' own bases. Warnings go to the report.
SurfaceSources read_sources(const std::filesystem::path& path, const SurfaceMesh& mesh,
                            std::optional<int> index_base, Report& report);
SurfaceSources read_sources_bytes(std::string_view bytes, const std::string& extension,
                                  const std::string& name, const SurfaceMesh& mesh,
                                  std::optional<int> index_base, Report& report);

/// The polylines of a mesh file's own `l` lines, as signed curves.
SurfaceSources sources_from_lines(const PolygonSoup& soup, const std::string& name);

/// Whole file; throws IoError naming it (missing, unreadable, a directory).
std::string read_bytes(const std::filesystem::path& path);

}  // namespace littoral::io
