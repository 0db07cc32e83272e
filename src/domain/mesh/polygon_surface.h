#pragma once
// Polygon meshes by virtual refinement: a vertex in every polygon that the others determine.

#include "domain/mesh/nodal_surface.h"

namespace littoral {

/// Cuts every polygon of more than three corners into the fan around one virtual vertex, placed
/// where the sum of the squared areas of the fan is least and held there by affine weights of least
/// norm (Bunge, Herholz, Kazhdan, Botsch, "Polygon Laplacian made simple", 2020, section 4);
/// polygons may be concave and need not be planar. Triangles stay as they are.
///
/// Nodes are the vertices, patches the polygons. Node normals are sums of the areas times normals
/// of the triangles around them (signed heat method, section 8.3). Polygons of more than 64 corners
/// are first cut into triangles on their own corners, with a warning. Throws what
/// intrinsic_triangulation throws, and UnsupportedError for surfaces that are not orientable.
NodalSurface polygon_surface(const SurfaceMesh& mesh, Report& report);

/// The boundary of a set of voxels (boundary_of_voxels). Patches are surfels, measured in the plane
/// orthogonal to their corrected normals; node normals are the normalised averages of those around
/// (section 8.5).
NodalSurface voxel_surface(const SurfaceMesh& mesh, const MatX3& face_normals, Report& report);

}  // namespace littoral
