#pragma once
// Exact distance on a polyhedral surface: shortest paths over flat triangles.

#include "base/task.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/report.h"
#include "sources/triangle_sources.h"

namespace littoral {

/// Unsigned distance at the vertices (vertices) [length of the input], exact to rounding, from
/// points, and from curves as the exact distance to their straight pieces; +inf on components that
/// no source reaches.
///
/// Windows of straight rays are carried from triangle to triangle in the order of their distance
/// (Mitchell, Mount and Papadimitriou, "The discrete geodesic problem", 1987), not merged on edges
/// but thrown away once vertices nearby prove them useless (Chen and Han 1990; Xin and Wang,
/// "Improving Chen and Han's algorithm on the discrete geodesic problem", 2009), and cut where a
/// path along the edge is shorter. Any topology: rays that reach an edge of many triangles go on
/// into each; paths bend only at vertices with more than a full turn around them, on the boundary
/// and where the surface is not a manifold. Throws SolveError when more than 2e8 windows are open.
VecX exact_polyhedral(const IntrinsicTriangulation& T, const TriangleSources& sources,
                      const Task& task, Report& report);

}  // namespace littoral
