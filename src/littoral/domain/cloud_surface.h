#pragma once
// Point clouds as surfaces.

#include "littoral/domain/nodal_surface.h"

namespace littoral {

/// Unit normals by principal axes of the neighbours, made consistent along a spanning tree of the
/// most parallel neighbours and outward at the topmost point of each connected part.
MatX3 estimate_normals(const MatX3& points);

/// Local triangulations (Sharp and Crane, "A Laplacian for nonmanifold triangle meshes", 2020,
/// section 5.7): each point is joined to its neighbours in the Delaunay triangulation of its
/// nearest points, projected to its tangent plane. A triangle counts a third for each of its
/// corners that made it, so where they agree the triangles are a triangulation. Triangles whose
/// circumcircle the nearest points do not cover are left out: that is how holes and boundaries stay
/// open.
///
/// Nodes are the points, patches and cells the triangles. Repeated and non-finite points belong to
/// no triangle. `normals` (points x 3) may be empty: then they are estimated, with a note in the
/// report. Throws InputError if no triangle can be made.
NodalSurface cloud_surface(const MatX3& points, const MatX3& normals, Report& report);

}  // namespace littoral
