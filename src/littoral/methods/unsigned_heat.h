#pragma once
// The heat method (Crane et al. 2013): unsigned distance, the baseline of the signed one.

#include <memory>

#include "littoral/base/option_table.h"
#include "littoral/base/report.h"
#include "littoral/base/task.h"
#include "littoral/methods/scalar_heat.h"
#include "littoral/operators/calculus.h"
#include "littoral/solve/poisson.h"
#include "littoral/sources/source_terms.h"

namespace littoral {

struct UnsignedHeatOptions {
  double time_scale = 1;            // t = time_scale h^2, h the mean edge length
  bool intrinsic_delaunay = false;  // on better triangles of the same surface
};

const OptionTable<UnsignedHeatOptions>& unsigned_heat_options();

/// Distance to points and curves by scalar heat. Directions come from the nearest source only, and
/// next to isolated points the distance is exact: neither the boundary nor other sources bend it.
class UnsignedHeat {
 public:
  UnsignedHeat(std::shared_ptr<const Operators> ops, const UnsignedHeatOptions& options,
               Task task = {}, Expect expect = Expect::many_solves);

  /// Unsigned distance at the nodes (nodes) [length of the input], +inf on components that no
  /// source reaches; never negative.
  VecX solve(const SourceTerms& terms, Task task, Report& report) const;

 private:
  std::shared_ptr<const Operators> ops_;
  double root_t_;
  Ordering order_;  // of the nodes
  ScalarHeat heat_;
  Poisson poisson_;
};

}  // namespace littoral
