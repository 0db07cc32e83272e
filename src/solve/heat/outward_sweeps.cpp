#include "solve/heat/outward_sweeps.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/index.h"
#include "base/now_and_then.h"
#include "base/platform/floating_point.h"
#include "solve/direct/sparse_rows.h"

namespace littoral {

namespace {

constexpr int most_sweeps = 300, check_every = 5;
constexpr double met = 1e-12;            // of the terms of a row
constexpr double out_of_range = 1e-290;  // rows of such terms are below the range of numbers

using Vec4 = Eigen::Array4d;  // three columns, and one that fills the register

/// Rows in the order in which steps from those where B is not zero come to them; those that none
/// come to are left out.
std::vector<int> outward(const SpRows& A, const MatX3& B) {
  std::vector<char> seen(A.rows(), 0);
  std::vector<int> order;
  order.reserve(A.rows());
  for (int i = 0; i < A.rows(); ++i)
    if (!B.row(i).isZero(0)) {
      seen[i] = 1;
      order.push_back(i);
    }
  for (std::size_t k = 0; k < order.size(); ++k)  // grows meanwhile
    for (SpRows::InnerIterator it(A, order[k]); it; ++it)
      if (it.value() != 0 && !seen[it.col()]) {
        seen[it.col()] = 1;
        order.push_back(static_cast<int>(it.col()));
      }
  return order;
}

/// Young's: of a matrix D (I - J), J of spectral radius r, relaxation by 2 / (1 + sqrt(1 - r^2))
/// is the fastest. Constants lose the least in J, in each row the share of the diagonal that its
/// entries sum to; here of a row in the middle, as slivers have next to none.
double relaxation(const SpRows& A, const std::vector<int>& order) {
  if (order.empty()) return 1;
  std::vector<double> share;
  share.reserve(order.size());
  for (const int i : order) {
    double sum = 0, diagonal = 0;
    for (SpRows::InnerIterator it(A, i); it; ++it) {
      sum += it.value();
      if (it.col() == i) diagonal = it.value();
    }
    share.push_back(std::clamp(sum / diagonal, 0.0, 1.0));
  }
  const auto middle = share.begin() + index(share.size() / 2);
  std::nth_element(share.begin(), middle, share.end());
  return 2 / (1 + std::sqrt(*middle * (2 - *middle)));
}

/// By the pace that goes with it, relax - 1, and what lattices take more than that.
double predicted_sweeps(double relax) {
  constexpr double more = 1.8;
  return more * std::log(met) / std::log(relax - 1);
}

/// The rows in that order, each divided by its diagonal, which is left out.
class Sweeps {
 public:
  Sweeps(const SpRows& A, const MatX3& B, const std::vector<int>& order)
      : b_(order.size(), Vec4::Zero()), x_(order.size(), Vec4::Zero()) {
    std::vector<int> place(A.rows(), -1);
    for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
    begin_.push_back(0);
    to_.reserve(A.nonZeros());
    a_.reserve(A.nonZeros());
    for (std::size_t k = 0; k < order.size(); ++k) {
      const int i = order[k];
      const double scale = 1 / A.coeff(i, i);
      for (SpRows::InnerIterator it(A, i); it; ++it)
        if (it.col() != i && it.value() != 0) {
          to_.push_back(place[it.col()]);
          a_.push_back(scale * it.value());
        }
      begin_.push_back(int_size(to_));
      b_[k].head<3>() = scale * B.row(i).transpose().array();
    }
  }

  void sweep(double relax) {
    for (std::size_t k = 0; k < x_.size(); ++k) {
      Vec4 next = b_[k];
      for (int e = begin_[k]; e < begin_[k + 1]; ++e) next -= a_[e] * x_[to_[e]];
      x_[k] += relax * (next - x_[k]);
    }
  }

  /// What is left of a row over the size of its terms, where that is largest.
  double misfit() const {
    double worst = 0;
    for (std::size_t k = 0; k < x_.size(); ++k) {
      Vec4 rest = b_[k] - x_[k], size = b_[k].abs() + x_[k].abs();
      for (int e = begin_[k]; e < begin_[k + 1]; ++e) {
        const Vec4 term = a_[e] * x_[to_[e]];
        rest -= term;
        size += term.abs();
      }
      const double most = size.maxCoeff();
      if (most > out_of_range) worst = std::max(worst, rest.abs().maxCoeff() / most);
    }
    return worst;
  }

  const Vec4& x(std::size_t k) const { return x_[k]; }

 private:
  std::vector<int> begin_, to_;
  std::vector<double> a_;
  std::vector<Vec4> b_, x_;
};

}  // namespace

std::optional<MatX3> solve_by_outward_sweeps(const SpMat& lower, const MatX3& B, const Task& task) {
  const FlushSubnormals flush;
  const SpRows A = full_rows(lower);
  const std::vector<int> order = outward(A, B);
  const double relax = relaxation(A, order);
  if (predicted_sweeps(relax) > most_sweeps) return std::nullopt;
  Sweeps sweeps(A, B, order);
  for (int k = 1;; ++k) {
    stop_if_cancelled(task);
    sweeps.sweep(relax);
    if (k % check_every != 0) continue;
    const double misfit = sweeps.misfit();
    task.checkpoint(std::min(1.0, std::log(std::min(misfit, 1.0)) / std::log(met)));
    if (misfit <= met) break;
    if (k >= most_sweeps || !std::isfinite(misfit)) return std::nullopt;
  }
  MatX3 X = MatX3::Zero(B.rows(), 3);
  for (std::size_t k = 0; k < order.size(); ++k) X.row(order[k]) = sweeps.x(k).head<3>();
  return X;
}

}  // namespace littoral
