#pragma once
// The heat method (Crane et al. 2013): unsigned distance, the baseline of the signed one.

#include <memory>

#include "base/option_table.h"
#include "base/task.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "methods/heat/heat_strips.h"
#include "methods/heat/scalar_heat.h"
#include "operators/calculus.h"
#include "solve/poisson/poisson.h"
#include "sources/systems/source_system.h"

namespace littoral {

const OptionTable<UnsignedHeat>& unsigned_heat_options();

/// Distance to points and curves by scalar heat. Directions come from the nearest source only, and
/// next to isolated points the distance is exact: neither the boundary nor other sources bend it.
class UnsignedHeatSolver {
 public:
  /// An automatic time scale is 1 here.
  UnsignedHeatSolver(std::shared_ptr<const Operators> ops, const UnsignedHeat& options,
                     Task task = {}, SolveHint hint = SolveHint::many_rhs);

  /// The same with another time scale; the order of elimination and the Poisson factor are shared.
  UnsignedHeatSolver with_time_scale(double time_scale, const Task& task) const;

  /// Unsigned distance at the nodes (nodes) [length of the input], +inf on components that no
  /// source reaches; never negative.
  VecX solve(const SourceSystem& system, Task task, Report& report) const;

  /// The same for many points, on parts that all time scales share.
  std::shared_ptr<const StripParts> strip_parts() const {
    return HeatStrips::parts(ops_, heat_, *poisson_);
  }
  std::shared_ptr<const HeatStrips> strips(std::shared_ptr<const StripParts> parts) const {
    return std::make_shared<const HeatStrips>(std::move(parts), heat_);
  }

 private:
  std::shared_ptr<const Operators> ops_;
  SolveHint hint_;
  double root_t_;
  std::shared_ptr<const Ordering> order_;  // of the nodes
  std::shared_ptr<const Poisson> poisson_;
  ScalarHeat heat_;
};

}  // namespace littoral
