#pragma once
// Curves in space, projected onto a surface.

#include <vector>

#include "base/task.h"
#include "domain/mesh/surface_mesh.h"
#include "littoral/report.h"
#include "littoral/sources.h"
#include "sources/curves/trace.h"
#include "spatial/triangle_bvh.h"

namespace littoral {

/// A space curve on the surface.
struct ProjectedCurve {
  /// One curve, or several where closest points jump between components of the mesh; consecutive
  /// nodes share a face. A curve that shrinks to one point has one node.
  std::vector<Curve> curves;
  double largest_move = 0;  // [length], between a sample of the curve and its closest point
  int n_samples = 0;
};

/// Projects curves onto one triangle mesh by closest points; const and usable from several threads.
class CurveProjector {
 public:
  /// Keeps a reference to the mesh. Throws InputError if it has no face, UnsupportedError if it has
  /// faces that are not triangles.
  explicit CurveProjector(const SurfaceMesh& mesh);

  /// Samples the curve at steps of at most half the mean edge length, takes the closest point of
  /// each sample (snapped to edges and vertices within 1e-9 of the face's size) and traces between
  /// them.
  ///
  /// Warns in the report when a sample moves by more than 5 % of the bounding box diagonal, and
  /// when the curve is split. Throws InputError if a node is not finite, the curve has none, or
  /// sampling would take more than two million points.
  ProjectedCurve project(const SpaceCurve& curve, Report& report, const Task& task = {}) const;

 private:
  const SurfaceMesh& mesh_;
  Tracer tracer_;
  TriangleBvh bvh_;
  double diagonal_ = 0;   // of the bounding box of the faces
  double mean_edge_ = 0;  // mean edge length
};

}  // namespace littoral
