#pragma once
// The heat method (Crane et al. 2013): unsigned distance, the baseline of the signed one.

#include <memory>

#include "littoral/base/option_table.h"
#include "littoral/base/report.h"
#include "littoral/base/task.h"
#include "littoral/operators/calculus.h"
#include "littoral/solve/heat_system.h"
#include "littoral/solve/poisson.h"
#include "littoral/sources/source_terms.h"

namespace littoral {

struct UnsignedHeatOptions {
  double time_scale = 1;  // t = time_scale h^2, h the mean edge length
};

const OptionTable<UnsignedHeatOptions>& unsigned_heat_options();

/// Distance to points and curves by scalar heat. The heat is the mean of the solutions with zero
/// Neumann and zero Dirichlet boundary values, whose reflections cancel at a straight boundary, so
/// the gradient is not bent there; the distance is constrained to 0 at the sources. Midway between
/// two sources a few edges apart the values are still too small (docs/accuracy.md).
class UnsignedHeat {
 public:
  UnsignedHeat(std::shared_ptr<const Operators> ops, const UnsignedHeatOptions& options,
               Task task = {});

  /// Unsigned distance at the nodes (nodes) [length of the input], +inf on components that no
  /// source reaches; never negative.
  VecX solve(const SourceTerms& terms, Task task, Report& report) const;

 private:
  void add_dirichlet(const VecX& u0, const VecX& b, const LayeredField<double>& d,
                     LayeredField<double>& u) const;

  std::shared_ptr<const Operators> ops_;
  std::shared_ptr<const HeatSystem<double>> neumann_, dirichlet_;  // no dirichlet_ without boundary
  Poisson poisson_;
};

}  // namespace littoral
