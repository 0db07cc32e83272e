#pragma once
// min 1/2 x^T L x - b^T x for a positive semidefinite L whose null space is the constants of each
// component, without and with linear constraints.

#include <memory>
#include <vector>

#include "base/lazy.h"
#include "base/task.h"
#include "littoral/report.h"
#include "littoral/types.h"
#include "solve/direct/definite.h"

namespace littoral {

/// Rows of A x = B c + value with one unknown constant per group, c of the first group of every
/// component being 0: x takes one value along all rows of a group.
struct LevelRows {
  SpMat A;                  // rows x unknowns
  std::vector<int> group;   // per row
  std::vector<int> anchor;  // per group: 1 if its constant is fixed at 0, else 0
  VecX value{};             // per row; empty: all 0
};

/// How Poisson problems are solved: by a factor, which makes further solves cheap, or by multigrid,
/// in memory and time that grow like the number of unknowns. Where one solve is expected, the
/// factor is made by the solve, with its constraints in it.
enum class PoissonSolver { automatic, automatic_for_one_solve, direct, multigrid };

/// Poisson problem of one operator; immutable. Constraints whose rows hold neighbours of L only (as
/// values at points of a mesh do) change few columns of the factor: the rest is shared.
class Poisson {
 public:
  /// L: lower triangle, shared, or copied. component: per unknown, -1 for unknowns in no equation.
  /// order: of elimination; dissection(L) if empty. Automatic: by multigrid above 2M unknowns, for
  /// one solve above 400k.
  Poisson(std::shared_ptr<const SpMat> L, std::vector<int> component, int n_components,
          const Task& task, const Ordering& order = {},
          PoissonSolver solver = PoissonSolver::automatic);
  Poisson(const SpMat& L, std::vector<int> component, int n_components, const Task& task,
          const Ordering& order = {}, PoissonSolver solver = PoissonSolver::automatic);

  /// Minimiser that is 0 at the first unknown of every component; b must sum to 0 over each.
  VecX solve(const VecX& b, Report& report, const Task& task = {}) const;

  /// Minimiser subject to the rows. Every component must have an anchored group or no row.
  /// Dependent rows are harmless.
  VecX solve_levels(const VecX& b, const LevelRows& rows, const Task& task, Report& report) const;

  /// Minimiser of 1/2 x^T L x - b^T x + 1/2 sum_r weight_r (A x - value)_r^2. value: rows, or
  /// empty: all 0.
  VecX solve_soft(const VecX& b, const SpMat& A, const VecX& weight, const Task& task,
                  Report& report, const VecX& value = {}) const;

  double nonzeros() const;  // of the factor or the multigrid levels
  bool iterates() const { return structure_ == nullptr; }
  /// Of the factor of L with its whole diagonal; null with multigrid.
  const std::shared_ptr<const Elimination>& structure() const { return structure_; }
  const DefiniteSystem& system(const Task& task = {}) const;  // without constraints

 private:
  std::vector<int> loose(const std::vector<char>& fixed) const;
  SpMat pinned(const std::vector<int>& loose) const;
  DefiniteSystem unconstrained(const Task& task) const;
  std::vector<char> components_of(const SpMat& A) const;
  void drop_constants(const std::vector<char>& fixed, VecX& x) const;
  std::shared_ptr<const DefiniteSystem> with_penalty(const SpMat& A, const VecX& weight,
                                                     const std::vector<char>& fixed,
                                                     const Task& task) const;
  DefiniteSystem penalized(const SpMat& A, const VecX& weight, const std::vector<char>& fixed,
                           const Task& task) const;

  /// Rows and weights of a penalty.
  struct Penalty {
    SpMat A;
    VecX weight;
    bool operator==(const Penalty& other) const;
  };
  /// Systems that are made when a solve needs them.
  struct Made {
    Kept<DefiniteSystem> free;
    KeptLast<Penalty, DefiniteSystem> penalized;  // where one solve is expected
  };

  std::shared_ptr<const SpMat> L_;  // with an entry on the whole diagonal
  double mean_diagonal_;
  std::vector<int> component_;
  std::vector<int> first_;  // per component
  bool one_solve_;
  std::shared_ptr<const Elimination> structure_;  // none with multigrid
  std::shared_ptr<const Made> made_ = std::make_shared<const Made>();
};

}  // namespace littoral
