#pragma once
// Sources on nodal surfaces (polygon meshes, point clouds, voxel surfaces), as the methods see
// them.

#include "littoral/domain/nodal_surface.h"
#include "littoral/sources/pieces.h"
#include "littoral/sources/source_terms.h"
#include "littoral/sources/surface_sources.h"

namespace littoral {

/// Sources on the input's elements, on those of the refined mesh. Points inside polygons are given
/// by coordinates on the first three corners, and go to the nearest point of the polygon's
/// triangles. Throws InputError where an element does not exist.
SurfaceSources refined_sources(const SurfaceMesh& input, const NodalSurface& S,
                               const SurfaceSources& sources);

/// Terms of sources prepared on S.refined (signed heat method, sections 8.3 to 8.5), for any
/// mixture of curves and points anywhere: a signed piece gives each node its normal there,
/// projected to the tangent plane; unsigned pieces and points give the nodes around them the
/// directions away.
SourceTerms nodal_source_terms(const NodalSurface& S, const PreparedSources& sources);

}  // namespace littoral
