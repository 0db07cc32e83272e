#include "solve/optimization/paraboloid_program.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/index.h"
#include "solve/direct/cholesky.h"
#include "solve/optimization/paraboloid_anchor.h"
#include "solve/optimization/paraboloid_rows.h"

namespace littoral {

namespace {
using namespace paraboloid;

/// One run of the interior-point method.
///
/// s = g(x) > 0 and z > 0 with c + sum_p z_p a_p = 0, where a_p is the gradient of g_p at x; s^T z
/// is then the duality gap, for c^T x + z^T g(x) is concave in x and so nowhere larger. On the way
/// to s_p z_p = 0, the products follow mu w_p with the weights w of large elements. Newton's
/// equations, with the fraction `keep` of the residuals r = s - g(x), r_d = c + sum z a removed:
///   ds = a^T dx - keep r - bend,   z ds + s dz = target - s z,
///   sum a dz - 1/2 sum z (T G)^T (T G) dx = -keep r_d + curve,
/// where bend, curve and a part of the target are the second-order terms of the predictor. Hence
///   K dx = keep r_d + sum a (target - s z + z (keep r + bend)) / s - curve,
///   K = sum (z / s) a a^T + 1/2 z (T G)^T (T G),
/// positive definite on the fixed stencil of the elements.
template <int K, int D>
class Run {
 public:
  using Program = ParaboloidProgram<K, D>;
  using Matrix = ElementMatrix<K>;
  using Local = typename Matrix::Local;
  using Inserter = typename ParaboloidSolver<K, D>::Inserter;
  using At = RowAt<K, D>;
  using Row = paraboloid::Row<D>;
  using Small = typename At::Small;

  Run(const Matrix& matrix, const Program& program, const VecX& x0,
      const ParaboloidOptions& options, const Task& task)
      : matrix_(matrix),
        program_(program),
        options_(options),
        task_(task),
        weight_(program.weight),
        rows_(program, 1e-3 * x0.cwiseAbs().maxCoeff()),
        normal_(matrix.pattern(), matrix.structure()),
        x_(x0),
        local_(program.transform.size()),
        local_scaled_(program.transform.size()),
        local_normal_(program.transform.size()) {
    const int n = matrix_.n_elements();
    double mean = 0;
    for (int e = 0; e < n; ++e)
      for (int i = rows_.first[e]; i < rows_.first[e + 1]; ++i) mean += weight_[e];
    mean /= static_cast<double>(rows_.row.size());
    for (double& w : weight_) w = std::max(w / mean, 1.0);
    for (int e = 0; e < n; ++e)
      for (int i = rows_.first[e]; i < rows_.first[e + 1]; ++i) total_weight_ += weight_[e];
    // A large first mu: 300 times the mean of s z that the objective, about `size`, suggests.
    mu_ = 300 * x0.cwiseAbs().maxCoeff() * std::max(program.c.sum(), 1e-300) / total_weight_;
    each_element(local_.size(), [&](int e) {
      const Local x = matrix_.gather(x_, e);
      for_rows(e, [&](Row& r, RowOrigin& origin) {
        const double g = at(e, r).value(bound(r), x);
        r.s = std::max(g, 0.1 * origin.size);
        r.z = mu_ * weight_[e] / r.s;
        r.exact = r.s == g;
      });
    });
  }

