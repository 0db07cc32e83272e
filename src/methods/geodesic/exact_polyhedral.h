#pragma once
// Exact distance on a polyhedral surface: shortest paths over flat triangles.

#include "base/task.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/report.h"
#include "sources/surface/triangle_sources.h"

namespace littoral {

struct ExactDistance {
  VecX distance;  // vertices [length of the input]; +inf where no source reaches
  VecXi nearest;  // vertices: the source the shortest path starts from, -1 where none reaches
  double exact_within = 0;  // [length of the input] values up to here are exact; +inf: all are
};

/// How far the search goes.
struct ExactSearch {
  double most_windows = 0;  // that are followed exactly; 0: 1000 a triangle and at least 1e7
  double tolerance = 0;     // share that every distance may be off by, counted from the least value
};

/// Unsigned distance at the vertices, exact to rounding, from points, and from curves as the exact
/// distance to their straight pieces; +inf on components that no source reaches. Sources are
/// numbered as in TriangleSources; of equally near ones any is named.
///
/// Where sources have values the answer is the least of value + distance, and a source starts when
/// the front has gone as far as its value.
///
/// Windows of straight rays are carried from edge to edge, nearly in the order of their distance
/// (Mitchell, Mount and Papadimitriou, "The discrete geodesic problem", 1987). Each edge keeps the
/// nearest window at each of its points, from whichever of its triangles, and neighbours with the
/// same rays, to rounding, as one; all that are new go on together, as in Qin et al., "Fast and
/// exact discrete geodesic computation based on triangle-oriented wavefront propagation", 2016.
/// They are cut where a path along the edge is shorter, thrown away where vertices nearby prove
/// them useless (Chen and Han 1990; Xin and Wang, "Improving Chen and Han's algorithm on the
/// discrete geodesic problem", 2009). Any topology: rays that reach an edge of many triangles go on
/// into each; paths bend only at vertices with more than a full turn around them, on the boundary
/// and where the surface is not a manifold.
///
/// With a tolerance, neighbouring windows become one where no distance is then further off than
/// that: on fine meshes there are few left. What values are off by at most is in the report.
///
/// More than `most_windows` are not followed: from there on paths may bend at every vertex and run
/// straight through 16 triangles only, then 4, then 1. A warning says up to which distance values
/// are exact; those beyond are lengths of paths, hence too large if not exact.
ExactDistance exact_polyhedral(const IntrinsicTriangulation& T, const TriangleSources& sources,
                               const Task& task, Report& report, const ExactSearch& search = {});

}  // namespace littoral
