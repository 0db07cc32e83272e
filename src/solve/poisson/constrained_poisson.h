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

/// mu with (A L^+ A^T + diag(softness)) mu = r up to a constant along each group, by conjugate
/// gradients over multipliers of sum zero along each. `solve` replaces b by L^+ b up to a constant.
/// `precondition`, where given, is an approximate inverse of that matrix, which keeps these sums.
/// Iterations and the residual go to the report, with the status "not converged" where 200
/// iterations do not reach the tolerance. Throws Cancelled.
VecX constraint_multipliers(const std::function<void(VecX&)>& solve, const ConstraintRows& rows,
                            VecX r, const Task& task, Report& report,
                            const std::function<VecX(const VecX&)>& precondition = {});

/// Minimiser of 1/2 x^T L x - b^T x subject to A x = c or to one value a group (or with penalties
/// on what deviates from these), where L is positive semidefinite with the constants of one
/// component as its null space; 1^T b = 0.
///
/// The multipliers are those above for r = A x - c, one solve per iteration, so nothing is
/// assembled or factored. With groups the constant is left as it comes. x comes in as L^+ b.
VecX solve_constrained(const std::function<void(VecX&)>& solve, VecX x, const ConstraintRows& rows,
                       const Task& task, Report& report,
                       const std::function<VecX(const VecX&)>& precondition = {});

}  // namespace littoral
