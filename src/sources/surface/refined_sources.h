#pragma once
// Sources on polygons, on the triangles these are cut into.

#include <vector>

#include "domain/mesh/surface_mesh.h"
#include "littoral/sources.h"

namespace littoral {

/// Sources on the elements of `input`, on those of `refined`: triangles with the input's vertices
/// first and its edges among theirs, the triangles of face f being face_offsets[f] and following (a
/// triangle of the input is itself; no offsets: the input has nothing but vertices). Points inside
/// polygons are given by coordinates on the first three corners, and go to the nearest point of the
/// polygon's triangles. Throws InputError where an element does not exist.
Sources refined_sources(const SurfaceMesh& input, const SurfaceMesh& refined,
                        const std::vector<int>& face_offsets, const Sources& sources);

}  // namespace littoral
