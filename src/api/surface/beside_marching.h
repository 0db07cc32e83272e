#pragma once
// How far an answer is from another method's: what it says about itself without a known truth.

#include "base/beside.h"
#include "base/task.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "sources/surface/pieces.h"

namespace littoral {

/// Name of the residual.
inline constexpr const char* mean_beside_marching = "mean difference from fast marching";

/// Distance by fast marching, walked beside what the caller does until it is asked for.
class BesideMarching {
 public:
  /// The mesh and its triangulation must stay.
  BesideMarching(const SurfaceMesh& mesh, const IntrinsicTriangulation& T, PlacedSources placed);

  /// Reports the mean of | |values| - d | over the vertices of a component, over the largest d
  /// there, d by fast marching from the sources; the worst of the components. With signed curves,
  /// which the values may complete, only what exceeds d counts. Once.
  double report(const VecX& values, const Task& task, Report& report);

 private:
  void walk(const Task& task);

  const SurfaceMesh& mesh_;
  const IntrinsicTriangulation& T_;
  const PlacedSources placed_;
  VecX d_;  // vertices, when march_ has ended
  Beside march_;
};

/// Warns, with what to do, where that is more than the heat methods have shown where they are
/// right.
void warn_beside_marching(double mean, Report& report);

}  // namespace littoral
