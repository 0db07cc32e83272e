#pragma once
// The tufted cover as a mesh that can be flipped, refined and computed on.

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "domain/mesh/surface_mesh.h"

namespace littoral {

/// Two faces for each triangle t of a mesh: 2 t, with the same corners, and 2 t + 1 at its back,
/// with the last two exchanged. Every edge has exactly two faces, of the same orientation; vertices
/// are those of the mesh, and several edges may join two of them.
struct CoveringMesh {
  SurfaceMesh mesh;
  IntrinsicTriangulation T;
};

/// The tufted cover of a triangle mesh (Sharp and Crane, "A Laplacian for nonmanifold triangle
/// meshes", 2020), for functions at vertices. Vectors must not be diffused on it: they would flow
/// around boundaries to the back, and from one page of a book to the next only.
CoveringMesh covering_mesh(const SurfaceMesh& mesh, const IntrinsicTriangulation& T);

}  // namespace littoral
