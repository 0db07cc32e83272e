#include "solve/network/flow_interior_point.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "base/index.h"
#include "base/platform/large_pages.h"
#include "littoral/error.h"
#include "solve/direct/cholesky.h"
#include "solve/network/spanning_tree.h"

namespace littoral {

namespace {

/// One column of the flow problem: flow x from f to g.
struct Column {
  int f, g;
};

class Method {
 public:
  explicit Method(const L1Integration& problem) : problem_(problem) {
    unit_c_ = std::max(problem.c.cwiseAbs().maxCoeff(), 1e-300);
    unit_w_ = std::max(problem.w.maxCoeff(), 1e-300);
    std::vector<double> price, most;
    const auto add = [&](Eigen::Index e, int kind, Column column, double p, double u) {
      columns_.push_back(column);
      arc_.push_back(e);
      kind_.push_back(kind);
      price.push_back(p / unit_c_);
      most.push_back(u / unit_w_);
    };
    for (Eigen::Index e = 0; e < problem.n_arcs(); ++e)
      if (problem.w[e] > 0) add(e, 0, {problem.f[e], problem.g[e]}, -problem.c[e], problem.w[e]);
    m2_ = index(columns_.size());
    for (Eigen::Index e = 0; e < problem.lo.size(); ++e) {
      const double c = problem.c[e];
      if (std::isfinite(problem.hi[e]))
        add(e, 1, {problem.f[e], problem.g[e]}, problem.hi[e] - c, 0);
      if (std::isfinite(problem.lo[e]))
        add(e, -1, {problem.g[e], problem.f[e]}, c - problem.lo[e], 0);
    }
    m_ = index(columns_.size());
    price_ = Eigen::Map<const Row>(price.data(), m_);
    u_ = Eigen::Map<const Row>(most.data(), m_);
    make_laplacian();
  }

  InteriorPoint run(double tolerance, const Task& task) {
    start(task);
    InteriorPoint best;
    int iteration = 0;
    for (; iteration < 100; ++iteration) {
      task.checkpoint(std::min(0.95, iteration / 40.0));
      measure();
      if (std::abs(gap_) < tolerance && dual_error_ < 1e-9) break;
      if (iteration > 0 && (mu_ < 1e-13 || !std::isfinite(mu_))) break;
      if (!factor(task)) break;
      step();
    }
    best.iterations = iteration;
    best.s = unit_c_ * s_;
    best.x = best.up = best.down = VecX::Zero(problem_.n_arcs());
    for (Eigen::Index k = 0; k < m_; ++k) {
      VecX& part = kind_[k] == 0 ? best.x : kind_[k] > 0 ? best.up : best.down;
      part[arc_[k]] = unit_w_ * x_[k];
    }
    return best;
  }

 private:
  using Row = Eigen::ArrayXd;  // by column; of what is called u or above, the first m2_

  /// s_f - s_g of all columns.
  Row differences(const VecX& s) const {
    Row out(m_);
    for (Eigen::Index k = 0; k < m_; ++k) out[k] = s[columns_[k].f] - s[columns_[k].g];
    return out;
  }

  /// Pattern and positions of A Theta^-1 A^T, one node of every part fixed.
  void make_laplacian() {
    std::vector<int> f, g, order(columns_.size());
    for (const Column& column : columns_) {
      f.push_back(column.f);
      g.push_back(column.g);
    }
    std::iota(order.begin(), order.end(), 0);
    const Forest forest = spanning_forest(problem_.n, f, g, order);
    held_.assign(problem_.n, 0);
    for (int u = 0; u < problem_.n; ++u) held_[u] = forest.parent_arc[u] < 0;
    Triplets entries;
    for (int u = 0; u < problem_.n; ++u) entries.emplace_back(u, u, 1);
    for (const Column& column : columns_)
      entries.emplace_back(std::max(column.f, column.g), std::min(column.f, column.g), 1);
    laplacian_ = SpMat(problem_.n, problem_.n);
    laplacian_.setFromTriplets(entries.begin(), entries.end());
    laplacian_.makeCompressed();
    place_.reserve(columns_.size());
    for (const Column& column : columns_) {
      const int row = std::max(column.f, column.g), col = std::min(column.f, column.g);
      const int* begin = laplacian_.innerIndexPtr() + laplacian_.outerIndexPtr()[col];
      const int* end = laplacian_.innerIndexPtr() + laplacian_.outerIndexPtr()[col + 1];
      place_.push_back(std::lower_bound(begin, end, row) - laplacian_.innerIndexPtr());
    }
  }

  bool factor(const Task& task) {
    auto K = std::make_shared<SpMat>(laplacian_);
    double* value = K->valuePtr();
    std::fill(value, value + K->nonZeros(), 0.0);
    const int* diagonal = K->outerIndexPtr();  // the first entry of a lower triangle's column
    for (Eigen::Index k = 0; k < m_; ++k) {
      const Column& column = columns_[k];
      const double weight = inverse_theta_[k];
      value[diagonal[column.f]] += weight;
      value[diagonal[column.g]] += weight;
      if (!held_[column.f] && !held_[column.g]) value[place_[k]] -= weight;
    }
    for (int u = 0; u < problem_.n; ++u)
      value[diagonal[u]] = std::max(value[diagonal[u]] * (1 + 1e-13), 1e-30);
    if (!structure_)
      structure_ = std::make_shared<const Elimination>(laplacian_, dissection(laplacian_, task));
    try {
      factor_.reset();  // one at a time
      factor_ = std::make_unique<Cholesky<double>>(*K, structure_, task);
    } catch (const SolveError&) {
      return false;  // round-off: the last iterate is as good as it gets
    }
    return true;
  }

