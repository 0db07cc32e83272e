#pragma once
// The curved Hessian energy: smoothness without distortion at boundaries.

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "operators/calculus.h"

namespace littoral {

/// W with 1/2 u^T W u = 1/2 integral of |nabla du|^2 + kappa |du|^2 (vertices x vertices, lower
/// triangle) [1/length^2 after the area]: du is taken to edges (Crouzeix-Raviart), where it is
/// differentiated once more; the Gaussian curvature kappa of interior vertices makes functions with
/// Delta u = 0 the only ones whose energy vanishes to first order (Stein, Jacobson, Wardetzky,
/// Grinspun, "A smoothness energy without boundary distortion for curved surfaces", 2020). Natural
/// boundary conditions: linear functions on flat pieces cost nothing.
SpMat curved_hessian(const IntrinsicTriangulation& T, const VectorDiffusion& vector);

}  // namespace littoral
