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

/// One column of the flow problem: flow x from f to g at a price per unit, -u <= x <= u, or, for
/// the multiplier of a bound, x >= 0.
struct Column {
  int f, g;
  double price;
  double u;  // 0: only x >= 0
};

class Method {
 public:
  explicit Method(const L1Integration& problem) : problem_(problem) {
    unit_c_ = std::max(problem.c.cwiseAbs().maxCoeff(), 1e-300);
    unit_w_ = std::max(problem.w.maxCoeff(), 1e-300);
    for (Eigen::Index e = 0; e < problem.n_arcs(); ++e)
      if (problem.w[e] > 0)
        add(e, 0, {problem.f[e], problem.g[e], -problem.c[e] / unit_c_, problem.w[e] / unit_w_});
    for (Eigen::Index e = 0; e < problem.lo.size(); ++e) {
      const double c = problem.c[e];
      if (std::isfinite(problem.hi[e]))
        add(e, 1, {problem.f[e], problem.g[e], (problem.hi[e] - c) / unit_c_, 0});
      if (std::isfinite(problem.lo[e]))
        add(e, -1, {problem.g[e], problem.f[e], (c - problem.lo[e]) / unit_c_, 0});
    }
    make_laplacian();
    m_ = index(columns_.size());
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
  void add(Eigen::Index e, int kind, const Column& column) {
    columns_.push_back(column);
    arc_.push_back(e);
    kind_.push_back(kind);
  }
  bool symmetric(Eigen::Index k) const { return columns_[k].u > 0; }
  double difference(const VecX& s, Eigen::Index k) const {
    return s[columns_[k].f] - s[columns_[k].g];
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
      const double weight = 1 / theta_[k];
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
  VecX out_of_nodes(const VecX& q) const {
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
    theta_.resize(m_);
    VecX q(m_);
    for (Eigen::Index k = 0; k < m_; ++k) {
      theta_[k] = symmetric(k) ? 1 / columns_[k].u : 1e8;
      q[k] = symmetric(k) ? columns_[k].price * columns_[k].u : 0;
    }
    s_ = factor(task) ? VecX(factor_->solve(out_of_nodes(q))) : VecX::Zero(problem_.n);
    double typical = 0;
    Eigen::Index count = 0;
    for (Eigen::Index k = 0; k < m_; ++k)
      if (symmetric(k)) {
        typical += std::abs(difference(s_, k) - columns_[k].price);
        ++count;
      }
    const double margin = std::max(typical / std::max<Eigen::Index>(count, 1), 1e-6);
    x_ = VecX::Zero(m_);
    zl_ = zu_ = VecX::Zero(m_);
    for (Eigen::Index k = 0; k < m_; ++k) {
      const double J = difference(s_, k) - columns_[k].price;
      if (symmetric(k)) {
        zu_[k] = std::max(J, 0.0) + margin;
        zl_[k] = std::max(-J, 0.0) + margin;
      } else {
        zl_[k] = std::max(-J, margin);
        x_[k] = 0.1;
      }
    }
  }

  double room_below(Eigen::Index k) const { return x_[k] + columns_[k].u; }
  double room_above(Eigen::Index k) const { return columns_[k].u - x_[k]; }

  /// Objectives, duality measure and residuals of the current point.
  void measure() {
    residual_.resize(m_);
    double products = 0, primal = 0, dual = 0;
    Eigen::Index count = 0;
    dual_error_ = 0;
    for (Eigen::Index k = 0; k < m_; ++k) {
      const double J = difference(s_, k) - columns_[k].price;
      residual_[k] = J + zl_[k] - zu_[k];
      dual_error_ = std::max(dual_error_, std::abs(residual_[k]));
      dual -= columns_[k].price * x_[k];
      products += room_below(k) * zl_[k];
      theta_[k] = zl_[k] / room_below(k);
      ++count;
      if (!symmetric(k)) continue;
      products += room_above(k) * zu_[k];
      theta_[k] += zu_[k] / room_above(k);
      ++count;
      primal += columns_[k].u * std::abs(J);
    }
    mu_ = products / static_cast<double>(count);
    gap_ = (primal - dual) / std::max(primal, 1e-300);
    unbalanced_ = -out_of_nodes(x_);
  }

  struct Direction {
    VecX s, x, zl, zu;
  };

  /// Newton's direction for complementarity residuals rl (below) and ru (above).
  Direction newton(const VecX& rl, const VecX& ru) const {
    VecX q(m_);
    for (Eigen::Index k = 0; k < m_; ++k) {
      const double above = symmetric(k) ? ru[k] / room_above(k) : 0;
      q[k] = -(residual_[k] + rl[k] / room_below(k) - above) / theta_[k];
    }
    Direction d{factor_->solve(VecX(out_of_nodes(q) + unbalanced_)), VecX(m_), VecX(m_),
                VecX::Zero(m_)};
    for (Eigen::Index k = 0; k < m_; ++k) {
      d.x[k] = difference(d.s, k) / theta_[k] - q[k];
      d.zl[k] = (rl[k] - zl_[k] * d.x[k]) / room_below(k);
      if (symmetric(k)) d.zu[k] = (ru[k] + zu_[k] * d.x[k]) / room_above(k);
    }
    return d;
  }

  /// Longest steps for x and for (s, z) that keep everything nonnegative.
  std::pair<double, double> longest(const Direction& d) const {
    double x = 1, z = 1;
    for (Eigen::Index k = 0; k < m_; ++k) {
      if (d.x[k] < 0) x = std::min(x, -room_below(k) / d.x[k]);
      if (d.zl[k] < 0) z = std::min(z, -zl_[k] / d.zl[k]);
      if (!symmetric(k)) continue;
      if (d.x[k] > 0) x = std::min(x, room_above(k) / d.x[k]);
      if (d.zu[k] < 0) z = std::min(z, -zu_[k] / d.zu[k]);
    }
    return {x, z};
  }

  void step() {
    VecX rl(m_), ru = VecX::Zero(m_);
    for (Eigen::Index k = 0; k < m_; ++k) {
      rl[k] = -room_below(k) * zl_[k];
      if (symmetric(k)) ru[k] = -room_above(k) * zu_[k];
    }
    const Direction predictor = newton(rl, ru);
    const auto [ax, az] = longest(predictor);
    double products = 0;
    Eigen::Index count = 0;
    for (Eigen::Index k = 0; k < m_; ++k) {
      const double dx = ax * predictor.x[k];
      products += (room_below(k) + dx) * (zl_[k] + az * predictor.zl[k]);
      ++count;
      if (!symmetric(k)) continue;
      products += (room_above(k) - dx) * (zu_[k] + az * predictor.zu[k]);
      ++count;
    }
    const double target = mu_ * std::pow(products / static_cast<double>(count) / mu_, 3);
    for (Eigen::Index k = 0; k < m_; ++k) {
      rl[k] += target - predictor.x[k] * predictor.zl[k];
      if (symmetric(k)) ru[k] += target + predictor.x[k] * predictor.zu[k];
    }
    const Direction d = newton(rl, ru);
    auto [x, z] = longest(d);
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
  Eigen::Index m_ = 0;
  std::vector<char> held_;
  SpMat laplacian_;
  std::shared_ptr<const Elimination> structure_;
  std::vector<Eigen::Index> place_;
  std::unique_ptr<Cholesky<double>> factor_;
  VecX s_, x_, zl_, zu_, theta_, residual_, unbalanced_;
  double mu_ = 0, gap_ = 1, dual_error_ = 0;
};

}  // namespace

InteriorPoint interior_point(const L1Integration& problem, double tolerance, const Task& task) {
  return Method(problem).run(tolerance, task);
}

}  // namespace littoral
