#pragma once
// min 1/2 x^T L x - b^T x for a positive semidefinite L whose null space is the constants of each
// component, without and with linear constraints.

#include <memory>
#include <vector>

#include "littoral/base/report.h"
#include "littoral/base/task.h"
#include "littoral/base/types.h"
#include "littoral/solve/cholesky.h"

namespace littoral {

/// A symmetric positive definite system solved to working accuracy: Cholesky, lifted on the
/// diagonal if the matrix is numerically singular, and preconditioned conjugate gradients on the
/// exact matrix until the residual stops falling.
class DefiniteSystem {
 public:
  DefiniteSystem(SpMat lower, const Task& task);
  VecX solve(const VecX& b) const;
  /// One pass through the factor, for outer loops that correct each other's rounding; `solve` where
  /// the matrix had to be lifted.
  VecX solve_once(const VecX& b) const;
  double relative_residual(const VecX& x, const VecX& b) const;
  double nonzeros() const { return factor_->nonzeros(); }
  double lift() const { return lift_; }

 private:
  std::shared_ptr<const SpMat> A_;
  std::shared_ptr<const Cholesky<double>> factor_;
  double lift_ = 0;
};

/// K with the rows and columns of the marked unknowns those of the identity. Lower triangles.
SpMat eliminated(const SpMat& K, const std::vector<char>& gone);

/// Rows of A x = B c with one unknown constant per group, c of the first group of every component
/// being 0: x takes one value along all rows of a group.
struct LevelRows {
  SpMat A;                  // rows x unknowns
  std::vector<int> group;   // per row
  std::vector<int> anchor;  // per group: 1 if its constant is fixed at 0, else 0
};

/// Poisson problem of one operator; immutable.
class Poisson {
 public:
  /// L: lower triangle. component: per unknown, -1 for unknowns in no equation.
  Poisson(const SpMat& L, std::vector<int> component, int n_components, const Task& task);

  /// Minimiser that is 0 at the first unknown of every component; b must sum to 0 over each.
  VecX solve(const VecX& b, Report& report) const;

  /// Minimiser subject to the rows. Every component must have an anchored group or no row.
  /// Dependent rows are harmless.
  VecX solve_levels(const VecX& b, const LevelRows& rows, const Task& task, Report& report) const;

  /// Minimiser of 1/2 x^T L x - b^T x + 1/2 sum_r weight_r (A x)_r^2.
  VecX solve_soft(const VecX& b, const SpMat& A, const VecX& weight, const Task& task,
                  Report& report) const;

  double nonzeros() const { return pinned_.nonzeros(); }

 private:
  SpMat pinned(const SpMat& K, const std::vector<char>& held) const;
  std::vector<char> components_of(const SpMat& A) const;

  SpMat L_;
  std::vector<int> component_;
  std::vector<int> first_;  // per component
  DefiniteSystem pinned_;
};

}  // namespace littoral
