#include "littoral/solve/admm.h"

#include <algorithm>
#include <cmath>

#include "littoral/base/error.h"
#include "littoral/base/parallel.h"

namespace littoral {

namespace {

constexpr std::size_t grain = 16384;

class Admm {
 public:
  Admm(const SplitProblem& problem, const AdmmOptions& options, AdmmState& state)
      : p_(problem), o_(options), state_(state), total_(problem.A.sum()) {
    if (state_.empty()) {
      state_.z = VecX::Zero(p_.dim * p_.A.size());
      state_.w = state_.z;
      state_.rho = o_.rho * std::sqrt(total_);
    }
  }

  AdmmResult run(const Task& task) {
    AdmmResult result;
    int changes_left = o_.penalty_changes;
    for (int k = 1; k <= o_.max_iterations; ++k) {
      task.checkpoint(progress_);
      iterate();
      result.iterations = k;
      residuals(result);
      if (result.primal <= primal_tolerance_ && result.dual <= dual_tolerance_) {
        certify(result);
        if (o_.gap <= 0 || result.gap <= o_.gap) {
          result.converged = true;
          break;
        }
      } else if (o_.gap > 0 && k % 20 == 0) {
        certify(result);
        if (result.gap <= o_.gap) {
          result.converged = true;
          break;
        }
      }
      const double ratio =
          std::max(result.primal / primal_tolerance_, result.dual / dual_tolerance_);
      progress_ = std::max(progress_, 1 / (1 + std::log10(std::max(1.0, ratio))) * 0.95);
      if (changes_left > 0 && change_penalty(result, k)) --changes_left;
    }
    if (!result.converged) certify(result);
    result.u = u_;
    return result;
  }

 private:
  void prox(const VecX& s) {
    const int dim = p_.dim;
    parallel_for(static_cast<std::size_t>(p_.A.size()), grain, [&](std::size_t i, std::size_t end) {
      for (; i < end; ++i) {
        const auto c = static_cast<Eigen::Index>(i);
        p_.energy->prox(c, state_.rho, s.data() + c * dim, state_.z.data() + c * dim);
      }
    });
  }

  void iterate() {
    old_z_ = state_.z;
    old_w_ = state_.w;
    u_ = p_.solve(p_.b + state_.rho * p_.divergence(state_.z - state_.w), state_.rho);
    g_ = p_.gradient(u_);
    // Over-relaxation: G u is replaced by a mixture with the old z.
    const VecX s = o_.relaxation * g_ + (1 - o_.relaxation) * state_.z + state_.w;
    prox(s);
    state_.w = s - state_.z;
  }

  /// Supplement 8, in units in which the total weight is 1.
  void residuals(AdmmResult& r) {
    const int dim = p_.dim;
    double gap2 = 0, g2 = 0, z2 = 0;
    for (Eigen::Index c = 0; c < p_.A.size(); ++c) {
      const auto g = g_.segment(c * dim, dim);
      const auto z = state_.z.segment(c * dim, dim);
      gap2 += p_.A[c] * (g - z).squaredNorm();
      g2 += p_.A[c] * g.squaredNorm();
      z2 += p_.A[c] * z.squaredNorm();
    }
    r.primal = std::sqrt(gap2 / total_);
    r.dual = state_.rho * p_.divergence(state_.z - old_z_).norm() / total_;
    primal_tolerance_ = std::sqrt(double(dim) * double(p_.A.size())) * o_.absolute +
                        o_.relative * std::sqrt(std::max(g2, z2) / total_);
    dual_tolerance_ = std::sqrt(double(p_.b.size())) * o_.absolute +
                      o_.relative * state_.rho * p_.divergence(state_.w).norm() / total_;
    if (!std::isfinite(r.primal) || !std::isfinite(r.dual))
      throw SolveError("alternating directions left the range of numbers");
  }

  /// Section 3.4.1. Rarer and rarer, so that it ends.
  bool change_penalty(const AdmmResult& r, int k) {
    if (k < next_change_) return false;
    const double primal = r.primal / primal_tolerance_, dual = r.dual / dual_tolerance_;
    double factor = 1;
    if (primal > 10 * dual) factor = 2;
    if (dual > 10 * primal) factor = 0.5;
    if (factor == 1) return false;
    state_.rho *= factor;
    state_.w /= factor;
    next_change_ = k + 1 + k / 10;
    return true;
  }

  /// Objective of a feasible u and a lower bound. By the u-step, y = rho (w + G u - z), z and w
  /// from before it, satisfies P u + D y = b on the allowed directions; so by Fenchel's inequality
  /// -1/2 u^T P u - sum A phi*(y) is a lower bound.
  void certify(AdmmResult& r) const {
    const int dim = p_.dim;
    r.largest = 0;
    for (Eigen::Index c = 0; c < p_.A.size(); ++c)
      r.largest = std::max(r.largest, p_.energy->gauge(c, g_.data() + c * dim));
    const double shrink = 1 / std::max(1.0, r.largest);
    const double uPu = p_.quadratic ? u_.dot(p_.quadratic(u_)) : 0;
    const VecX y = state_.rho * (old_w_ + g_ - old_z_), g = shrink * g_;
    double phi = 0, conjugate = 0;
    for (Eigen::Index c = 0; c < p_.A.size(); ++c) {
      phi += p_.A[c] * p_.energy->value(c, g.data() + c * dim);
      conjugate += p_.A[c] * p_.energy->conjugate(c, y.data() + c * dim);
    }
    r.objective = 0.5 * shrink * shrink * uPu - shrink * p_.b.dot(u_) + phi;
    const double bound = -0.5 * uPu - conjugate;
    r.gap = (r.objective - bound) / std::max(std::abs(r.objective), 1e-300);
  }

  const SplitProblem& p_;
  const AdmmOptions& o_;
  AdmmState& state_;
  double total_;
  VecX u_, g_, old_z_, old_w_;
  double primal_tolerance_ = 0, dual_tolerance_ = 0, progress_ = 0;
  int next_change_ = 0;
};

}  // namespace

AdmmResult admm(const SplitProblem& problem, const AdmmOptions& options, AdmmState& state,
                const Task& task) {
  return Admm(problem, options, state).run(task);
}

void report_admm(const AdmmResult& result, Report& report) {
  report.iterations.emplace_back("admm", result.iterations);
  report.residuals.emplace_back("admm, primal", result.primal);
  report.residuals.emplace_back("admm, dual", result.dual);
  report.residuals.emplace_back("duality gap", result.gap);
  report.residuals.emplace_back("largest gradient over 1", std::max(0.0, result.largest - 1));
  if (!result.converged) {
    report.status = "not converged";
    report.warn("alternating directions stopped after " + std::to_string(result.iterations) +
                " iterations above the tolerance");
  }
}

}  // namespace littoral
