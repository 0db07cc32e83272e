#include "littoral/solve/parabolic_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "littoral/base/error.h"
#include "littoral/solve/cholesky.h"
#include "littoral/solve/parabolic_blocks.h"

namespace littoral {

namespace {
using namespace parabolic;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t grain = 1024;  // elements per piece of a parallel loop

/// One run of the interior-point method.
///
/// s = A x + b in the cones, and z with c + A^T z = 0; s^T z is then the duality gap. Newton's
/// equations, with the fraction `keep` of the residuals to be removed:
///   A dx - ds = keep r_p,  A^T dz = -keep r_d,  lambda o (W dz + W^{-1} ds) = target.
template <int K, int D>
class Run {
 public:
  using Program = ParabolicProgram<K, D>;
  using Matrix = ElementMatrix<K>;
  using Local = typename Matrix::Local;
  using Inserter = typename ParabolicSolver<K, D>::Inserter;

  Run(const Matrix& matrix, const Program& program, const VecX& x0, const ParabolicOptions& options,
      const Task& task)
      : matrix_(matrix),
        c_(program.c),
        options_(options),
        task_(task),
        x_(x0),
        local_(matrix.n_elements()),
        local_normal_(matrix.n_elements()) {
    const double size = x0.cwiseAbs().maxCoeff();
    // A large first mu: 30 times the mean of s^T z that the objective, about `size`, suggests.
    mu_ = 30 * size * std::max(c_.sum(), 1e-300) /
          static_cast<double>(program.samples.size() + program.caps.size());
    for (const auto& sample : program.samples) samples_.block.emplace_back(sample);
    for (const auto& cap : program.caps)
      caps_.block.push_back({cap, std::max(cap.bound, 1e-3 * size)});
    start(samples_);
    start(caps_);
  }

  ParabolicResult run(const Inserter& insert) {
    ParabolicResult best;
    double best_merit = infinity, insert_below = 0.01;
    int rounds = 0;
    bool inside = true;
    for (int iteration = 0;; ++iteration) {
      inside = inside && refresh();
      ParabolicResult now = measure();
      now.iterations = iteration;
      const double merit = std::max(now.gap, now.primal_residual);
      // Gaps fall by about a constant factor per iteration, from 1e2 on.
      task_.checkpoint(std::log(1e2 / merit) / std::log(1e2 / options_.tolerance));
      // Round-off leaves a dual residual of some 1e-6 where the solution is not unique.
      const bool done = inside && gap_ < options_.tolerance * std::abs(now.objective) &&
                        now.primal_residual < options_.tolerance &&
                        now.gap < 10 * options_.tolerance;
      if (inside && (merit < best_merit || done))
        std::tie(best, best_merit) = std::pair(now, merit);
      if (insert && inside && rounds < 8 && (merit < insert_below || done)) {
        insert_below = insert_below > 1e-3 ? 1e-4 : 0;
        ++rounds;
        if (insert_samples(insert(x_))) {
          best_merit = infinity;
          --iteration;
          continue;
        }
      }
      best.converged = done;
      if (done || !inside || iteration >= options_.max_iterations || merit > 1e6 * best_merit)
        break;
      if (!step()) break;
    }
    best.samples = samples_.block.size();
    return best;
  }

 private:
  static constexpr int correctors = 2;  // at most, beyond Mehrotra's
  static constexpr double to_boundary = 0.99;

  // ---- loops over elements; contributions are kept per element and added up in order

  /// Calls f(element, blocks, i, partial) for each block, where F may change the block's state,
  /// with a partial result per piece, combined in order.
  template <class Partial, class F, class Combine>
  Partial for_blocks(const Partial& zero, F&& f, Combine&& combine) {
    std::vector<Partial> partial((local_.size() + grain - 1) / grain, zero);
    parallel_for(local_.size(), grain, [&](std::size_t begin, std::size_t end) {
      Partial& p = partial[begin / grain];
      for (std::size_t e = begin; e < end; ++e) {
        for (int i = samples_.first[e]; i < samples_.first[e + 1]; ++i)
          f(e, samples_.block[i], samples_.state[i], p);
        for (int i = caps_.first[e]; i < caps_.first[e + 1]; ++i)
          f(e, caps_.block[i], caps_.state[i], p);
      }
    });
    Partial total = zero;
    for (const Partial& p : partial) combine(total, p);
    return total;
  }
  void gather(const VecX& x) {
    parallel_for(local_.size(), 4 * grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) local_[e] = matrix_.gather(x, static_cast<int>(e));
    });
  }

