#include "solve/optimization/admm.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/component_values.h"
#include "base/counted.h"
#include "base/index.h"
#include "base/now_and_then.h"
#include "base/parallel.h"
#include "base/parallel_sum.h"
#include "base/platform/large_pages.h"
#include "base/thread_crew.h"
#include "littoral/error.h"
#include "solve/optimization/shortened_gradients.h"

namespace littoral {

namespace {

constexpr std::size_t cells_at_once = 2048;
constexpr std::size_t cells_in_sum = 16384;  // of a piece: sums have other bits with others
constexpr std::size_t cells_in_cache = 512;  // whose numbers stay there from one loop to the next

constexpr int checks_every = 5;
constexpr int cells_from = 10;             // iteration in which cells get penalties of their own
constexpr int cells_again = 30;            // and new ones; then after as many more, or half of all
constexpr double over_multiplier = 4.0;    // which are this many times their multipliers
constexpr double share_of_longest = 0.25;  // of the gap asked for, that gradients are too long by

class Admm {
 public:
  Admm(const SplitProblem& problem, const AdmmOptions& options, AdmmState& state, const Task& task)
      : p_(problem),
        o_(options),
        state_(state),
        task_(task),
        D_(problem.divergence()),
        total_(problem.A.sum()) {
    const bool fresh = state_.empty();
    if (fresh) {
      state_.z = VecX::Zero(p_.dim * p_.A.size());
      state_.w = state_.z;
      state_.rho = o_.rho * p_.length();
    }
    rho_ = VecX::Constant(p_.A.size(), state_.rho);
    update_pull();
    if (fresh && p_.near_gradient.size() > 0) start_near();
  }

  AdmmResult run() {
    AdmmResult result;
    int changes_left = o_.penalty_changes;
    for (int k = 1; k <= o_.max_iterations; ++k) {
      task_.checkpoint(progress_);
      const bool last = k == o_.max_iterations, check = k == 1 || k % checks_every == 0 || last;
      iterate(check);
      result.iterations = k;
      if (!check) continue;
      residuals(result);
      const bool small = result.primal <= primal_tolerance_ && result.dual <= dual_tolerance_;
      if (small || last || (o_.gap > 0 && k % 20 == 0)) {
        evaluate_duality_gap(result);
        const bool certified = o_.certified <= 0 || result.gap <= o_.certified;
        result.converged = o_.gap > 0 ? result.gap <= o_.gap : small && certified;
        if (result.converged) break;
      }
      const double ratio =
          std::max(result.primal / primal_tolerance_, result.dual / dual_tolerance_);
      progress_ = std::max(progress_, 1 / (1 + std::log10(std::max(1.0, ratio))) * 0.95);
      if (next_of_cells_ > 0 && k >= next_of_cells_ && penalties_of_cells())
        next_of_cells_ = k < cells_again ? cells_again : k + std::max(cells_again, k / 2);
      else if (!solve_cells_ && changes_left > 0 && change_penalty(result, k))
        --changes_left;
    }
    if (solve_cells_) set_penalties(VecX::Constant(rho_.size(), state_.rho));
    result.u = std::move(answer_);
    return result;
  }

 private:
  /// From multipliers that are about right, with penalties that fit them.
  void start_near() {
    state_.w = p_.near_multipliers / state_.rho;
    if (!penalties_of_cells()) {
      state_.w.setZero();
      update_pull();
      return;
    }
    for_cells([&](Eigen::Index c, Eigen::Index i) {
      double s[3];
      for (int d = 0; d < p_.dim; ++d) s[d] = p_.near_gradient[i + d] + state_.w[i + d];
      p_.energy->prox(c, rho_[c], s, state_.z.data() + i);
      for (int d = 0; d < p_.dim; ++d) state_.w[i + d] = s[d] - state_.z[i + d];
    });
    update_pull();
  }

  /// body(c, i) for every cell c, whose first number is entry i.
  template <class Body>
  void for_cells(const Body& body) const {
    parallel_for(p_.A.size(), cells_at_once, [&](std::size_t c, std::size_t end) {
      for (; c < end; ++c) body(c, index(c) * p_.dim);
    });
  }

  /// Sum over cells of A times term(c, i), from none on, the same for any number of threads.
  template <class Sum, class Term>
  Sum sum_cells(const Sum& none, const Term& term) const {
    const auto sum = [&](std::size_t begin, std::size_t end) {
      Sum here = none;
      for (std::size_t c = begin; c < end; ++c)
        here += p_.A[index(c)] * term(index(c), index(c) * p_.dim);
      return here;
    };
    return of_pieces(std::size_t(p_.A.size()), cells_in_sum, none, sum,
                     [](const Sum& a, const Sum& b) -> Sum { return a + b; });
  }