  ParaboloidResult run(const Inserter& insert) {
    ParaboloidResult best{.x = x_};
    double best_merit = infinity;
    int rounds = 0;
    double next_stage = first_stage;  // of looking for dips early
    bool inside = set_up();
    for (int iteration = 0; inside; ++iteration) {
      ParaboloidResult now = measure();
      now.iterations = iteration;
      const double merit = std::max({now.gap, now.dual_residual, now.primal_residual});
      // Gaps fall by about a constant factor per iteration, from 1e2 on.
      task_.checkpoint(std::log(1e2 / merit) / std::log(1e2 / options_.tolerance));
      // Round-off leaves a dual residual of some 1e-6 where the solution is not unique.
      now.converged = now.gap < options_.tolerance && now.primal_residual < options_.tolerance &&
                      now.dual_residual < 10 * options_.tolerance;
      if (merit < best_merit || now.converged) std::tie(best, best_merit) = std::pair(now, merit);
      // Most dips show early, when there is room for what they ask for; the last that show are put
      // in where there was still room for them.
      const double left = std::max(now.gap, now.dual_residual);
      const bool early = !now.converged && left < next_stage;
      while (next_stage > left) next_stage *= 0.3;
      if (next_stage < last_stage) next_stage = 0;
      if (insert && rounds < most_rounds && (early || now.converged)) {
        auto found = insert(x_, early ? 0.1 : 1);
        if (!early && !found.empty()) found = insert(x_, 0.1);
        if (!early) ++rounds;
        if (early || !anchor_.is_set()) anchor_.set(x_, mu_, rows_);
        if (!found.empty()) {
          anchor_.insert(found, program_, matrix_, weight_, rows_, x_);
          for (const auto& sample : found) total_weight_ += weight_[sample.element];
          inside = set_up();
          best_merit = infinity;
          best.converged = false;
          --iteration;
          continue;
        }
      }
      if (insert && now.converged && rounds == most_rounds) best.missing = insert(x_, 1).size();
      if (best.missing > 0) best.converged = false;
      if (now.converged || iteration >= options_.max_iterations || merit > 1e6 * best_merit) break;
      inside = step();
    }
    best.samples = rows_.row.size() - program_.caps.size();
    return best;
  }

 private:
  static constexpr int most_rounds = 8, correctors = 4;  // of insertion in the end; of Gondzio's
  static constexpr double first_stage = 0.3, last_stage = 5e-3;  // gaps

  At at(int element, const Row& r) const { return rows_.at(r, program_.transform[element]); }
  double bound(const Row& r) const { return rows_.bound_of(r); }

  // ---- loops over elements; contributions are kept per element and added up in order

  template <class F>
  void for_rows(int element, F&& f) {
    rows_.each(element, std::forward<F>(f));
  }

  // ---- one iteration

  struct Sums {
    double gap = 0, primal = 0;
    bool outside = false;

    static void combine(Sums& total, const Sums& p) {
      total.gap += p.gap;
      total.primal = std::max(total.primal, p.primal);
      total.outside = total.outside || p.outside;
    }
  };

  /// Residuals, the normal matrix and the predictor's right-hand side; false if outside.
  bool set_up() {
    return add_up(for_elements<Sums>(
        local_.size(),
        [&](int e, Sums& sum) {
          const Local x = matrix_.gather(x_, e);
          set_up_rows(e, x, sum, [&](Row& r, const At& p) { r.y = p.slopes(x); });
        },
        Sums::combine));
  }
  /// An element's part; f(row, its functions) is to leave the slopes of x in the row.
  template <class F>
  void set_up_rows(int e, const Local& x, Sums& sum, F&& f) {
    Eigen::Matrix<double, K, K> N = Eigen::Matrix<double, K, K>::Zero();
    Local dual = Local::Zero(), right = Local::Zero();
    for_rows(e, [&](Row& r, const RowOrigin& origin) {
      const At p = at(e, r);
      f(r, p);
      const double residual = r.exact ? 0 : r.s - p.value(bound(r), x, r.y);
      sum.gap += r.s * r.z;
      if (!r.exact) sum.primal = std::max(sum.primal, std::abs(residual) / origin.size);
      sum.outside = sum.outside || !(r.s > 0 && r.z > 0);
      Local a = Local::Zero();
      p.add_gradient(1, r.y, a);
      dual += r.z * a;
      right += (r.z * residual / r.s) * a;
      add_square(r.z / r.s, a, N);
      for (int d = 0; d < D; ++d) add_square(0.5 * r.z, p.slope_row(d), N);
    });
    local_[e] = dual;
    local_scaled_[e] = right;
    int k = 0;
    for (int i = 0; i < K; ++i)
      for (int j = i; j < K; ++j) local_normal_[e][k++] = N(i, j);
  }
  bool add_up(const Sums& sums) {
    dual_residual_ = program_.c + matrix_.sum(local_);
    predictor_ = program_.c + matrix_.sum(local_scaled_);
    gap_ = sums.gap;
    mu_ = gap_ / total_weight_;
    primal_residual_ = sums.primal;
    return !sums.outside && std::isfinite(gap_) && dual_residual_.allFinite();
  }
  ParaboloidResult measure() const {
    ParaboloidResult now{.x = x_};
    now.objective = program_.c.dot(x_);
    const double size = std::max(std::abs(now.objective), 1e-300);
    now.gap = gap_ / size;
    now.dual_residual = std::abs(dual_residual_.dot(x_)) / size;
    now.primal_residual = primal_residual_;
    return now;
  }

