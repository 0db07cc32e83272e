#pragma once
// Directions away from points and unsigned curves, by scalar diffusion (Crane et al. 2013).

#include <memory>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "methods/heat/cell_field.h"
#include "operators/calculus.h"
#include "sources/systems/source_system.h"

namespace littoral {

/// (M + t L) u = u0 with zero Neumann and zero Dirichlet boundary values; immutable. The mean of
/// the two is used: their reflections cancel at a straight boundary, so the gradient is not bent
/// there.
class ScalarHeat {
 public:
  /// structure: of the factor of C.L with its whole diagonal, if it is known; both matrices have
  /// it.
  ScalarHeat(const Calculus& C, double t, SolveHint hint, const Ordering& order,
             const std::shared_ptr<const Elimination>& structure, const Task& task);

  /// Adds -grad u of all batches of sources to `field`: each cell takes the batch whose
  /// gradient is longest there, that is the nearest. A sum would turn the directions of two sources
  /// that face each other into their average, over a width of sqrt(t) on both sides of the line
  /// between. Points are weighted as point_weight (> 0) times the curves' measure; a source whose
  /// distance is counted from c is weaker by exp(-c / sqrt(t)).
  void add_nearest(const Calculus& C, const SourceSystem& system, double point_weight,
                   CellField& field, Task task, Report& report) const;

  const std::shared_ptr<const HeatSystem<double>>& neumann() const { return neumann_; }
  const std::shared_ptr<const HeatSystem<double>>& dirichlet() const { return dirichlet_; }
  double nonzeros() const {
    return neumann_->nonzeros() + (dirichlet_ ? dirichlet_->nonzeros() : 0);
  }

 private:
  CellField flow(const Calculus& C, const VecX& u0, const Task& task, Report& report) const;

  double root_t_;
  std::shared_ptr<const HeatSystem<double>> neumann_, dirichlet_;  // no dirichlet_ without boundary
};

/// Makes a point's gradient as long as that of a straight curve at distance sqrt(t) from both:
/// pi e^-1 / K1(1), for unit masses of both and times sqrt(t).
constexpr double point_to_line = 1.92;

}  // namespace littoral
