#pragma once
// Poisson problems with constraints for which only the unconstrained solve is at hand.

#include <functional>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "littoral/types.h"

namespace littoral {

/// What is asked of A x.
struct ConstraintRows {
  const Eigen::SparseMatrix<double, Eigen::RowMajor>& A;  // rows x unknowns; row sums 1
  VecX softness;             // rows: 0 holds a row, s > 0 penalises it by (A x - c)^2 / (2 s)
  double tolerance;          // largest root mean square of A x - c + softness * multiplier [as x]
  std::vector<int> group{};  // rows: A x takes one value, unknown, along each; empty: `value`
  VecX value{};              // rows: c; empty: 0 along all
};

/// How L is solved for rows; constants are free, as mu below sums to zero.
struct ConstraintSolver {
  std::function<VecX(const VecX& v)> across;             // A L^+ A^T v
  std::function<void(VecX& x, const VecX& v)> subtract;  // x := x - L^+ A^T v
  /// An approximate inverse of A L^+ A^T + diag(softness), which keeps sums along groups; or none.
  std::function<VecX(const VecX&)> precondition = {};
};

/// mu with (A L^+ A^T + diag(softness)) mu = r up to a constant along each group, by conjugate
/// gradients over multipliers of sum zero along each. Iterations and the residual go to the report,
/// with the status "not converged" where 200 iterations do not reach the tolerance. Throws
/// Cancelled.
VecX constraint_multipliers(const ConstraintSolver& solver, const ConstraintRows& rows, VecX r,
                            const Task& task, Report& report);

/// Minimiser of 1/2 x^T L x - b^T x subject to A x = c or to one value a group (or with penalties
/// on what deviates from these), where L is positive semidefinite with the constants of one
/// component as its null space; 1^T b = 0.
///
/// The multipliers are those above for r = A x - c, one solve per iteration, so nothing is
/// assembled or factored. With groups the constant is left as it comes. x comes in as L^+ b.
VecX solve_constrained(const ConstraintSolver& solver, VecX x, const ConstraintRows& rows,
                       const Task& task, Report& report);

/// The same where `solve` replaces b by L^+ b, up to a constant.
VecX solve_constrained(const std::function<void(VecX&)>& solve, VecX x, const ConstraintRows& rows,
                       const Task& task, Report& report,
                       const std::function<VecX(const VecX&)>& precondition = {});

}  // namespace littoral
