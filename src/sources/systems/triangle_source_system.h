#pragma once
// Sources on triangle meshes, as the methods see them.

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "sources/surface/pieces.h"
#include "sources/systems/source_system.h"

namespace littoral {

/// The system of curves and points on a triangle mesh (signed heat method, section 5.6 and appendix
/// A), also for unsigned curves and points inside faces. Throws InputError if no source lies on a
/// face with three different vertices.
SourceSystem source_system(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                           const PlacedSources& sources);

}  // namespace littoral
