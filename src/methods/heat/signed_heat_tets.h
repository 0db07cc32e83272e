#pragma once
// The signed heat method on tet meshes (section 8.1, Appendix B).

#include <memory>
#include <utility>

#include "base/lazy.h"
#include "base/task.h"
#include "methods/heat/signed_heat_grid.h"
#include "operators/tet_operators.h"
#include "solve/direct/cholesky.h"
#include "solve/heat/heat_system.h"
#include "solve/poisson/poisson.h"
#include "sources/space/tet_source_system.h"

namespace littoral {

/// The method on one mesh; the Poisson factor and the last heat factors are made when first needed
/// and kept. Where one solve is expected, directions are diffused without a factor if that is
/// quick. Immutable to its users, from several threads.
class TetHeatSolver {
 public:
  TetHeatSolver(std::shared_ptr<const TetOperators> ops, SolveHint hint)
      : ops_(std::move(ops)), hint_(hint) {}

  /// Generalized signed distance at the vertices [length], +inf on components that no source
  /// reaches. h [length] sets the diffusion time t = time_scale h^2 and the scale of `soft`;
  /// `tolerance` [length] is how far from zero the rows of a held zero set may be in the mean. The
  /// options are settled.
  VecX signed_distance(const TetSourceSystem& system, double h, double tolerance,
                       const SpaceSignedHeat& options, Task task, Report& report) const;

  /// Distance without sign, from vertices (the rows of system.A), by the diffusion of a scalar
  /// (Crane et al. 2013): t = 4 time_scale h^2. Otherwise as above.
  VecX unsigned_distance(const TetSourceSystem& system, double h, double tolerance,
                         const SpaceSignedHeat& options, Task task, Report& report) const;

  const TetOperators& operators() const { return *ops_; }

 private:
  VecX integrate(const TetSourceSystem& system, const MatX3& Y, double h, double tolerance,
                 const SpaceSignedHeat& options, Task task, Report& report) const;

  std::shared_ptr<const TetOperators> ops_;
  SolveHint hint_;
  Kept<Poisson> poisson_;
  KeptLast<double, Cholesky<double>> faces_, vertices_;  // by time
};

}  // namespace littoral
