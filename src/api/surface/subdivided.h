#pragma once
// Functions that bend inside triangles, on a finer mesh.

#include <functional>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "domain/mesh/surface_mesh.h"
#include "littoral/types.h"

namespace littoral {

/// Every triangle cut into n parts along each side, with the scalar "distance": `at_vertices` at
/// the input's vertices, which come first and keep their numbers, and `at` a point of a triangle of
/// T (by barycentrics) at the new ones.
PolygonSoup subdivided(const SurfaceMesh& mesh, const IntrinsicTriangulation& T, int n,
                       const VecX& at_vertices,
                       const std::function<double(int triangle, const Vec3& b)>& at);

}  // namespace littoral
