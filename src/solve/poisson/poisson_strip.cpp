#include "solve/poisson/poisson_strip.h"

#include <cmath>
#include <limits>

#include "base/index.h"
#include "solve/direct/sparse_rows.h"

namespace littoral {

StripPoisson::StripPoisson(const Poisson& poisson, const std::vector<int>& row_of)
    : solve_(*poisson.system().exact_factor(), row_of) {
  const SpMat& lower = poisson.system().lower();
  largest_ = lower.size() ? lower.diagonal().maxCoeff() : 0;
  const SpRows A = full_rows(lower);
  std::vector<int> unknown(row_of.size());
  for (std::size_t i = 0; i < row_of.size(); ++i) unknown[row_of[i]] = static_cast<int>(i);
  begin_.assign(1, 0);
  to_.reserve(A.nonZeros());
  value_.reserve(A.nonZeros());
  for (const int i : unknown) {
    for (SpRows::InnerIterator it(A, i); it; ++it) {
      to_.push_back(row_of[it.col()]);
      value_.push_back(it.value());
    }
    begin_.push_back(int_size(to_));
  }
}

std::array<double, strip_width> StripPoisson::solve(const Strip& b, Strip& x, Strip& spare,
                                                    const Task& task) const {
  constexpr double enough = 1e-14, alone = std::numeric_limits<double>::quiet_NaN();
  constexpr int most_steps = 4;
  const auto residual = [&](Strip* r) {
    std::array<std::array<double, strip_width>, 3> sums;
    dense::residual_strip(static_cast<int>(b.rows()), begin_.data(), to_.data(), value_.data(),
                          b.data(), x.data(), r ? r->data() : nullptr, sums[0].data());
    for (auto& of : sums)
      for (double& s : of) s = std::sqrt(s);
    return sums;
  };
  x = b;
  solve_(x, {}, spare, task);
  std::array<double, strip_width> out{};
  std::array<bool, strip_width> refine{};
  bool any = false;
  {
    const auto [r, scale, size] = residual(nullptr);
    for (Eigen::Index k = 0; k < strip_width; ++k) {
      if (!(scale[k] > 0)) continue;
      out[k] = r[k] < scale[k] ? r[k] / scale[k] : alone;
      refine[k] = r[k] > enough * (scale[k] + largest_ * size[k]) && r[k] <= 0.1 * scale[k];
      any = any || refine[k];
    }
  }
  Strip r;
  for (int step = 1; any && step < most_steps; ++step) {
    r.resize(b.rows(), strip_width);
    residual(&r);
    for (Eigen::Index k = 0; k < strip_width; ++k)
      if (!refine[k]) r.col(k).setZero();
    solve_(r, {}, spare, task);
    x += r;
    const auto [left, scale, size] = residual(nullptr);
    any = false;
    for (Eigen::Index k = 0; k < strip_width; ++k) {
      if (!refine[k]) continue;
      const double before = out[k], now = left[k] / scale[k];
      refine[k] = false;
      if (!(now < before)) {
        x.col(k) -= r.col(k);
        continue;
      }
      out[k] = now;
      refine[k] = left[k] > enough * (scale[k] + largest_ * size[k]) && now <= 0.1 * before;
      any = any || refine[k];
    }
  }
  return out;
}

}  // namespace littoral