  /// To the next point, with Newton's equations there; false if no further progress is possible.
  bool step() {
    matrix_.sum(local_normal_, normal_.values());
    if (!normal_.factor(task_)) return false;
    double sigma = predict();
    Steps steps = correct(sigma, 1);
    if (steps.least() < 0.1) {
      sigma = std::max(sigma, 0.5);
      steps = correct(sigma, 0);
    }
    bool changed = false;
    for (int k = 0; k < correctors && steps.least() < 0.9; ++k) {
      changed = recentre(sigma, steps);
      if (!changed) break;
    }
    return advance(removed(sigma), changed, steps) && steps.greatest() > 1e-6;
  }

  /// Along the direction; changed: with the changes of the targets that were tried last.
  bool advance(double keep, bool changed, const Steps& steps) {
    const double primal = steps.primal(), dual = steps.dual();
    const VecX next = x_ + primal * dx_;
    const Sums sums = for_elements<Sums>(
        local_.size(),
        [&](int e, Sums& sum) {
          const Local x = matrix_.gather(next, e), dx = matrix_.gather(dx_, e);
          set_up_rows(e, x, sum, [&](Row& r, const At& p) {
            const RowStep now =
                row_step(e, r, p, dx, changed ? r.target + r.change : r.target, keep);
            r.y = p.slopes(x);
            const double g = p.value(bound(r), x, r.y), s = r.s + primal * now.ds;
            r.exact = g > (r.exact ? 1e-3 * r.s : 0.1 * s);
            r.s = r.exact ? g : std::max(s, 1e-3 * r.s);
            r.z += dual * now.dz;
          });
        },
        Sums::combine);
    x_ = next;
    return add_up(sums);
  }

  /// What is left of an equation becomes dual residual, so it is compared with c and with that.
  void solve(const VecX& rhs) {
    const double allowed =
        1e-2 * std::max(options_.tolerance * program_.c.norm(), dual_residual_.norm());
    dx_ = normal_.solve(rhs, allowed, task_);
  }

  /// Straight to the boundary, target 0. Leaves the second-order terms in the rows, and in
  /// `second_` and `centre_` what they and centring add to a right-hand side; sigma.
  double predict() {
    solve(predictor_);
    const Steps steps = for_elements<Steps>(
        local_.size(),
        [&](int e, Steps& limits) {
          const Local dx = matrix_.gather(dx_, e);
          Local second = Local::Zero(), centre = Local::Zero();
          for_rows(e, [&](Row& r) {
            const At p = at(e, r);
            const Small dy = p.slopes(dx);
            RowStep now{p.slope(r.y, dx, dy), 0.25 * dy.squaredNorm()};
            now.ds = now.b - residual(e, r, p);
            now.dz = -r.z - r.z * now.ds / r.s;
            limits.add(r, now);
            const double cross = std::clamp(now.ds * now.dz, -10 * r.s * r.z, 10 * r.s * r.z);
            r.bend = now.bend;
            r.target = cross;
            const double of_a = (r.z * r.bend - cross) / r.s;
            p.add(of_a, (-0.5 * of_a) * r.y - (0.5 * now.dz) * dy, second);
            p.add_gradient(mu_ * weight_[e] / r.s, r.y, centre);
          });
          local_[e] = second;
          local_scaled_[e] = centre;
        },
        Steps::combine);
    const double p = std::min(1.0, steps.to_primal), d = std::min(1.0, steps.to_dual);
    second_ = matrix_.sum(local_);
    centre_ = matrix_.sum(local_scaled_);
    const double left = (gap_ + p * steps.ds_z + d * steps.s_dz + p * d * steps.ds_dz) / gap_;
    return std::clamp(std::pow(std::max(left, 0.0), 3), 1e-8, 0.8);
  }

  /// Residuals go faster than the gap, or steps get short while they are the larger part of what is
  /// left.
  static double removed(double sigma) { return std::max(1 - sigma, 0.8); }

