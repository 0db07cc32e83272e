#pragma once
// Point clouds as surfaces.

#include "base/task.h"
#include "domain/mesh/nodal_surface.h"
#include "littoral/report.h"

namespace littoral {

/// Local triangulations (Sharp and Crane, "A Laplacian for nonmanifold triangle meshes", 2020,
/// section 5.7): each point is joined to its neighbours in the Delaunay triangulation of its
/// nearest points, projected to its tangent plane. A triangle counts a third for each of its
/// corners that made it, so where they agree the triangles are a triangulation. Triangles whose
/// circumcircle the nearest points do not cover are left out: that is how holes and boundaries stay
/// open.
///
/// Nodes are the points. Fields are linear on the triangles of the intrinsic Delaunay
/// triangulations of tufted covers (TuftedCover), so that no weight of the Laplacian is negative;
/// these are patches and cells. Repeated and non-finite points belong to no triangle. `normals`
/// (points x 3) may be empty: then they are estimated, with a note in the report. Throws InputError
/// if no triangle can be made.
NodalSurface cloud_surface(const MatX3& points, const MatX3& normals, Report& report,
                           const Task& task = Task());

/// The cloud with the local triangles as faces, for pictures; none where none can be made.
PolygonSoup cloud_triangles(const PolygonSoup& cloud, Report& report, const Task& task = Task());

}  // namespace littoral