  template <class B>
  void start(Blocks<B>& blocks) {
    std::stable_sort(blocks.block.begin(), blocks.block.end(),
                     [](const B& a, const B& b) { return a.element() < b.element(); });
    blocks.state.resize(blocks.block.size());
    blocks.index(matrix_.n_elements());
    for (std::size_t i = 0; i < blocks.block.size(); ++i)
      centre(blocks.block[i], blocks.state[i], blocks.block[i].size());
  }
  /// s = A x + b pushed inside the cone, z = mu s^{-1}.
  template <class B, class State>
  void centre(const B& b, State& state, double least) {
    const Vec<B::N> value = b.apply(matrix_.gather(x_, b.element())) + b.offset();
    state.s = pushed_inside<B::N>(value, least);
    state.z = b.rank() * mu_ * lorentz::inverse<B::N>(state.s);
  }

  /// Adds samples. Where x violates them, (1 - theta) x does not: that adds theta |G x|^2 / 4 to
  /// all slacks, to first order. So x shrinks by the least theta that will do and a bit, slacks are
  /// taken there, and multipliers that have become too small for them grow.
  bool insert_samples(const std::vector<typename Program::Sample>& inserted) {
    if (inserted.empty()) return false;
    double theta = 0;
    Blocks<SampleBlock<K, D>> grown;
    std::size_t next = 0;
    for (int e = 0; e < matrix_.n_elements(); ++e) {
      for (int i = samples_.first[e]; i < samples_.first[e + 1]; ++i) {
        grown.block.push_back(samples_.block[i]);
        grown.state.push_back(samples_.state[i]);
      }
      for (; next < inserted.size() && inserted[next].element == e; ++next) {
        const auto& sample = inserted[next];
        const Local x = matrix_.gather(x_, e);
        double gained = 0;
        for (const Local& g : sample.g) gained += 0.25 * std::pow(g.dot(x), 2);
        theta = std::max(theta, 1.5 * (gained - sample.q.dot(x)) / gained);
        grown.block.emplace_back(sample);
        grown.state.emplace_back();
        grown.state.back().z.setZero();
      }
    }
    grown.index(matrix_.n_elements());
    samples_ = std::move(grown);
    shrink(std::clamp(theta, 0.0, 0.01));
    return true;
  }
  void shrink(double theta) {
    x_ *= 1 - theta;
    const auto slack = [this](std::size_t e, const auto& b) {
      return (b.apply(matrix_.gather(x_, static_cast<int>(e))) + b.offset()).eval();
    };
    double gap = 0;
    const auto each = [&](auto& blocks, auto&& visit) {
      for (std::size_t i = 0; i < blocks.block.size(); ++i) visit(blocks.block[i], blocks.state[i]);
    };
    const auto take = [&](const auto& b, auto& state) {
      constexpr int N = std::decay_t<decltype(state.s)>::RowsAtCompileTime;
      state.s =
          pushed_inside<N>(slack(static_cast<std::size_t>(b.element()), b), 0.1 * theta * b.size());
      gap += state.s.dot(state.z);
    };
    each(samples_, take);
    each(caps_, take);
    mu_ = gap / (samples_.rank() + caps_.rank());
    const auto raise = [&](const auto& b, auto& state) {
      constexpr int N = std::decay_t<decltype(state.s)>::RowsAtCompileTime;
      if (state.s.dot(state.z) < 0.1 * b.rank() * mu_)
        state.z = 0.1 * b.rank() * mu_ * lorentz::inverse<N>(state.s);
    };
    each(samples_, raise);
    each(caps_, raise);
  }

  // ---- one iteration

