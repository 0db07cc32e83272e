#pragma once
// Short paths across a triangle mesh, for curves whose nodes do not share a face.

#include <vector>

#include "base/task.h"
#include "domain/mesh/surface_mesh.h"
#include "sources/surface/surface_points.h"

namespace littoral {

/// Traces paths on one mesh; const and usable from several threads.
class Tracer {
 public:
  /// Keeps a reference to the mesh. Throws UnsupportedError if it has faces that are not triangles.
  explicit Tracer(const SurfaceMesh& mesh);

  /// Nodes of a locally shortest path, both ends included (in their simplest form): consecutive
  /// nodes share a face, inner nodes are vertices or edge points. Points that share a face give
  /// {from, to}.
  ///
  /// A* over vertices and a few points on every edge (Lanthier, Maheshwari and Sack, "Approximating
  /// weighted shortest paths on polyhedral surfaces", 1997), stopping at the target, then
  /// straightened. Any topology. Throws InputError if a point is not on the mesh or the two lie in
  /// different components (naming both); Cancelled within 0.2 s of a request.
  std::vector<SurfacePoint> trace(const SurfacePoint& from, const SurfacePoint& to,
                                  const Task& task = {}) const;

  /// Component of the mesh in which a point (simplest form) lies.
  int component(const SurfacePoint& p) const;

 private:
  const SurfaceMesh& mesh_;
  double scale_ = 1;  // power of two that brings coordinates near 1
};

/// Tracer(mesh).trace(from, to, task), for a single path.
std::vector<SurfacePoint> trace(const SurfaceMesh& mesh, const SurfacePoint& from,
                                const SurfacePoint& to, const Task& task = {});

}  // namespace littoral
