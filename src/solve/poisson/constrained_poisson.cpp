#include "solve/poisson/constrained_poisson.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace littoral {

namespace {
constexpr int most_iterations = 200;

/// Of each group.
void remove_means(const std::vector<int>& group, VecX& v) {
  if (group.empty()) {
    v.array() -= v.mean();
    return;
  }
  const int n = 1 + *std::max_element(group.begin(), group.end());
  VecX sum = VecX::Zero(n), count = sum;
  for (Eigen::Index r = 0; r < v.size(); ++r) {
    sum[group[r]] += v[r];
    count[group[r]] += 1;
  }
  for (Eigen::Index r = 0; r < v.size(); ++r) v[r] -= sum[group[r]] / count[group[r]];
}

/// s = L^+ A^T v, in the same place each time: fresh memory of that size takes as long as the sums.
void spread_and_solve(const std::function<void(VecX&)>& solve,
                      const Eigen::SparseMatrix<double, Eigen::RowMajor>& A, const VecX& v,
                      const Task& task, VecX& s) {
  s.setZero();
  s.noalias() += A.transpose() * v;
  task.checkpoint();
  solve(s);
  task.checkpoint();
}
}  // namespace

VecX constraint_multipliers(const ConstraintSolver& solver, const ConstraintRows& rows, VecX r,
                            const Task& task, Report& report) {
  const auto& A = rows.A;
  const auto& precondition = solver.precondition;
  VecX mu = VecX::Zero(A.rows());
  remove_means(rows.group, r);
  VecX z = precondition ? precondition(r) : r;
  VecX p = z;
  double rr = r.squaredNorm(), rz = r.dot(z);
  const double start = std::sqrt(rr / static_cast<double>(A.rows()));
  int iteration = 0;
  const auto residual = [&] { return std::sqrt(rr / static_cast<double>(A.rows())); };
  for (; iteration < most_iterations && residual() > rows.tolerance; ++iteration) {
    // Residuals fall geometrically: their logarithm is the progress.
    const double done = std::log(start / residual()) / std::log(start / rows.tolerance);
    task.checkpoint(std::min(1.0, std::max(0.0, done)));
    VecX q = solver.across(p) + rows.softness.cwiseProduct(p);
    remove_means(rows.group, q);
    const double curvature = p.dot(q);
    if (!(curvature > 0)) break;
    const double step = rz / curvature;
    mu += step * p;
    const double before = rz;
    if (precondition) {
      // Flexible: a preconditioner that iterates itself is another one each time.
      const VecX old = r;
      r -= step * q;
      z = precondition(r);
      rr = r.squaredNorm();
      rz = r.dot(z);
      p = z + (rz - old.dot(z)) / before * p;
    } else {
      r -= step * q;
      rr = rz = r.squaredNorm();
      p = r + (rz / before) * p;
    }
  }
  report.iterations.emplace_back("constraint", iteration);
  report.residuals.emplace_back("constraint", start > 0 ? residual() / start : 0);
  if (residual() > rows.tolerance) report.status = "not converged";
  return mu;
}

VecX solve_constrained(const ConstraintSolver& solver, VecX x, const ConstraintRows& rows,
                       const Task& task, Report& report) {
  const auto& A = rows.A;
  if (A.rows() == 0) return x;
  // Stationarity: L x + A^T mu = b, A x = c + softness mu; L x sums to zero, so mu does too (the
  // rows of A sum to 1), and the constant part of x balances the mean of A x - c. Groups: A x = B c
  // + softness mu with c free, so B^T mu = 0.
  const auto off = [&](VecX Ax) {
    if (rows.value.size() > 0) Ax -= rows.value;
    return Ax;
  };
  const VecX mu = constraint_multipliers(solver, rows, off(A * x), task, report);
  if (!mu.isZero(0)) solver.subtract(x, mu);
  if (!rows.group.empty()) return x;
  const VecX left = off(A * x) - rows.softness.cwiseProduct(mu);
  x.array() -= left.mean();
  return x;
}

VecX solve_constrained(const std::function<void(VecX&)>& solve, VecX x, const ConstraintRows& rows,
                       const Task& task, Report& report,
                       const std::function<VecX(const VecX&)>& precondition) {
  VecX s(x.size());
  const auto across = [&](const VecX& v) {
    spread_and_solve(solve, rows.A, v, task, s);
    return VecX(rows.A * s);
  };
  const auto subtract = [&](VecX& y, const VecX& v) {
    spread_and_solve(solve, rows.A, v, task, s);
    y -= s;
  };
  return solve_constrained(ConstraintSolver{across, subtract, precondition}, std::move(x), rows,
                           task, report);
}

}  // namespace littoral
