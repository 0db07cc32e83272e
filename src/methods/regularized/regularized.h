#pragma once
// Regularized geodesic distances (Edelstein, Guillen, Solomon, Ben-Chen 2023).

#include <memory>
#include <string>
#include <vector>

#include "base/option_table.h"
#include "base/task.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "methods/regularized/regularized_part.h"
#include "operators/calculus.h"
#include "solve/heat/heat_system.h"
#include "solve/optimization/admm.h"
#include "sources/surface/known_distances.h"

namespace littoral {

/// Names, ranges, defaults and one sentence for each of the above.
const OptionTable<Regularized>& regularized_options();

/// Those that are left where alpha is 0: eq. 1 has nothing to choose but when to stop.
const OptionTable<BelyaevFayolle>& belyaev_fayolle_options();

/// Those of either that there are in space: the Dirichlet energy of linear functions.
const OptionTable<SpaceRegularized>& space_regularized_options();
const OptionTable<SpaceBelyaevFayolle>& space_belyaev_fayolle_options();

/// One domain and one regularizer; immutable, `solve` may be called from several threads.
class RegularizedSolver {
 public:
  /// Orders the Laplacian W_D once; if several components or one solve are expected, each when a
  /// source reaches it, beside the march that iterations start from. It is factored when cells
  /// first share a penalty, once for every alpha, penalty, source set and regularizer of gradients,
  /// and with the penalties of the cells for each source set. The Hessian, whose matrix alpha W_H +
  /// rho W_D no scaling reaches, is factored per penalty. Throws InputError if the data a
  /// regularizer needs is missing. Where many rows are expected (surfaces in space) it is ordered
  /// for each source set instead.
  RegularizedSolver(std::shared_ptr<const Operators> ops, Regularizer regularizer,
                    RegularizerData data, const Task& task, SolveHint hint = SolveHint::many_rhs,
                    ConstrainedSystem::Rows expected = ConstrainedSystem::Rows::few);

  /// Distance at the nodes (nodes) [length of the input] from where it is known, in units of the
  /// operators: not negative, +inf on components where nothing is known. Minimises eq. 11 by Alg. 1
  /// on each component by itself. `state`: from an earlier solve with the same sources, to start
  /// from; left as it is at the end.
  VecX solve(const KnownDistances& known, const Regularized& options, const Task& task,
             Report& report, AdmmState* state = nullptr) const;

  /// The same without units and without infinities. `sign`: unless null, 1 or -1 at the nodes,
  /// where u is to be as large or as small as it can.
  AdmmResult minimize(const KnownDistances& known, const Regularized& options, AdmmState& state,
                      const Task& task, const VecX* sign = nullptr) const;

  /// Components where something is known (components).
  std::vector<char> reached(const KnownDistances& known) const;

  const Operators& operators() const { return *ops_; }

 private:
  std::shared_ptr<const Operators> ops_;
  std::vector<RegularizedPart> parts_;  // components; of one component alone, all nodes
};

}  // namespace littoral