  /// Mehrotra's corrector, target sigma mu w - s z - second (ds dz of the predictor); its steps.
  Steps correct(double sigma, double second) {
    right_ = predictor_ + second * second_ + sigma * centre_ -
             (1 - removed(sigma)) * (dual_residual_ + predictor_ - program_.c);
    solve(right_);
    return direction(removed(sigma), [&](int e, Row& r) {
      r.target = sigma * mu_ * weight_[e] - second * r.target;
      r.bend *= second;
      r.change = 0;
    });
  }
  /// How far the rows go with dx, each after f(element, row).
  template <class F>
  Steps direction(double keep, F&& f) {
    return for_elements<Steps>(
        local_.size(),
        [&](int e, Steps& limits) {
          const Local dx = matrix_.gather(dx_, e);
          for_rows(e, [&](Row& r) {
            f(e, r);
            limits.add(r, row_step(e, r, at(e, r), dx, r.target + r.change, keep));
          });
        },
        Steps::combine);
  }
  RowStep row_step(int e, const Row& r, const At& p, const Local& dx, double target,
                   double keep) const {
    const Small dy = p.slopes(dx);
    RowStep now{p.slope(r.y, dx, dy), 0.25 * dy.squaredNorm()};
    now.ds = now.b - keep * residual(e, r, p) - r.bend;
    now.dz = (target - r.z * now.ds) / r.s - r.z;
    return now;
  }
  /// s - g(x) where Newton's equations were set up.
  double residual(int e, const Row& r, const At& p) const {
    return r.exact ? 0 : r.s - p.value(bound(r), matrix_.gather(x_, e), r.y);
  }
  /// Gondzio's corrector: products that longer steps would lead away from the aim are brought back
  /// into [0.1, 10] times it. False if the steps do not grow: then dx and the targets, without the
  /// changes left in the rows, are as before.
  bool recentre(double sigma, Steps& steps) {
    const double p = std::min(1.0, 1.2 * steps.primal() + 0.1);
    const double d = std::min(1.0, 1.2 * steps.dual() + 0.1);
    const double aim = std::max(sigma, 1e-4) * mu_, keep = removed(sigma);
    each_element(local_.size(), [&](int e) {
      const Local dx = matrix_.gather(dx_, e);
      const double low = 0.1 * aim * weight_[e], high = 10 * aim * weight_[e];
      Local right = Local::Zero();
      for_rows(e, [&](Row& r) {
        const At a = at(e, r);
        r.target += r.change;
        const RowStep now = row_step(e, r, a, dx, r.target, keep);
        const double ds = r.exact ? now.b - p * now.bend : now.ds;
        const double v = (r.s + p * ds) * (r.z + d * now.dz);
        r.change = v < low ? low - v : v > high ? std::max(high - v, -high) : 0;
        if (r.change != 0) a.add_gradient(r.change / r.s, r.y, right);
      });
      local_[e] = right;
    });
    VecX before = dx_;
    VecX right = right_ + matrix_.sum(local_);
    solve(right);
    const Steps now = direction(keep, [](int, const Row&) {});
    if (now.sum() > steps.sum() + 0.02) {
      right_.swap(right);
      steps = now;
      return true;
    }
    dx_.swap(before);
    return false;
  }

  const Matrix& matrix_;
  const Program& program_;
  const ParaboloidOptions options_;
  const Task& task_;
  std::vector<double> weight_;  // elements; over their mean over the rows, at least 1
  double total_weight_ = 0;     // rows
  ParaboloidRows<K, D> rows_;
  RefinedCholesky normal_;
  VecX x_, dx_, dual_residual_, predictor_, second_, centre_, right_;
  double mu_ = 0, gap_ = 0, primal_residual_ = 0;
  Anchor<K, D> anchor_;
  std::vector<Local> local_, local_scaled_;
  std::vector<typename Matrix::Block> local_normal_;
};

}  // namespace

template <int K, int D>
ParaboloidSolver<K, D>::ParaboloidSolver(int n, std::vector<std::array<int, K>> elements,
                                         const Task& task)
    : matrix_(std::make_shared<const ElementMatrix<K>>(n, std::move(elements), task)) {}

template <int K, int D>
ParaboloidResult ParaboloidSolver<K, D>::solve(const Program& program, const VecX& x0,
                                               const ParaboloidOptions& options,
                                               const Inserter& insert, const Task& task) const {
  return Run<K, D>(*matrix_, program, x0, options, task).run(insert);
}

template class ParaboloidSolver<6, 2>;
template class ParaboloidSolver<10, 3>;

}  // namespace littoral