  /// A q: what the columns' flow brings out of every node that is not fixed.
  VecX out_of_nodes(const Row& q) const {
    VecX out = VecX::Zero(problem_.n);
    for (Eigen::Index k = 0; k < m_; ++k) {
      out[columns_[k].f] += q[k];
      out[columns_[k].g] -= q[k];
    }
    for (int u = 0; u < problem_.n; ++u)
      if (held_[u]) out[u] = 0;
    return out;
  }

  /// x = 0, and s from least squares.
  void start(const Task& task) {
    inverse_theta_ = Row::Constant(m_, 1e-8);
    inverse_theta_.head(m2_) = u_.head(m2_);
    s_ = factor(task) ? VecX(factor_->solve(out_of_nodes(price_ * u_))) : VecX::Zero(problem_.n);
    const Row J = differences(s_) - price_;
    const double margin = std::max(J.head(m2_).abs().mean(), 1e-6);
    x_ = Row::Zero(m_);
    x_.tail(m_ - m2_) = 0.1;
    zu_ = J.head(m2_).max(0.0) + margin;
    zl_ = (-J).max(margin);
    zl_.head(m2_) = (-J.head(m2_)).max(0.0) + margin;
  }

  /// Objectives, duality measure and residuals of the current point.
  void measure() {
    const Row J = differences(s_) - price_;
    residual_ = J + zl_;
    residual_.head(m2_) -= zu_;
    dual_error_ = residual_.abs().maxCoeff();
    below_ = x_ + u_;
    above_ = (u_ - x_).head(m2_);
    inverse_below_ = 1 / below_;
    inverse_above_ = 1 / above_;
    inverse_theta_ = zl_ * inverse_below_;
    inverse_theta_.head(m2_) += zu_ * inverse_above_;
    inverse_theta_ = 1 / inverse_theta_;
    mu_ = ((below_ * zl_).sum() + (above_ * zu_).sum()) / double(m_ + m2_);
    const double primal = (u_ * J.abs()).sum(), dual = -(price_ * x_).sum();
    gap_ = (primal - dual) / std::max(primal, 1e-300);
    unbalanced_ = -out_of_nodes(x_);
  }

  struct Direction {
    VecX s;
    Row x, zl, zu;
  };

  /// Newton's direction for complementarity residuals rl (below) and ru (above).
  Direction newton(const Row& rl, const Row& ru) const {
    Row q = residual_ + rl * inverse_below_;
    q.head(m2_) -= ru * inverse_above_;
    q *= -inverse_theta_;
    Direction d;
    d.s = factor_->solve(VecX(out_of_nodes(q) + unbalanced_));
    d.x = differences(d.s) * inverse_theta_ - q;
    d.zl = (rl - zl_ * d.x) * inverse_below_;
    d.zu = (ru + zu_ * d.x.head(m2_)) * inverse_above_;
    return d;
  }

  /// Longest steps for x and for (s, z), at most 1, that keep everything nonnegative.
  std::pair<double, double> longest(const Direction& d) const {
    const double x =
        std::max((-d.x * inverse_below_).maxCoeff(), (d.x.head(m2_) * inverse_above_).maxCoeff());
    const double z = std::max((-d.zl / zl_).maxCoeff(), (-d.zu / zu_).maxCoeff());
    return {1 / std::max(x, 1.0), 1 / std::max(z, 1.0)};
  }

  void step() {
    Row rl = -below_ * zl_, ru = -above_ * zu_;
    const Direction predictor = newton(rl, ru);
    const auto [ax, az] = longest(predictor);
    const double products =
        ((below_ + ax * predictor.x) * (zl_ + az * predictor.zl)).sum() +
        ((above_ - ax * predictor.x.head(m2_)) * (zu_ + az * predictor.zu)).sum();
    const double target = mu_ * std::pow(products / double(m_ + m2_) / mu_, 3);
    rl += target - predictor.x * predictor.zl;
    ru += target + predictor.x.head(m2_) * predictor.zu;
    const Direction d = newton(rl, ru);
    const auto [x, z] = longest(d);
    const double back = std::clamp(1 - mu_, 0.9, 0.9995);
    x_ += back * x * d.x;
    s_ += back * z * d.s;
    zl_ += back * z * d.zl;
    zu_ += back * z * d.zu;
  }

  const KeepLargePages keep_pages_;  // each factor goes where the one before was
  const L1Integration& problem_;
  double unit_c_ = 1, unit_w_ = 1;
  std::vector<Column> columns_;
  std::vector<Eigen::Index> arc_;  // of each column
  std::vector<int> kind_;          // 0: |J|, 1: hi, -1: lo
  Eigen::Index m_ = 0, m2_ = 0;    // columns; the first of them, some: -u <= x <= u
  Row price_, u_;                  // per unit of flow; 0: only x >= 0, the multiplier of a bound
  std::vector<char> held_;
  SpMat laplacian_;
  std::shared_ptr<const Elimination> structure_;
  std::vector<Eigen::Index> place_;
  std::unique_ptr<Cholesky<double>> factor_;
  VecX s_, unbalanced_;
  Row x_, zl_, zu_, residual_, below_, above_, inverse_below_, inverse_above_, inverse_theta_;
  double mu_ = 0, gap_ = 1, dual_error_ = 0;
};

}  // namespace

InteriorPoint interior_point(const L1Integration& problem, double tolerance, const Task& task) {
  return Method(problem).run(tolerance, task);
}

}  // namespace littoral
