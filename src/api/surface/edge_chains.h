#pragma once
// Edges joined into lines.

#include <vector>

#include "domain/mesh/surface_mesh.h"

namespace littoral {

/// Joins directed edges, each as often as it counts (edges, rounded; negative: against the edge),
/// head to tail into polylines of vertices: from their ends where they have any.
std::vector<std::vector<int>> edge_chains(const SurfaceMesh& mesh, const VecX& times);

}  // namespace littoral
