#pragma once
// One connected component of a domain as a problem of its own: norms, penalty, tolerances and
// smoothing are relative to its size.

#include <memory>
#include <vector>

#include "base/lazy.h"
#include "base/task.h"
#include "littoral/options.h"
#include "operators/calculus.h"
#include "solve/optimization/admm.h"
#include "solve/poisson/constrained_system.h"
#include "sources/surface/known_distances.h"

namespace littoral {

/// What some regularizers need beside the operators.
struct RegularizerData {
  VecX V;              // 2 cells; align: directions in the cells' frames
  MatX3 frames{0, 3};  // 2 cells x 3; max_norm: each cell's axes in space
  SpMat W;             // nodes x nodes, lower triangle; hessian: W_H
};

/// A component's operators and, once it has been solved on, what solves with them; `minimize` may
/// be called from several threads.
class RegularizedPart {
 public:
  /// C: of this component alone, or with nodes in no cell beside it.
  RegularizedPart(std::shared_ptr<const Calculus> C, Regularizer regularizer, RegularizerData data,
                  ConstrainedSystem::Rows expected);

  /// Orders, if that has not been done.
  void order(const Task& task) const;

  /// Eq. 11 where distances are known, by the part's own nodes; as RegularizedSolver::minimize.
  AdmmResult minimize(const KnownDistances& known, const Regularized& options, AdmmState& state,
                      const Task& task, const VecX* sign) const;

  std::vector<int> nodes;  // of the whole domain; empty: all of them

 private:
  std::shared_ptr<const ConstrainedSystem> laplacian(const Task& task) const;

  std::shared_ptr<const Calculus> C_;
  Regularizer regularizer_;
  std::shared_ptr<const RegularizerData> data_;
  ConstrainedSystem::Rows expected_;
  std::shared_ptr<Kept<ConstrainedSystem>> laplacian_;
};

/// The components of a domain; one alone shares C. Throws InputError if the data a regularizer
/// needs is missing.
std::vector<RegularizedPart> regularized_parts(const std::shared_ptr<const Calculus>& C,
                                               Regularizer regularizer, RegularizerData data,
                                               ConstrainedSystem::Rows expected);

}  // namespace littoral
