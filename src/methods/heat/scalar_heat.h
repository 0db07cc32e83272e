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
  /// order: of elimination of the nodes; found here if null. structure: of the factor of C.L with
  /// its whole diagonal, if it is known; both matrices have it. Matrices too large to be factored
  /// are made for each solve and given up: they take more memory than time.
  ScalarHeat(const Calculus& C, double t, SolveHint hint, std::shared_ptr<const Ordering> order,
             std::shared_ptr<const Elimination> structure, const Task& task);

  /// Adds -grad u of all batches of sources to `field`: each cell takes the batch whose
  /// gradient is longest there, that is the nearest. A sum would turn the directions of two sources
  /// that face each other into their average, over a width of sqrt(t) on both sides of the line
  /// between. Points are weighted as point_weight (> 0) times the curves' measure; a source whose
  /// distance is counted from c is weaker by exp(-c / sqrt(t)).
  void add_nearest(const Calculus& C, const SourceSystem& system, double point_weight,
                   CellField& field, Task task, Report& report) const;

  struct Systems {
    std::shared_ptr<const HeatSystem<double>> neumann, dirichlet;  // none without boundary
  };
  /// Null where they are made for each solve.
  const Systems* kept() const { return kept_.get(); }
  double nonzeros() const;

 private:
  Systems systems(const Calculus& C, const Task& task) const;

  double t_;
  SolveHint hint_;
  std::shared_ptr<const Ordering> order_;
  std::shared_ptr<const Elimination> structure_;
  std::shared_ptr<const Systems> kept_;
};

/// Makes a point's gradient as long as that of a straight curve at distance sqrt(t) from both:
/// pi e^-1 / K1(1), for unit masses of both and times sqrt(t).
constexpr double point_to_line = 1.92;

}  // namespace littoral