  /// Residuals, scalings and the normal matrix at the current point; false if it left the cones.
  bool refresh() {
    const VecX& x = x_;
    using Sums = std::array<double, 3>;  // s^T z, largest primal residual, 1 if outside
    std::fill(local_.begin(), local_.end(), Local::Zero());
    std::fill(local_normal_.begin(), local_normal_.end(), Matrix::Block::Zero());
    const Sums sums = for_blocks(
        Sums{0, 0, 0},
        [&](std::size_t e, const auto& b, auto& state, Sums& p) {
          state.residual = state.s - b.apply(matrix_.gather(x, static_cast<int>(e))) - b.offset();
          p[0] += state.s.dot(state.z);
          p[1] = std::max(p[1], state.residual.cwiseAbs().maxCoeff() / b.size());
          b.add_adjoint(state.z, local_[e]);
          if (state.W.set(state.s, state.z, state.lambda))
            b.add_normal(state.W, local_normal_[e]);
          else
            p[2] = 1;
        },
        [](Sums& total, const Sums& p) {
          total = {total[0] + p[0], std::max(total[1], p[1]), std::max(total[2], p[2])};
        });
    dual_residual_ = c_ + matrix_.sum(local_);
    gap_ = sums[0];
    mu_ = gap_ / (samples_.rank() + caps_.rank());
    primal_residual_ = sums[1];
    return sums[2] == 0 && std::isfinite(gap_);
  }
  ParabolicResult measure() const {
    ParabolicResult now;
    now.x = x_;
    now.objective = c_.dot(x_);
    now.gap = std::max(gap_, std::abs(dual_residual_.dot(x_))) /
              std::max(std::abs(now.objective), 1e-300);
    now.primal_residual = primal_residual_;
    return now;
  }

  /// False if no further progress is possible.
  bool step() {
    if (!factorize()) return false;
    // Predictor: straight to the boundary.
    direction(1, [](const auto& state, const auto&, auto& next) { next.sum = -state.lambda.x; });
    auto [primal, dual] = accept();
    const auto& g = affine_;
    const double p = std::min(1.0, new_steps_[0]), d = std::min(1.0, new_steps_[1]);
    const double affine = (g[0] + p * g[1] + d * g[2] + p * d * g[3]) / gap_;
    const double sigma = std::clamp(std::pow(std::max(affine, 0.0), 3), 1e-8, 1.0);
    const double aim = sigma * mu_, keep = 1 - sigma;
    // Mehrotra's corrector.
    direction(keep, [aim](const auto& state, const auto& last, auto& next) {
      constexpr int N = std::decay_t<decltype(state.s)>::RowsAtCompileTime;
      next.target = -lorentz::product<N>(state.lambda.x, state.lambda.x) -
                    lorentz::product<N>(last.ds, last.dz);
      next.target[0] += aim;
      next.sum = state.lambda.divide(next.target);
    });
    std::tie(primal, dual) = accept();
    for (int k = 0; k < correctors && std::min(primal, dual) < 0.95; ++k)
      if (!gondzio(keep, std::max(aim, 1e-4 * mu_), primal, dual)) break;
    x_ += primal * dx_;
    for_blocks(
        0,
        [a = primal, b = dual, k = taken_](std::size_t, const auto&, auto& state, int&) {
          state.s += a * state.W.apply(state.direction[k].ds);
          state.z += b * state.W.apply_inverse(state.direction[k].dz);
        },
        [](int&, int) {});
    return std::max(primal, dual) > 1e-6;
  }

  bool factorize() {
    auto normal = std::make_shared<SpMat>(matrix_.sum(local_normal_));
    double lift = 0;
    for (int attempt = 0; attempt < 4; ++attempt) {
      try {
        factor_.emplace(*normal, matrix_.structure(), task_);
        normal_ = normal;
        return true;
      } catch (const SolveError&) {  // not positive definite to working precision
      }
      const double next = lift == 0 ? 1e-13 : 100 * lift;
      normal = std::make_shared<SpMat>(*normal);
      for (int j = 0; j < normal->cols(); ++j)
        normal->valuePtr()[normal->outerIndexPtr()[j]] *= (1 + next) / (1 + lift);
      lift = next;
    }
    return false;
  }

