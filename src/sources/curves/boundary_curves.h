#pragma once
// The boundary of a surface as something to measure distance from.

#include <vector>

#include "domain/mesh/surface_mesh.h"
#include "littoral/sources.h"

namespace littoral {

/// One closed, unsigned curve for each loop of edges that have one face, through vertices; where
/// loops touch at a vertex, any way of telling them apart. Empty for closed surfaces.
std::vector<Curve> boundary_curves(const SurfaceMesh& mesh);

}  // namespace littoral
