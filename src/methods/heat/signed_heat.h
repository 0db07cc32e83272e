#pragma once
// The signed heat method (Feng & Crane 2024): distance with a sign, to geometry that may be broken.

#include <memory>
#include <optional>
#include <vector>

#include "base/option_table.h"
#include "base/task.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "methods/heat/heat_strips.h"
#include "methods/heat/scalar_heat.h"
#include "methods/heat/vector_heat.h"
#include "operators/calculus.h"
#include "solve/poisson/poisson.h"
#include "sources/systems/source_system.h"

namespace littoral {

/// Names, ranges, defaults and one sentence for each of the above.
const OptionTable<SignedHeat>& signed_heat_options();

/// Time scale used for a source set when the option is 0.
double automatic_time_scale(const SourceSystem& system);

/// Which diffusions sources need: of vectors, of scalars.
struct Diffusions {
  bool vectors = true, scalars = true;
};
Diffusions needed_diffusions(const SourceSystem& system, const SignedHeat& options);

/// The factorizations of one domain; immutable, `solve` may be called from several threads.
///
/// Sources diffuse as vectors (eq. 12). For points alone these are the gradient of scalar heat: in
/// the plane the same field, as -grad commutes with diffusion, but one that the boundary does not
/// bend and of which each cell can take the nearest point's.
class SignedHeatSolver {
 public:
  /// Factors M + t L with t = time_scale h^2, for vectors or scalars or both, and L. The operators
  /// are shared, not copied. Expecting one solve only, large heat matrices are left unfactored.
  SignedHeatSolver(std::shared_ptr<const Operators> ops, double time_scale, Task task = {},
                   Diffusions diffusions = {}, SolveHint hint = SolveHint::many_rhs);

  /// The same for another time scale and other diffusions; the order of elimination and the Poisson
  /// factor are shared.
  SignedHeatSolver with(double time_scale, Diffusions diffusions, Task task) const;

  /// Generalized signed distance at the nodes (nodes) [length of the input], +inf on components
  /// that no source reaches. Throws UnsupportedError if a diffusion is needed that was left out.
  VecX solve(const SourceSystem& system, const SignedHeat& options, Task task,
             Report& report) const;

  /// The same for many points by gradients of scalar heat, which must be there, constrained to one
  /// value at each, on parts that all time scales share.
  std::shared_ptr<const StripParts> strip_parts() const {
    return HeatStrips::parts(ops_, *scalar_heat_, *poisson_);
  }
  std::shared_ptr<const HeatStrips> strips(std::shared_ptr<const StripParts> parts) const {
    return std::make_shared<const HeatStrips>(std::move(parts), *scalar_heat_);
  }
  double factor_megabytes() const;

  /// Steps I and II: unit vectors at the cells (2 cells), 0 where no source reaches.
  VecX directions(const SourceSystem& system, const SignedHeat& options, const Task& task,
                  Report& report) const;

  /// Pieces (of the vector dofs) that heat of the sources reaches.
  std::vector<char> reached_pieces(const SourceSystem& system, const SignedHeat& options) const;

  /// Directions Y (2 cells) beyond nodes by which pieces that no heat has reached hang on others,
  /// given phi (nodes) [units]; false, and nothing changed, if there are none.
  bool add_across_pinches(const VecX& phi, std::vector<char>& reached, VecX& Y, const Task& task,
                          Report& report) const;

 private:
  VecX integrate(const SourceSystem& system, const VecX& b, const SignedHeat& options,
                 const Task& task, Report& report) const;
  void factor_heat(double time_scale, Diffusions diffusions, Task& task);

  std::shared_ptr<const Operators> ops_;
  SolveHint hint_;
  std::shared_ptr<const Ordering> order_;  // of the nodes
  std::shared_ptr<const Poisson> poisson_;
  double root_t_ = 0;
  std::optional<VectorHeat> heat_;
  std::optional<ScalarHeat> scalar_heat_;
};

}  // namespace littoral
