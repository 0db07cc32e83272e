#include "solve/heat/heat_system.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/counted.h"
#include "base/index.h"
#include "base/parallel.h"
#include "base/parallel_sum.h"
#include "base/platform/memory.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr std::size_t largest_factor = 4'000'000'000;       // bytes, for many solves
constexpr std::size_t largest_for_one_solve = 400'000'000;  // beyond, windows take a tenth of it

/// An order of the blocks, from the graph of their first unknowns.
template <class Scalar>
Ordering order_of_blocks(const Eigen::SparseMatrix<Scalar>& lower, int block, const Task& task) {
  if (block == 1) return dissection(lower, task);
  std::vector<Eigen::Triplet<Scalar>> entries;
  for (int j = 0; j < lower.outerSize(); ++j)
    for (typename Eigen::SparseMatrix<Scalar>::InnerIterator it(lower, j); it; ++it)
      entries.emplace_back(it.row() / block, j / block, it.value());
  const Eigen::Index n = lower.cols() / block;
  Eigen::SparseMatrix<Scalar> blocks(n, n);
  blocks.setFromTriplets(entries.begin(), entries.end());
  return dissection(blocks, task);
}

template <class Scalar>
void warn_of_missing(const ScaledField<Scalar>& field, const std::vector<int>& piece,
                     Report& report) {
  std::size_t missing = 0;
  for (std::size_t i = 0; i < piece.size(); ++i) missing += piece[i] >= 0 && field.layer[i] < 0;
  if (missing > 0)
    report.warn("direction-missing", "heat did not reach " +
                                         counted(missing, "element", "elements") +
                                         ": the Poisson step fills in the distance there, less "
                                         "exactly. A larger option time-scale reaches farther");
}

}  // namespace

Eigen::Index largest_to_factor(SolveHint hint) {
  return hint == SolveHint::single_rhs ? 800'000 : 8'000'000;
}

template <class Scalar>
HeatSystem<Scalar>::HeatSystem(std::shared_ptr<const Matrix> lower, int block, const VecX& M,
                               SolveHint hint, const Task& task, Ordering order,
                               std::shared_ptr<const Elimination> known)
    : A_(std::move(lower)),
      rows_(rows_of(A_, block)),
      block_(block),
      windows_(rows_, M, order.empty() ? order_of_blocks(*A_, block, task) : std::move(order)),
      structure_(std::move(known)) {
  if (A_->rows() > largest_to_factor(hint)) return;
  const auto structure = eliminated(*A_, task);
  const std::size_t limit = hint == SolveHint::single_rhs ? largest_for_one_solve : largest_factor;
  if (structure->values() <= limit / sizeof(Scalar))
    factor_.emplace(raised_cholesky(*A_, structure, task).factor);
}

template <class Scalar>
HeatSystem<Scalar>::HeatSystem(std::shared_ptr<const HermitianRows<Scalar>> rows, const VecX& M,
                               const Ordering& order)
    : rows_(std::move(rows)), block_(rows_->block()), windows_(rows_, M, order) {}

template <class Scalar>
std::shared_ptr<const Elimination> HeatSystem<Scalar>::eliminated(const Matrix& A,
                                                                  const Task& task) const {
  if (structure_) return structure_;
  return std::make_shared<const Elimination>(A, in_blocks(windows_.order(), block_), task);
}

template <class Scalar>
ScaledField<Scalar> HeatSystem<Scalar>::solve(HeatSource<Scalar> b, const std::vector<int>& piece,
                                              const Task& task, Report& report) const {
  const std::vector<double> largest = largest_of_pieces(b, piece);
  std::vector<int> reached(piece.size(), -1);
  parallel_for(piece.size(), block_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (piece[i] >= 0 && largest[piece[i]] > 0) reached[i] = piece[i];
  });
  for (std::size_t s = 0; s < b.blocks.size(); ++s)
    for (Eigen::Index k = index(s) * block_; k < index(s + 1) * block_; ++k)
      b.value[k] = reached[b.blocks[s]] >= 0 ? Scalar(b.value[k] / largest[reached[b.blocks[s]]])
                                             : Scalar(0);
  const auto in_passes = [&](const Matrix& A, const Cholesky<Scalar>& factor) {
    Vector r = Vector::Zero(A.rows());
    for (std::size_t s = 0; s < b.blocks.size(); ++s)
      r.segment(Eigen::Index{b.blocks[s]} * block_, block_) =
          b.value.segment(index(s) * block_, block_);
    return solve_in_passes(A, factor, std::move(r), reached, task, report);
  };
  if (factor_) return in_passes(*A_, *factor_);
  auto field = windows_.solve(b, reached, task, report);
  return_freed_memory();
  if (field) {
    warn_of_missing(*field, reached, report);
    return std::move(*field);
  }
  const auto A = A_ ? A_ : std::make_shared<const Matrix>(lower_triangle(*rows_, task));
  return in_passes(*A, raised_cholesky(*A, eliminated(*A, task), task).factor);
}

