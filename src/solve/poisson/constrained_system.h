#pragma once
// Repeated solves with a semidefinite matrix under constraints that change from call to call.

#include <memory>
#include <vector>

#include "base/lazy.h"
#include "base/task.h"
#include "littoral/types.h"
#include "solve/poisson/poisson.h"

namespace littoral {

/// One order of elimination and, once something has been solved with K, one factorization of a
/// positive semidefinite K whose null space is the constants of every component. Copies share them;
/// may be used from several threads.
class ConstrainedSystem {
 public:
  /// How many rows there will be: many are ordered and factored for when they are known only.
  enum class Rows { few, many };

  /// K: lower triangle. component: per unknown, -1 for unknowns in no equation.
  ConstrainedSystem(SpMat K, std::vector<int> component, int n_components, const Task& task,
                    Rows expected = Rows::few);

  /// min 1/2 u^T K u - b^T u subject to A u = 0, over the components that have a row; u = 0
  /// elsewhere. Const, from several threads.
  class Constrained {
   public:
    /// One pass through a factor for each column.
    VecX solve(const VecX& b) const;

   private:
    friend class ConstrainedSystem;
    VecX solve_gauged(const VecX& b) const;

    std::shared_ptr<const DefiniteSystem> factor_;
    std::vector<int> component_;
    std::vector<char> active_;  // components with a row
    std::vector<char> gone_;    // unknowns held at zero by elimination
    std::vector<char> pinned_;  // unknowns that the factor leaves out: those, and one per gauge
    VecX give_;                 // components; of the gauge
    SpMat gauge_;               // unknowns x components; a row with sum 1 that fixes each constant
    SpMat rest_;                // unknowns x rows; the other rows
    Eigen::MatrixXd response_;  // unknowns x rows; solutions for them
    Eigen::MatrixXd inverse_;   // rows x rows; of rest^T response
  };

  /// Rows (rows x unknowns) whose entries sum to 1. One row a component reuses the factorization
  /// as it is; up to 64 rows more cost a solve each. Beyond, K is factored again: rows that hold
  /// single unknowns are eliminated, the others added as a stiff penalty.
  ///
  /// give: rows, or empty: all 0. A row with give s > 0 is not held: (A u)^2 / (2 s) is added to
  /// what is minimised.
  Constrained constrain(const SpMat& rows, const Task& task, const VecX& give = {}) const;

  /// The same for a matrix with the pattern of K, on the same structure. `like`: made by this
  /// system from rows with the same pattern, or nothing, which if there are many takes an order
  /// more.
  Constrained constrain_like(const Constrained& like, SpMat matrix, const SpMat& rows,
                             const Task& task, const VecX& give = {}) const;

  /// Multiply-adds of a factorization for every number of the factor: what constrain_like costs
  /// beside a solve. Of the one that `like` has, or of K's; 0 if there is neither.
  double flops_of_number(const Constrained& like) const;

 private:
  void constrain_many(const SpMat& rows, const VecX& give, Constrained& constrained,
                      const Task& task) const;

  std::shared_ptr<const SpMat> K_;
  std::vector<int> component_;
  int n_components_;
  std::vector<char> pinned_;
  std::shared_ptr<const Elimination> structure_;  // none where many rows are expected
  std::shared_ptr<Kept<DefiniteSystem>> factor_;  // of K on it
  std::shared_ptr<const Elimination> of_many_;    // structure for many rows, if it is known
};

}  // namespace littoral
