#include "solve/multigrid/multigrid.h"

#include <cmath>

#include "base/index.h"
#include "base/parallel.h"
#include "base/platform/memory.h"
#include "base/thread_crew.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr Eigen::Index largest_coarsest = 20'000;  // unknowns that are factored
constexpr double strength = 0.08;                  // halves with each level (Vanek et al., sec. 5)
constexpr double lowest = 0.1;  // part of the spectrum that smoothing is for: [lowest, 1]
constexpr int degree = 2;       // of the Chebyshev polynomial
constexpr std::size_t entries_at_once = 1 << 15;

VecX inverse_row_sums(const SpRows& A) {
  VecX s(A.rows());
  parallel_for(std::size_t(A.rows()), entries_at_once, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index i = index(begin); i < index(end); ++i) {
      double sum = 0;
      for (SpRows::InnerIterator it(A, i); it; ++it) sum += std::abs(it.value());
      s[i] = sum > 0 ? 1 / sum : 0;
    }
  });
  return s;
}

/// Chebyshev iteration on [lowest, 1] (Saad, Iterative methods for sparse linear systems,
/// algorithm 12.1), preconditioned by the row sums: as good on any number of threads. d, Ax: room.
void smooth(const SpRows& A, const VecX& inverse_size, const VecX& b, VecX& x, bool from_zero,
            VecX& d, VecX& Ax, const Task& task) {
  constexpr double middle = 0.5 * (1 + lowest), half = 0.5 * (1 - lowest), sigma = middle / half;
  d.resize(b.size());
  double rho = 1 / sigma;
  if (from_zero) x.resize(b.size());
  for (int k = 0; k < degree; ++k) {
    const bool zero = from_zero && k == 0;
    if (!zero) multiply(A, x, Ax, task);
    const double rho_next = k == 0 ? rho : 1 / (2 * sigma - rho);
    const double keep = k == 0 ? 0 : rho_next * rho;
    const double step = k == 0 ? 1 / middle : 2 * rho_next / half;
    rho = rho_next;
    parallel_for(b.size(), entries_at_once, [&](std::size_t begin, std::size_t end) {
      for (Eigen::Index i = index(begin); i < index(end); ++i) {
        const double r = inverse_size[i] * (zero ? b[i] : b[i] - Ax[i]);
        d[i] = (k == 0 ? 0 : keep * d[i]) + step * r;
        x[i] = zero ? d[i] : x[i] + d[i];
      }
    });
  }
}

SpMat lower_triangle(const SpRows& A) {
  Triplets entries;
  for (int i = 0; i < A.rows(); ++i)
    for (SpRows::InnerIterator it(A, i); it; ++it)
      if (it.col() <= i) entries.emplace_back(i, it.col(), it.value());
  SpMat lower(A.rows(), A.cols());
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

}  // namespace

Multigrid::Multigrid(SpMat&& lower, const Task& task) {
  const KeepThreads keep_threads;
  levels_.emplace_back().A = full_rows(lower);
  SpMat().swap(lower);
  return_freed_memory();
  double strong = strength;
  while (levels_.back().A.rows() > largest_coarsest) {
    Level& level = levels_.back();
    level.P = smoothed_aggregation(level.A, strong, task);
    if (static_cast<double>(level.P.cols()) > 0.7 * static_cast<double>(level.A.rows())) {
      level.P = SpRows();
      break;  // next to nothing is coupled
    }
    level.inverse_size = inverse_row_sums(level.A);
    const SpRows AP = product(level.A, level.P, task);
    level.R = transposed(level.P);
    levels_.emplace_back().A = product(level.R, AP, task);
    strong /= 2;
  }
  coarsest_ = factor_for_preconditioning(lower_triangle(levels_.back().A), task);
  return_freed_memory();
}

std::shared_ptr<const Cholesky<double>> factor_for_preconditioning(SpMat lower, const Task& task) {
  const auto structure = std::make_shared<const Elimination>(lower, dissection(lower, task));
  const VecX d = lower.diagonal();
  for (double lift = 1e-13;; lift *= 100) {
    for (Eigen::Index i = 0; i < d.size(); ++i)
      lower.coeffRef(i, i) = d[i] > 0 ? d[i] * (1 + lift) : 1;
    try {
      return std::make_shared<const Cholesky<double>>(lower, structure, task);
    } catch (const SolveError&) {
      if (lift > 1e-4) throw;
    }
  }
}

double Multigrid::nonzeros() const {
  double sum = coarsest_->nonzeros();
  for (const Level& level : levels_)
    sum += static_cast<double>(level.A.nonZeros() + 2 * level.P.nonZeros());
  return sum;
}

void Multigrid::cycle_at(std::size_t k, const VecX& b, VecX& x, Work& work,
                         const Task& task) const {
  if (k + 1 == levels_.size()) {
    x = coarsest_->solve(b);
    return;
  }
  const Level& level = levels_[k];
  Work::OfLevel& own = work.levels[k];
  smooth(level.A, level.inverse_size, b, x, true, own.d, own.r, task);
  multiply(level.A, x, own.r, task);
  parallel_for(b.size(), entries_at_once, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index i = index(begin); i < index(end); ++i) own.r[i] = b[i] - own.r[i];
  });
  Work::OfLevel& coarse = work.levels[k + 1];
  multiply(level.R, own.r, coarse.b, task);
  cycle_at(k + 1, coarse.b, coarse.x, work, task);
  multiply(level.P, coarse.x, own.r, task);
  parallel_for(b.size(), entries_at_once, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index i = index(begin); i < index(end); ++i) x[i] += own.r[i];
  });
  smooth(level.A, level.inverse_size, b, x, false, own.d, own.r, task);
}

void Multigrid::cycle(const VecX& b, VecX& x, Work& work, const Task& task) const {
  work.levels.resize(levels_.size());
  cycle_at(0, b, x, work, task);
}

}  // namespace littoral