  void iterate(bool keep_old) {
    VecX& z = state_.z;
    multiply(D_, pull_, force_, task_);
    parallel_for(p_.b.size(), cells_at_once, [&](std::size_t i, std::size_t end) {
      for (; i < end; ++i) force_[index(i)] += p_.b[index(i)];
    });
    u_ = solve_cells_ ? solve_cells_(force_) : p_.solve(force_, state_.rho);
    stop_if_cancelled(task_);
    if (keep_old) {
      old_z_.swap(z);
      old_pull_.swap(pull_);
      z.resize(old_z_.size());
      pull_.resize(old_pull_.size());
    }
    const double* const before = keep_old ? old_z_.data() : z.data();
    g_.resize(z.size());
    parallel_for(p_.A.size(), cells_at_once, [&](std::size_t c, std::size_t end) {
      for (; c < end; c += cells_in_cache)
        step_in_cells(index(c), index(std::min(end, c + cells_in_cache)), before);
    });
  }

  /// g := G u, then z and w from it.
  void step_in_cells(Eigen::Index first, Eigen::Index end, const double* before) {
    const int dim = p_.dim;
    const Eigen::Index begin = first * dim, stop = end * dim;
    double *g = g_.data(), *z = state_.z.data(), *w = state_.w.data();
    multiply_rows(p_.G, begin, stop, u_.data(), g);
    // Over-relaxation: G u is replaced by a mixture with the old z.
    const double relax = o_.relaxation;
    for (Eigen::Index i = begin; i < stop; ++i)
      w[i] = relax * g[i] + (1 - relax) * before[i] + w[i];
    p_.energy->prox_all(first, end - first, dim, rho_.data() + first, w + begin, z + begin);
    for (Eigen::Index c = first, i = begin; c < end; ++c)
      for (int d = 0; d < dim; ++d, ++i) {
        w[i] -= z[i];
        pull_[i] = rho_[c] * (z[i] - w[i]);
      }
  }

  VecX times_penalties(VecX v) const {
    for_cells([&](Eigen::Index c, Eigen::Index i) {
      for (int d = 0; d < p_.dim; ++d) v[i + d] *= rho_[c];
    });
    return v;
  }

  void update_pull() { pull_ = times_penalties(state_.z - state_.w); }

  double force_of(const VecX& scaled) {
    multiply(D_, scaled, force_, task_);
    return force_.norm() / total_;
  }

  /// Supplement 8, in units in which the total weight is 1.
  void residuals(AdmmResult& r) {
    const VecX &z = state_.z, &w = state_.w;
    scaled_.resize(z.size());
    const auto norms = sum_cells(Eigen::Array3d(0, 0, 0), [&](Eigen::Index c, Eigen::Index i) {
      Eigen::Array3d squared(0, 0, 0);  // of g - z, of g, of z
      for (int d = 0; d < p_.dim; ++d) {
        const double difference = g_[i + d] - z[i + d];
        squared[0] += difference * difference;
        squared[1] += g_[i + d] * g_[i + d];
        squared[2] += z[i + d] * z[i + d];
        scaled_[i + d] = rho_[c] * (z[i + d] - old_z_[i + d]);
      }
      return squared;
    });
    r.primal = std::sqrt(norms[0] / total_);
    r.dual = force_of(scaled_);
    for_cells([&](Eigen::Index c, Eigen::Index i) {
      for (int d = 0; d < p_.dim; ++d) scaled_[i + d] = rho_[c] * w[i + d];
    });
    primal_tolerance_ = std::sqrt(double(p_.dim) * double(p_.A.size())) * o_.absolute +
                        o_.relative * std::sqrt(std::max(norms[1], norms[2]) / total_);
    dual_tolerance_ =
        std::sqrt(double(p_.b.size())) * o_.absolute + o_.relative * force_of(scaled_);
    if (!std::isfinite(r.primal) || !std::isfinite(r.dual))
      throw SolveError("alternating directions diverged: non-finite iterate", "diverged");
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
    set_penalties(factor * rho_);
    next_change_ = k + 1 + k / 10;
    return true;
  }

  /// Other penalties for the same multipliers.
  void set_penalties(VecX rho) {
    for_cells([&](Eigen::Index c, Eigen::Index i) {
      for (int d = 0; d < p_.dim; ++d) state_.w[i + d] *= rho_[c] / rho[c];
    });
    rho_ = std::move(rho);
    update_pull();
  }

  /// Cells whose multipliers differ by orders of magnitude, as next to a source and far from it,
  /// converge at the same pace where each has a penalty in proportion. False if there is no solve.
  bool penalties_of_cells() {
    if (!p_.solve_cells) {
      next_of_cells_ = 0;
      return false;
    }
    const double least = o_.least * p_.length();
    VecX rho(rho_.size());
    for_cells([&](Eigen::Index c, Eigen::Index i) {
      rho[c] = over_multiplier * std::max(least, rho_[c] * state_.w.segment(i, p_.dim).norm());
    });
    solve_cells_ = nullptr;  // one factor at a time
    try {
      solve_cells_ = p_.solve_cells(rho, D_);
    } catch (const SolveError&) {  // not positive definite to working precision, or too large
    }
    if (!solve_cells_) {  // and none ever
      set_penalties(VecX::Constant(rho_.size(), state_.rho));
      next_of_cells_ = 0;
      return false;
    }
    set_penalties(std::move(rho));
    return true;
  }

