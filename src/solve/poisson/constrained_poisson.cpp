#include "solve/poisson/constrained_poisson.h"

#include <cmath>

namespace littoral {

namespace {
constexpr int max_iterations = 200;

void remove_mean(VecX& v) { v.array() -= v.mean(); }
}  // namespace

VecX solve_constrained(const std::function<void(VecX&)>& solve, VecX x, const ConstraintRows& rows,
                       const Task& task, Report& report) {
  const SpMat& A = rows.A;
  if (A.rows() == 0) return x;
  // Stationarity: L x + A^T mu = b, A x = softness mu; L x sums to zero, so mu does too (the rows
  // of A sum to 1), and the constant part of x balances the mean of A x.
  VecX mu = VecX::Zero(A.rows());
  VecX r = A * x;
  remove_mean(r);
  VecX p = r;
  double rr = r.squaredNorm();
  const double start = std::sqrt(rr / static_cast<double>(A.rows()));
  int iteration = 0;
  const auto residual = [&] { return std::sqrt(rr / static_cast<double>(A.rows())); };
  for (; iteration < max_iterations && residual() > rows.tolerance; ++iteration) {
    // Residuals fall geometrically: their logarithm is the progress.
    const double done = std::log(start / residual()) / std::log(start / rows.tolerance);
    task.checkpoint(std::min(1.0, std::max(0.0, done)));
    VecX s = A.transpose() * p;
    solve(s);
    VecX q = A * s + rows.softness.cwiseProduct(p);
    remove_mean(q);
    const double curvature = p.dot(q);
    if (!(curvature > 0)) break;
    const double step = rr / curvature;
    mu += step * p;
    r -= step * q;
    const double before = rr;
    rr = r.squaredNorm();
    p = r + (rr / before) * p;
  }
  report.iterations.emplace_back("constraint", iteration);
  report.residuals.emplace_back("constraint", start > 0 ? residual() / start : 0);
  if (residual() > rows.tolerance) report.status = "not converged";
  if (iteration > 0) {
    VecX s = A.transpose() * mu;
    solve(s);
    x -= s;
  }
  const VecX left = A * x - rows.softness.cwiseProduct(mu);
  x.array() -= left.mean();
  return x;
}

}  // namespace littoral
