#pragma once
// Sources on a triangulation that changes under them.

#include "domain/intrinsic/intrinsic_delaunay.h"
#include "domain/mesh/covering_mesh.h"
#include "sources/surface/pieces.h"

namespace littoral {

/// A better triangulation of the same surface with the same sources on it.
struct Retriangulated {
  SurfaceMesh mesh;
  IntrinsicTriangulation T;
  PlacedSources sources;
};

/// The same sources on the covering mesh of T, for functions at vertices: curves on the fronts, as
/// vertices are shared; points inside triangles and on edges on all the sheets they are seen from.
PlacedSources covering_sources(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                               const CoveringMesh& cover, const PlacedSources& sources);

/// Flips and refines (intrinsic_delaunay), with the sources cut by the new edges where these cross
/// them: the same curves and points on the same surface.
Retriangulated retriangulated(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                              const PlacedSources& sources, const RefineOptions& options,
                              Report& report, const Task& task);

}  // namespace littoral
