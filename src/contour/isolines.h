#pragma once
// Level sets of a function on a surface, as polylines on the surface.

#include <vector>

#include "domain/mesh/surface_mesh.h"
#include "littoral/surface_point.h"
#include "littoral/types.h"

namespace littoral {

/// A chain of points on a surface; straight segments through faces join consecutive nodes.
struct Polyline {
  std::vector<SurfacePoint> nodes;  // on edges, and on vertices where a value equals the level
  bool closed = false;              // the last node is joined to the first, which is not repeated
};

/// The lines on which a piecewise linear function takes the value `level`: marching triangles.
///
/// `values` holds one number a vertex (vertices); faces with a non-finite value have no line.
/// Values equal to the level count as just below it, so every line through a vertex is met exactly
/// once, a face or region equal to the level gives the line around it where larger values begin,
/// and a lone vertex at the level none. Lines are maximal, ordered by their first face, and
/// directed with larger values on the left seen from the face normals; where faces of one line
/// disagree in orientation the majority of its segments decides. At an edge of three or more faces
/// lines end.
///
/// Polygons work too: crossings of their sides are joined by straight segments, and where there are
/// four or more the mean of the corner values decides which (so no node lies inside a face, and a
/// segment may leave a concave polygon). Throws InputError if `values` has the wrong length or the
/// level is not finite.
std::vector<Polyline> isolines(const SurfaceMesh& mesh, const VecX& values, double level);

/// Positions of a polyline's nodes (nodes x 3); a closed line's first node is repeated at the end.
MatX3 polyline_points(const SurfaceMesh& mesh, const Polyline& line);

/// Length of a polyline [length].
double polyline_length(const SurfaceMesh& mesh, const Polyline& line);

}  // namespace littoral