template <class Scalar>
ScaledField<Scalar> HeatSystem<Scalar>::solve_prescribed(const Vector& values,
                                                         const std::vector<int>& piece,
                                                         const Task& task, Report& report) const {
  return solve(nonzero_blocks(windows_.source_prescribing(values, task), block_), piece, task,
               report);
}

template <class Scalar>
ScaledField<Scalar> HeatSystem<Scalar>::solve_in_passes(const Matrix& A,
                                                        const Cholesky<Scalar>& factor, Vector r,
                                                        const std::vector<int>& piece,
                                                        const Task& task, Report& report) const {
  const Eigen::Index n = r.size() / block_;
  ScaledField<Scalar> field{Vector::Zero(r.size()), std::vector<int>(n, -1), {1.0}};
  Eigen::Index left = n - std::count(piece.begin(), piece.end(), -1);
  int passes = 0;
  constexpr char older = 0, outside = 1, fresh = 2;  // unknowns of earlier layers, none, this one
  std::vector<char> side(r.size(), outside);
  while (left > 0) {
    task.checkpoint();
    const int p = passes++;  // side: all outside or older
    const Vector z = factor.solve(r, side);
    const auto top_of = [&](std::size_t begin, std::size_t end) {
      double top_here = 0;
      for (std::size_t i = begin; i < end; ++i)
        if (field.layer[i] < 0 && piece[i] >= 0)
          top_here = std::max(top_here, block_magnitude(z, index(i), block_));
      return top_here;
    };
    const double top = of_pieces(std::size_t(n), block_grain, 0.0, top_of, Larger());
    if (!(top > 0) || !std::isfinite(top)) break;
    const auto take = [&](std::size_t begin, std::size_t end) {
      Eigen::Index taken_here = 0;
      for (std::size_t i = begin; i < end; ++i) {
        if (field.layer[i] >= 0 || piece[i] < 0) continue;
        for (Eigen::Index k = index(i) * block_; k < index(i + 1) * block_; ++k) field.x[k] = z[k];
        if (block_magnitude(z, index(i), block_) < heat_front * top) continue;
        field.layer[i] = p;
        std::fill_n(side.begin() + index(i) * block_, block_, fresh);
        ++taken_here;
      }
      return taken_here;
    };
    const auto taken = of_pieces(std::size_t(n), block_grain, Eigen::Index{0}, take);
    left -= taken;
    if (left == 0 || taken == 0) break;

    // b - A (x truncated to the layers so far): nonzero on both sides of the front only.
    r.setZero();
    for (int j = 0; j < A.outerSize(); ++j) {
      const char at_j = side[j];
      for (typename Matrix::InnerIterator it(A, j); it; ++it) {
        const Eigen::Index i = it.row();
        if ((side[i] ^ at_j) != (outside | fresh)) continue;  // not one outside, one fresh
        const Scalar a = it.value(), a_transposed = Eigen::numext::conj(a);
        if (at_j == fresh) {
          r[i] -= a * field.x[j];
          r[j] += a_transposed * field.x[i];
        } else {
          r[j] -= a_transposed * field.x[i];
          r[i] += a * field.x[j];
        }
      }
    }
    for (char& s : side)
      if (s == fresh) s = older;
    double m = 0;
    for (Eigen::Index i = 0; i < r.size(); ++i) m = std::max(m, magnitude(r[i]));
    if (!(m > 0)) break;
    r *= 1 / m;  // Eigen divides complex numbers by the square of m, which underflows
    field.scale.push_back(m);
  }
  report.iterations.emplace_back("heat passes", passes);
  for (Eigen::Index i = 0; i < n; ++i)
    if (field.layer[i] < 0) field.x.segment(i * block_, block_).setZero();
  warn_of_missing(field, piece, report);
  return field;
}

template class HeatSystem<double>;
template class HeatSystem<Complex>;

}  // namespace littoral
