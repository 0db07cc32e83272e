#include "solve/optimization/pdhg.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr std::size_t rows_at_once = 16384;
constexpr int steps_between_checks = 10;

/// Largest eigenvalue of M^-1 D G, from below, by the power method; starts rough.
double largest_eigenvalue(const SpRows& G, const SpRows& D, const VecX& inverse, const Task& task) {
  VecX x(inverse.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = std::sin(12.9898 * double(i + 1)) * inverse[i];
  double value = 0;
  VecX g, force;
  for (int k = 0; k < 40 && x.norm() > 0; ++k) {
    x /= x.norm();
    multiply(G, x, g, task);
    multiply(D, g, force, task);
    x = inverse.cwiseProduct(force);
    value = x.norm();
  }
  return value;
}

}  // namespace

AdmmResult pdhg(const SplitProblem& p, const VecX& M, const VecX& u0, const AdmmOptions& options,
                const Task& task) {
  VecX inverse(M.size());
  for (Eigen::Index i = 0; i < M.size(); ++i) inverse[i] = M[i] > 0 ? 1 / M[i] : 0;
  const int dim = p.dim;
  const double total = p.A.sum();
  const SpRows D = p.divergence();
  const double root = std::sqrt(1.1 * std::max(largest_eigenvalue(p.G, D, inverse, task), 1e-300));
  constexpr double balance = 0.3;  // tau = balance / root, sigma = 1 / (balance root)
  const double tau = balance / root, sigma = 1 / (balance * root);
  AdmmResult r;
  VecX u = u0, ahead = u0, y = VecX::Zero(dim * p.A.size()), force, g;
  double progress = 0;
  for (int k = 1; k <= options.max_iterations; ++k) {
    task.checkpoint(progress);
    r.iterations = k;
    const bool check = k % steps_between_checks == 0 || k == options.max_iterations;
    // y + sigma G u, less sigma times the nearest allowed gradient (Moreau).
    multiply(p.G, ahead, g, task);
    VecX v = y / sigma + g, z(v.size());
    parallel_for(p.A.size(), rows_at_once, [&](std::size_t i, std::size_t end) {
      for (; i < end; ++i) {
        const Eigen::Index c = i;
        p.energy->prox(c, sigma, v.data() + c * dim, z.data() + c * dim);
      }
    });
    y = sigma * (v - z);
    multiply(D, y, force, task);
    const VecX next = u + tau * inverse.cwiseProduct(p.b - force);
    ahead = 2 * next - u;
    if (check) {
      // What the optimality conditions lack: M (u - next) / tau, and G u beyond z.
      multiply(p.G, next, g, task);
      double gap2 = 0, g2 = 0;
      for (Eigen::Index c = 0; c < p.A.size(); ++c) {
        gap2 += p.A[c] * (g - z).segment(c * dim, dim).squaredNorm();
        g2 += p.A[c] * g.segment(c * dim, dim).squaredNorm();
      }
      r.primal = std::sqrt(gap2 / total);
      const VecX left = p.b - force;
      r.dual = std::sqrt(left.dot(inverse.cwiseProduct(left)) / total);
      if (!std::isfinite(r.primal) || !std::isfinite(r.dual))
        throw SolveError("the primal-dual method diverged: non-finite iterate", "diverged");
      const double primal_tolerance = options.relative * std::sqrt(std::max(g2 / total, 1e-6));
      const double dual_tolerance =
          options.relative * std::sqrt(p.b.dot(inverse.cwiseProduct(p.b)) / total);
      const double primal = r.primal / primal_tolerance, dual = r.dual / dual_tolerance;
      progress = std::max(progress, 0.95 / (1 + std::log10(std::max({1.0, primal, dual}))));
      if (primal <= 1 && dual <= 1) {
        r.converged = true;
        u = next;
        break;
      }
    }
    u = next;
  }
  r.u = u;
  r.objective = -p.b.dot(u);
  return r;
}

}  // namespace littoral