  /// Solves for the direction with ds + dz = sum: K dx = keep r_d + A^T W^{-1} (sum + keep W^{-1}
  /// r_p). q(state, direction taken, next) sets next.sum. The direction is on trial: in new_dx_ and
  /// in each block's other direction, the steps it allows in new_steps_.
  template <class Q>
  void direction(double keep, Q&& q) {
    std::fill(local_.begin(), local_.end(), Local::Zero());
    for_blocks(
        0,
        [&](std::size_t e, const auto& b, auto& state, int&) {
          auto& next = state.direction[1 - taken_];
          q(state, state.direction[taken_], next);
          b.add_adjoint(
              state.W.apply_inverse(next.sum + state.W.apply_inverse(keep * state.residual)),
              local_[e]);
        },
        [](int&, int) {});
    solve(keep * dual_residual_ + matrix_.sum(local_));
    using Sums = std::array<double, 6>;
    gather(new_dx_);
    const Sums sums = for_blocks(
        Sums{},
        [&](std::size_t e, const auto& b, auto& state, Sums& p) {
          auto& next = state.direction[1 - taken_];
          next.dz = next.sum + state.W.apply_inverse(keep * state.residual - b.apply(local_[e]));
          next.ds = next.sum - next.dz;
          p[0] = std::max(p[0], state.lambda.inverse_step(next.ds));
          p[1] = std::max(p[1], state.lambda.inverse_step(next.dz));
          p[2] += state.lambda.x.squaredNorm();
          p[3] += state.lambda.x.dot(next.ds);
          p[4] += state.lambda.x.dot(next.dz);
          p[5] += next.ds.dot(next.dz);
        },
        [](Sums& total, const Sums& p) {
          for (int k = 0; k < 2; ++k) total[k] = std::max(total[k], p[k]);
          for (int k = 2; k < 6; ++k) total[k] += p[k];
        });
    new_steps_ = {1 / sums[0], 1 / sums[1]};
    affine_ = {sums[2], sums[3], sums[4], sums[5]};
  }
  void solve(const VecX& rhs) {
    // What is left of this equation becomes dual residual, so it is compared with c.
    new_dx_ = factor_->solve(rhs);
    double last = infinity;
    for (int k = 0; k < 5; ++k) {
      task_.checkpoint();
      const VecX residual = rhs - normal_->selfadjointView<Eigen::Lower>() * new_dx_;
      const double size = residual.norm();
      if (size <= 1e-2 * options_.tolerance * c_.norm() || size > 0.5 * last) break;
      last = size;
      new_dx_ += factor_->solve(residual);
    }
  }
  std::pair<double, double> trial_steps() const {
    return {std::min(1.0, to_boundary * new_steps_[0]), std::min(1.0, to_boundary * new_steps_[1])};
  }
  std::pair<double, double> accept() {
    taken_ = 1 - taken_;
    dx_.swap(new_dx_);
    return trial_steps();
  }

  /// Gondzio's corrector: longer steps, outlying products of the point they lead to moved back into
  /// [0.1, 10] times the aim. False, changing nothing, if the steps do not grow.
  bool gondzio(double keep, double aim, double& primal, double& dual) {
    const double p = std::min(1.0, 1.2 * primal + 0.1), d = std::min(1.0, 1.2 * dual + 0.1);
    const double low = 0.1 * aim, high = 10 * aim;
    const auto missing = [low, high](double v) {
      return std::max(v < low ? low - v : v > high ? high - v : 0.0, -high);
    };
    direction(keep, [&](const auto& state, const auto& last, auto& next) {
      constexpr int N = std::decay_t<decltype(state.s)>::RowsAtCompileTime;
      const Vec<N> v =
          lorentz::product<N>(state.lambda.x + p * last.ds, state.lambda.x + d * last.dz);
      next.target = last.target + lorentz::spectral<N>(v, missing);
      next.sum = state.lambda.divide(next.target);
    });
    const auto [new_primal, new_dual] = trial_steps();
    if (new_primal + new_dual < primal + dual + 0.02) return false;
    std::tie(primal, dual) = accept();
    return true;
  }

  const Matrix& matrix_;
  const VecX c_;
  const ParabolicOptions options_;
  const Task& task_;
  std::optional<Cholesky<double>> factor_;
  std::shared_ptr<const SpMat> normal_;
  VecX x_, dx_, new_dx_, dual_residual_;
  std::array<double, 2> new_steps_{};
  std::array<double, 4> affine_{};  // (lambda + p ds).(lambda + d dz) = g0 + p g1 + d g2 + p d g3
  int taken_ = 0;                   // which of the blocks' directions is not on trial
  double mu_ = 0, gap_ = 0, primal_residual_ = 0;
  Blocks<SampleBlock<K, D>> samples_;
  Blocks<CapBlock<K, D>> caps_;
  std::vector<Local> local_;
  std::vector<typename Matrix::Block> local_normal_;
};

}  // namespace

template <int K, int D>
ParabolicSolver<K, D>::ParabolicSolver(int n, std::vector<std::array<int, K>> elements,
                                       const Task& task)
    : matrix_(std::make_shared<const ElementMatrix<K>>(n, std::move(elements), task)) {}

template <int K, int D>
ParabolicResult ParabolicSolver<K, D>::solve(const Program& program, const VecX& x0,
                                             const ParabolicOptions& options,
                                             const Inserter& insert, const Task& task) const {
  return Run<K, D>(*matrix_, program, x0, options, task).run(insert);
}

template class ParabolicSolver<6, 2>;
template class ParabolicSolver<10, 3>;

}  // namespace littoral
