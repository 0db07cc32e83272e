#pragma once
// The signed heat method (Feng & Crane 2024): distance with a sign, to geometry that may be broken.

#include <memory>

#include "littoral/base/option_table.h"
#include "littoral/base/report.h"
#include "littoral/base/task.h"
#include "littoral/methods/vector_heat.h"
#include "littoral/operators/calculus.h"
#include "littoral/solve/poisson.h"
#include "littoral/sources/source_terms.h"

namespace littoral {

/// How values at the source are held (section 7.1).
enum class Constraint { none, zero_set, level_sets };

struct SignedHeatOptions {
  double time_scale = 0;  // t = time_scale h^2; 0: 1 where there are curves, 16 for points alone
  int constraint = static_cast<int>(Constraint::zero_set);
  double soft = 0;  // > 0: penalty instead of the constraint, per mean edge length of source
  bool preserve_normals = false;  // diffused vectors equal the normals at the source itself
};

/// Names, ranges, defaults and one sentence for each of the above.
const OptionTable<SignedHeatOptions>& signed_heat_options();

/// Time scale used for a source set when the option is 0.
double automatic_time_scale(const SourceTerms& terms);

/// Both factorizations of one domain; immutable, `solve` may be called from several threads.
class SignedHeat {
 public:
  /// Factors M + t L with t = time_scale h^2, and L. The operators are shared, not copied.
  SignedHeat(std::shared_ptr<const Operators> ops, double time_scale, Task task = {});

  /// Generalized signed distance at the nodes (nodes) [length of the input], +inf on components
  /// that no source reaches.
  VecX solve(const SourceTerms& terms, const SignedHeatOptions& options, Task task,
             Report& report) const;

 private:
  VecX integrate(const SourceTerms& terms, const VecX& Y, const SignedHeatOptions& options,
                 const Task& task, Report& report) const;
  VecX diffuse_preserving(const SourceTerms& terms, const Task& task, Report& report) const;
  bool add_across_pinches(const VecX& phi, double root_t, std::vector<char>& reached, VecX& X,
                          const Task& task, Report& report) const;

  std::shared_ptr<const Operators> ops_;
  VectorHeat heat_;
  Poisson poisson_;
};

}  // namespace littoral
