#pragma once
// Quadratic-order geodesics of one triangle mesh, without and with sign.

#include <functional>
#include <memory>

#include "api/surface/surface_domain.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/quadratic/quadratic.h"
#include "sources/surface/pieces.h"

namespace littoral {

/// Elements and, once a source has been solved for, one symbolic factorization for each component.
/// Immutable; solves may run in several threads.
class QuadraticOnSurface {
 public:
  QuadraticOnSurface(SurfaceDomain domain, Report& report);

  SurfaceAnswer solve(const Sources& sources, const Quadratic& options, Task task,
                      Report& report) const;

  /// Sign and zero set from another method, magnitude from this one on both sides: distance to the
  /// given curves, completed by the zero set of phi (vertices) where they have gaps, with the sign
  /// of the side of the curve or of phi. Vertices phi does not reach stay +inf.
  SurfaceAnswer solve_signed(const Sources& sources, const VecX& phi, const Quadratic& options,
                             Task task, Report& report) const;

 private:
  using SignAt = std::function<double(int triangle, const Vec3& b)>;
  SurfaceAnswer solved(const PlacedSources& placed, const Quadratic& options, const VecX& signs,
                       const SignAt& sign_at, const Task& task, Report& report) const;

  SurfaceDomain domain_;
  std::shared_ptr<const IntrinsicTriangulation> T_;
  std::shared_ptr<const QuadraticSolver<2>> method_;
};

}  // namespace littoral
