#pragma once
// Fast marching on triangles (Kimmel and Sethian, "Computing geodesic paths on manifolds", 1998).

#include "base/task.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/report.h"
#include "sources/surface/triangle_sources.h"

namespace littoral {

/// Distance at the vertices (vertices) [length of the input] from points and curves, first order in
/// the edge length; +inf on components that no source reaches. Signed where signed curves are
/// nearest: each vertex takes the sign of the vertices it was reached from, so gaps in a curve are
/// not filled in; where sides meet without a curve between them, the report warns. Counted from the
/// sources' values, which must all be the same beside signed curves.
///
/// A triangle that is obtuse, or right, at the vertex to be reached is split by unfolding its
/// neighbours until one of their vertices lies in front of it. Any topology.
VecX fast_marching(const IntrinsicTriangulation& T, const TriangleSources& sources,
                   const Task& task, Report& report);

/// Share of the area where the gradient of d (vertices) [length] is off unit length by more than
/// `off_unit_by` (methods/heat/time_scale.h), of the triangles that are reached on one side.
double off_unit_share(const IntrinsicTriangulation& T, const VecX& d);

}  // namespace littoral