  /// Objective of a feasible u and a lower bound. By the u-step, y = rho (w + G u - z), z and w
  /// from before it, satisfies P u + D y = b on the allowed directions; so by Fenchel's inequality
  /// -1/2 u^T P u - sum A phi*(y) is a lower bound. The feasible u is that of the u-step divided by
  /// its longest gradient; that may be one of few cells, around which it is changed first.
  void evaluate_duality_gap(AdmmResult& r) {
    answer_ = allowed();
    VecX g = g_;
    if (p_.allowed) multiply(p_.G, answer_, g, task_);
    const double asked = o_.gap > 0 ? o_.gap : o_.certified;
    if (!p_.fixed.empty() && asked > 0)
      if (auto shorter = with_shortened_gradients({p_.G, D_, p_.A, p_.dim}, answer_, g, p_.fixed,
                                                  1 + share_of_longest * asked, task_)) {
        answer_ = std::move(*shorter);
        multiply(p_.G, answer_, g, task_);
      }
    const auto largest = [&](std::size_t begin, std::size_t end) {
      double here = 0;
      for (Eigen::Index c = index(begin); c < index(end); ++c)
        here = std::max(here, p_.energy->gauge(c, g.data() + c * p_.dim));
      return here;
    };
    r.largest = of_pieces(std::size_t(p_.A.size()), cells_in_sum, 0.0, largest, Larger());
    const double shrink = 1 / std::max(1.0, r.largest);
    g *= shrink;
    const auto squared = [&](const VecX& x) { return p_.quadratic ? x.dot(p_.quadratic(x)) : 0; };
    const VecX y = times_penalties(g_) - old_pull_;
    const double phi = sum_cells(
        0.0, [&](Eigen::Index c, Eigen::Index i) { return p_.energy->value(c, g.data() + i); });
    const double conjugate = sum_cells(
        0.0, [&](Eigen::Index c, Eigen::Index i) { return p_.energy->conjugate(c, y.data() + i); });
    r.objective = 0.5 * shrink * shrink * squared(answer_) - shrink * p_.b.dot(answer_) + phi;
    const double bound = -0.5 * squared(u_) - conjugate;
    // Where the constraints leave nothing but 0, the objective is round-off of this size.
    const double least = 1e-12 * p_.b.lpNorm<1>() * p_.length();
    r.gap = (r.objective - bound) / std::max({std::abs(r.objective), least, 1e-300});
  }

  VecX allowed() const { return p_.allowed ? p_.allowed(u_) : u_; }

  const KeepLargePages keep_pages_;  // each factor goes where the one before was
  const KeepThreads keep_threads_;   // ten loops an iteration
  const SplitProblem& p_;
  const AdmmOptions& o_;
  AdmmState& state_;
  const Task& task_;
  SpRows D_;
  double total_;
  SplitProblem::Solve solve_cells_;  // with rho_, where cells have their own
  VecX rho_;                         // cells; state_.rho is that of all until then
  VecX u_, g_, force_, pull_, old_z_, old_pull_, scaled_;  // pull: rho (z - w)
  VecX answer_;                                            // u_ as it is given back
  double primal_tolerance_ = 0, dual_tolerance_ = 0, progress_ = 0;
  int next_change_ = 0, next_of_cells_ = cells_from;
};

}  // namespace

SpRows SplitProblem::divergence() const {
  SpRows D = transposed(G);
  parallel_for(std::size_t(D.nonZeros()), cells_at_once, [&](std::size_t e, std::size_t end) {
    for (; e < end; ++e) D.valuePtr()[e] *= A[D.innerIndexPtr()[e] / dim];
  });
  return D;
}

double SplitProblem::length() const { return std::pow(A.sum(), 1.0 / dim); }

AdmmResult admm(const SplitProblem& problem, const AdmmOptions& options, AdmmState& state,
                const Task& task) {
  return Admm(problem, options, state, task).run();
}

void report_admm(const AdmmResult& result, Report& report) {
  ComponentValues iterations("admm"), primal("admm, primal"), dual("admm, dual"),
      gap("duality gap"), longest("largest gradient over 1");
  const auto add = [&](const AdmmResult& r) {
    iterations.add(r.component, r.iterations);
    primal.add(r.component, r.primal);
    dual.add(r.component, r.dual);
    gap.add(r.component, r.gap);
    longest.add(r.component, std::max(0.0, r.largest - 1));
  };
  for (const AdmmResult& part : result.parts) add(part);
  if (result.parts.empty()) add(result);
  iterations.report_sum(report.iterations);
  for (const ComponentValues* values : {&primal, &dual, &gap, &longest})
    values->report_worst(report.residuals);
  if (!result.converged) {
    report.status = "not converged";
    report.warn("not-converged", "alternating directions stopped after " +
                                     counted(result.iterations, "iteration", "iterations") +
                                     ", above the tolerance: the result is the last iterate. Raise "
                                     "option max-iterations or option tolerance");
  }
}

}  // namespace littoral
