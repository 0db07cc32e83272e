#pragma once
// How far an answer is from another method's: what it says about itself without a known truth.

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "sources/surface/pieces.h"

namespace littoral {

/// Name of the residual.
inline constexpr const char* mean_beside_marching = "mean difference from fast marching";

/// Reports the mean of | |values| - d | over the vertices of a component, over the largest d there,
/// d by fast marching from the sources; the worst of the components. With signed curves, which the
/// values may complete, only what exceeds d counts.
double report_beside_marching(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                              const PlacedSources& placed, const VecX& values, const Task& task,
                              Report& report);

/// Warns, with what to do, where that is more than the heat methods have shown where they are
/// right.
void warn_beside_marching(double mean, Report& report);

}  // namespace littoral
