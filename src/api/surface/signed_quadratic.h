#pragma once
// Signed distance of quadratic order: sign and zero set from another method, magnitude from
// quadratic-order geodesics on both sides.

#include "api/surface/surface_method.h"
#include "methods/quadratic/quadratic.h"

namespace littoral {

/// Quadratic-order distance to the given curves, completed by the zero set of phi (vertices) where
/// they have gaps, with the sign of the side of the curve or of phi. Vertices phi does not reach
/// stay +inf. Triangle meshes.
SurfaceResult signed_quadratic(const SurfaceProblem& problem, const VecX& phi,
                               const QuadraticOptions& options, Task task, Report& report);

}  // namespace littoral
