#pragma once
// Sources as text that the readers take.

#include <string>

#include "domain/mesh/surface_mesh.h"
#include "littoral/sources.h"

namespace littoral::io {

/// The signed-heat format with a line for each node; chains of faces alone in the winding number
/// format. Throws UnsupportedError for curves in space and for chains beside other sources.
std::string sources_txt(const Sources& sources, const SurfaceMesh& mesh);

/// Throws UnsupportedError for chains of faces.
std::string sources_json(const Sources& sources, const SurfaceMesh& mesh);

}  // namespace littoral::io
