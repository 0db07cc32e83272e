#pragma once
// A surface split where values at corners differ.

#include <array>
#include <cstdint>
#include <vector>

#include "domain/mesh/surface_mesh.h"

namespace littoral {

/// The split surface: faces as before, and for every vertex a corner {face, k} that it came from.
struct SplitSurface {
  PolygonSoup soup;
  std::vector<std::array<int, 2>> corner;
};

/// One vertex for every vertex and key that meet; keys of the corners, faces x 3. Triangle meshes.
SplitSurface split_at_jumps(const SurfaceMesh& mesh, const Rows<std::int64_t, 3>& key);

}  // namespace littoral
