#pragma once
// Shortening a path that crosses a triangle mesh.

#include <vector>

#include "base/task.h"
#include "domain/mesh/surface_mesh.h"
#include "littoral/surface_point.h"

namespace littoral {

/// A path over triangles: two free ends and, between them, vertices and edge points.
struct SurfacePath {
  std::vector<SurfacePoint> nodes;  // in their simplest form
  std::vector<int> faces;           // faces[i] contains nodes[i] and nodes[i+1]
};

/// Length of the path with coordinates multiplied by `scale`.
double path_length(const SurfaceMesh& mesh, const SurfacePath& path, double scale);

/// Shortens a path, ends fixed, until it is straight: a geodesic where the mesh allows one.
///
/// The faces crossed between two vertices of the path are unfolded and the shortest path in that
/// strip is found exactly (funnel: Lee and Preparata, "Euclidean shortest paths in the presence of
/// rectilinear barriers", 1984); a vertex passed at less than half a turn is bypassed on that side
/// (Xin and Wang, "Efficiently determining a locally exact shortest path on polyhedral surfaces",
/// 2007, in angles alone so that any number of faces may meet at an edge). Never longer than
/// before; at most 2000 rounds, each linear in the path. `scale` brings coordinates near 1.
void straighten(const SurfaceMesh& mesh, SurfacePath& path, double scale, const Task& task);

}  // namespace littoral
