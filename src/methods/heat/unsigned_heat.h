#pragma once
// The heat method (Crane et al. 2013): unsigned distance, the baseline of the signed one.

#include <memory>

#include "base/option_table.h"
#include "base/report.h"
#include "base/task.h"
#include "methods/heat/scalar_heat.h"
#include "operators/calculus.h"
#include "solve/poisson/poisson.h"
#include "sources/source_terms.h"

namespace littoral {

struct UnsignedHeatOptions {
  double time_scale = 0;            // t = time_scale h^2, h the mean edge length; 0: automatic
  bool intrinsic_delaunay = false;  // on better triangles of the same surface
};

const OptionTable<UnsignedHeatOptions>& unsigned_heat_options();

/// Distance to points and curves by scalar heat. Directions come from the nearest source only, and
/// next to isolated points the distance is exact: neither the boundary nor other sources bend it.
class UnsignedHeat {
 public:
  /// An automatic time scale is 1 here.
  UnsignedHeat(std::shared_ptr<const Operators> ops, const UnsignedHeatOptions& options,
               Task task = {}, Expect expect = Expect::many_solves);

  /// The same with another time scale; the order of elimination and the Poisson factor are shared.
  UnsignedHeat with_time_scale(double time_scale, const Task& task) const;

  /// Unsigned distance at the nodes (nodes) [length of the input], +inf on components that no
  /// source reaches; never negative.
  VecX solve(const SourceTerms& terms, Task task, Report& report) const;

 private:
  std::shared_ptr<const Operators> ops_;
  Expect expect_;
  double root_t_;
  Ordering order_;  // of the nodes
  ScalarHeat heat_;
  std::shared_ptr<const Poisson> poisson_;
};

}  // namespace littoral
