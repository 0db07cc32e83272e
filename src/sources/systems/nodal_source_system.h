#pragma once
// Sources on nodal surfaces (polygon meshes, point clouds, voxel surfaces), as the methods see
// them.

#include "domain/mesh/nodal_surface.h"
#include "sources/surface/pieces.h"
#include "sources/systems/source_system.h"

namespace littoral {

/// The system of sources prepared on S.refined (signed heat method, sections 8.3 to 8.5), for any
/// mixture of curves and points anywhere: a signed piece gives each node its normal there,
/// projected to the tangent plane; unsigned pieces and points give the nodes around them the
/// directions away.
SourceSystem nodal_source_system(const NodalSurface& S, const PlacedSources& sources);

}  // namespace littoral
