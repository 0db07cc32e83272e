#include "solve/direct/cholesky.h"

#include <algorithm>
#include <new>
#include <string>

#include "base/fetch_ahead.h"
#include "base/index.h"
#include "base/now_and_then.h"
#include "base/parallel.h"
#include "base/parallel_forest.h"
#include "base/platform/large_pages.h"
#include "littoral/error.h"
#include "solve/direct/dense_products.h"
#include "solve/direct/supernode_kernels.h"

namespace littoral {

namespace {

constexpr int small_front = 96;            // rows of a front that is factored by loops
constexpr std::size_t super_grain = 4096;  // supernodes, for loops that only move numbers

/// C := C - A A^*, or -A A^*, C the first m columns of it, rows x m, lower part; in pieces short
/// enough to be cancelled between.
template <class Scalar>
void subtract_trapezoid(int rows, int m, int k, const Scalar* A, int lda, Scalar* C, int ldc,
                        bool from_zero, const Task& task) {
  const double enough = 1e8;
  const int width =
      std::clamp(static_cast<int>(enough / (double(rows) * std::max(1, k) + 1)), 64, 1 << 20);
  for (int j = 0; j < m; j += width) {
    stop_if_cancelled(task);
    const int w = std::min(width, m - j);
    Scalar* D = C + j + index(j) * ldc;
    dense::subtract_product<Scalar>(rows - j, w, k, {A + j, 1, lda}, {A + j, lda, 1, true}, D, ldc,
                                    {.lower = true, .from_zero = from_zero});
  }
}

/// Factors the first `columns` columns of a front in place; false if a pivot is not positive.
template <class Scalar>
bool factor_columns(int height, int columns, Scalar* block, const Task& task) {
  constexpr int panel = 128;
  for (int j = 0; j < columns; j += panel) {
    const int w = std::min(panel, columns - j), rest = height - j - w;
    Scalar* D = block + j + index(j) * height;
    if (!dense::cholesky(w, D, height)) return false;
    dense::solve_right(rest, w, D, height, D + w, height);
    subtract_trapezoid(rest, columns - j - w, w, D + w, height, D + w + index(w) * height, height,
                       false, task);
  }
  return true;
}

/// A square of anything.
template <class Scalar>
std::shared_ptr<Scalar[]> square(int n) {
  auto* at = static_cast<Scalar*>(::operator new(std::size_t(n) * n * sizeof(Scalar)));
  return {at, [](Scalar* p) { ::operator delete(p); }};
}

}  // namespace

template <class Scalar>
Cholesky<Scalar>::Cholesky(const Matrix& lower, const Task& task, const Ordering& order)
    : Cholesky(lower,
               std::make_shared<const Elimination>(
                   lower, order.empty() ? dissection(lower, task) : order, task),
               task) {}

template <class Scalar>
Cholesky<Scalar>::Cholesky(const Matrix& lower, std::shared_ptr<const Elimination> structure,
                           const Task& task, bool to_be_patched)
    : structure_(std::move(structure)), to_be_patched_(to_be_patched) {
  factor(lower, std::vector<char>(structure_->n_super, 1), task);
}

template <class Scalar>
Cholesky<Scalar> Cholesky<Scalar>::patched(const Matrix& lower, const std::vector<int>& changed,
                                           const Task& task) const {
  const Elimination& E = *structure_;
  std::vector<char> stale(E.n_super, 0);
  for (int i : changed)
    for (int s = E.super_of[E.new_of[i]]; s >= 0 && !stale[s]; s = E.parent[s]) stale[s] = 1;
  Cholesky out = *this;
  out.to_be_patched_ = false;
  out.factor(lower, stale, task);
  return out;
}

template <class Scalar>
void Cholesky<Scalar>::factor(const Matrix& lower, const std::vector<char>& stale,
                              const Task& task) {
  const FlushSubnormals flush;
  const Elimination& E = *structure_;
  supernodes_.resize(E.n_super);
  task.checkpoint();
  for (int s = 0; s < E.n_super; ++s)
    if (stale[s]) supernodes_[s].block.reset();
  // Solves go through all of a factor: its blocks lie together.
  const bool whole = std::find(stale.begin(), stale.end(), 0) == stale.end();
  if (const auto all = whole ? large_pages(E.values() * sizeof(Scalar)) : nullptr)
    for (int s = 0; s < E.n_super; ++s)
      supernodes_[s].block =
          std::shared_ptr<Scalar[]>(all, static_cast<Scalar*>(all.get()) + E.values_begin[s]);
  try {
    parallel_forest(E.task_parent, Walk::from_leaves, [&](int t) {
      for (int s = E.task_first[t]; s < E.task_first[t + 1]; ++s)
        if (stale[s]) factor_supernode(lower, s, task);
    });
  } catch (const std::bad_alloc&) {
    supernodes_.clear();
    throw SolveError("not enough memory to factor a matrix of order " + std::to_string(E.n),
                     "too-large");
  }
  if (!to_be_patched_)
    for (Supernode& node : supernodes_) node.update.reset();
  task.checkpoint();
}

template <class Scalar>
void Cholesky<Scalar>::factor_supernode(const Matrix& lower, int s, const Task& task) {
  stop_if_cancelled(task);
  const Elimination& E = *structure_;
  const int columns = E.columns(s), below = E.below(s), height = columns + below;
  Supernode& node = supernodes_[s];
  const std::size_t size = E.values_begin[s + 1] - E.values_begin[s];
  if (!node.block) node.block = std::shared_ptr<Scalar[]>(new Scalar[size]);
  Scalar* block = node.block.get();
  std::fill_n(block, size, Scalar(0));
  node.update = square<Scalar>(below);
  Scalar* update = node.update.get();
  const Scalar* values = lower.valuePtr();
  for (int k = 0; k < columns; ++k)
    for (int e = E.entry_begin[E.first[s] + k]; e < E.entry_begin[E.first[s] + k + 1]; ++e) {
      const int from = E.entry_from[e];
      block[E.entry_row[e] + index(k) * height] +=
          from >= 0 ? values[from] : Eigen::numext::conj(values[~from]);
    }
  // What children pass on, of the columns here before these are eliminated, of the rest afterwards.
  const auto add_children = [&](bool own) {
    for (int c = E.child_begin[s]; c < E.child_begin[s + 1]; ++c) {
      const int child = E.children[c], m = E.below(child);
      const int* place = E.at_parent.data() + E.rows_begin[child];
      const int end = static_cast<int>(std::lower_bound(place, place + m, columns) - place);
      for (int j = own ? 0 : end; j < (own ? end : m); ++j) {
        const Scalar* passed_on = supernodes_[child].update.get() + index(j) * m;
        const std::ptrdiff_t p = place[j];
        Scalar* column = own ? block + p * height : update + (p - columns) * below - columns;
        for (int i = j; i < m; ++i) column[place[i]] += passed_on[i];
      }
      if (!own && !to_be_patched_) supernodes_[child].update.reset();
    }
  };
  add_children(true);
  const bool small = columns <= dense::small_supernode && height <= small_front;
  if (small ? !dense::factor_small(columns, height, block, update)
            : !factor_columns(height, columns, block, task))
    throw SolveError("the matrix is not positive definite (near unknown " +
                     std::to_string(E.old_of[E.first[s]]) + ")");
  if (!small)
    subtract_trapezoid(below, below, columns, block + columns, height, update, below, true, task);
  add_children(false);
}

template <class Scalar>
void Cholesky<Scalar>::mark_up(int s, std::vector<char>& marked) const {
  for (; s >= 0 && !marked[s]; s = structure_->parent[s]) marked[s] = 1;
}

/// x: b in the order of elimination. Returns the supernodes that its nonzeros pass through.
template <class Scalar>
std::vector<char> Cholesky<Scalar>::in_order(const Dense& b, Dense& x) const {
  const Elimination& E = *structure_;
  std::vector<char> given(E.n_super, 0), nonzero = given;
  x.resize(b.rows(), b.cols());
  parallel_for(given.size(), super_grain, [&](std::size_t first, std::size_t end) {
    for (Eigen::Index k = 0; k < b.cols(); ++k)
      for (std::size_t s = first; s < end; ++s)
        for (int i = E.first[s]; i < E.first[s + 1]; ++i) {
          x(i, k) = b(E.old_of[i], k);
          if (x(i, k) != Scalar(0)) given[s] = 1;
        }
  });
  for (int s = 0; s < E.n_super; ++s)
    if (given[s]) mark_up(s, nonzero);
  return nonzero;
}

template <class Scalar>
typename Cholesky<Scalar>::Dense Cholesky<Scalar>::out_of_order(const Dense& x) const {
  const Elimination& E = *structure_;
  Dense out(x.rows(), x.cols());
  parallel_for(E.n_super, super_grain, [&](std::size_t first, std::size_t end) {
    for (Eigen::Index k = 0; k < x.cols(); ++k)
      for (int i = E.first[first]; i < E.first[end]; ++i) out(E.old_of[i], k) = x(i, k);
  });
  return out;
}

template <class Scalar>
void Cholesky<Scalar>::forward(const std::vector<char>& active, Dense& x) const {
  std::vector<Dense> passed_on(structure_->n_tasks());
  parallel_forest(structure_->task_parent, Walk::from_leaves,
                  [&](int t) { forward(t, active, x, passed_on); });
}

template <class Scalar>
void Cholesky<Scalar>::backward(const std::vector<char>& active, Dense& x) const {
  parallel_forest(structure_->task_parent, Walk::from_roots,
                  [&](int t) { backward(t, active, x); });
}

template <class Scalar>
typename Cholesky<Scalar>::Dense Cholesky<Scalar>::solve(const Dense& b,
                                                         const std::vector<char>& wanted) const {
  const FlushSubnormals flush;
  const Elimination& E = *structure_;
  // What is not zero flows up the tree from where b is not; what is wanted needs all above it.
  Dense x;
  const std::vector<char> nonzero = in_order(b, x);
  std::vector<char> needed(E.n_super, wanted.empty() ? 1 : 0);
  if (!wanted.empty())
    for (int s = 0; s < E.n_super; ++s)
      for (int i = E.first[s]; i < E.first[s + 1] && !needed[s]; ++i)
        if (wanted[E.old_of[i]]) mark_up(s, needed);
  forward(nonzero, x);
  backward(needed, x);
  return out_of_order(x);
}

template <class Scalar>
typename Cholesky<Scalar>::Dense Cholesky<Scalar>::solve_corrected(
    const Dense& b, const std::vector<int>& at, int rounds, const Correction& correct) const {
  const FlushSubnormals flush;
  const Elimination& E = *structure_;
  // L z = b. What is added to b adds to z above `at` only, and x there depends on z there only.
  Dense z;
  forward(in_order(b, z), z);
  std::vector<char> above(E.n_super, 0);
  for (const int i : at) mark_up(E.super_of[E.new_of[i]], above);
  std::vector<int> parts;
  for (int s = 0; s < E.n_super; ++s)
    if (above[s]) parts.push_back(s);
  const auto each_above = [&](const auto& change) {
    for (const int s : parts) change(E.first[s], E.columns(s));
  };
  Dense y(z.rows(), z.cols()), x_at(index(at.size()), z.cols());
  for (int round = 0; round < rounds; ++round) {
    each_above([&](int i, int n) { y.middleRows(i, n) = z.middleRows(i, n); });
    backward(above, y);
    for (std::size_t k = 0; k < at.size(); ++k) x_at.row(index(k)) = y.row(E.new_of[at[k]]);
    const Dense more = correct(x_at);
    each_above([&](int i, int n) { y.middleRows(i, n).setZero(); });
    for (std::size_t k = 0; k < at.size(); ++k) y.row(E.new_of[at[k]]) += more.row(index(k));
    forward(above, y);
    each_above([&](int i, int n) { z.middleRows(i, n) += y.middleRows(i, n); });
  }
  backward(std::vector<char>(E.n_super, 1), z);
  return out_of_order(z);
}

namespace {

/// Asks for a block that is needed soon: blocks lie anywhere, and small ones are worked on faster
/// than they come.
template <class Scalar>
void fetch(const Scalar* block, std::size_t n) {
  constexpr std::size_t line = 64, most = 4096;  // bytes; longer ones fetch themselves
  const auto* bytes = reinterpret_cast<const char*>(block);
  const std::size_t end = std::min(n * sizeof(Scalar), most);
  for (std::size_t at = 0; at < end; at += line) fetch_ahead(bytes + at);
}

}  // namespace

template <class Scalar>
void Cholesky<Scalar>::forward(int t, const std::vector<char>& active, Dense& x,
                               std::vector<Dense>& passed_on) const {
  // x := L^-1 x on the columns of the task; what that subtracts from later rows is passed on to the
  // task that holds them, so that tasks may run side by side.
  const Elimination& E = *structure_;
  const int n_rhs = x.cols(), root = E.task_first[t + 1] - 1;
  Dense& out = passed_on[t];
  out = Dense::Zero(E.below(root), n_rhs);
  auto subtract_at = [&](int target, int k) -> Scalar& {
    return target >= 0 ? x(target, k) : out(~target, k);
  };
  Dense y;
  for (int s = E.task_first[t]; s <= root; ++s) {
    if (!active[s]) continue;
    const int columns = E.columns(s), below = E.below(s), height = columns + below;
    for (int c = E.child_begin[s]; c < E.child_begin[s + 1]; ++c) {
      const int child = E.children[c];
      if (child >= E.task_first[t]) continue;
      const Dense& in = passed_on[E.task_of[child]];
      const int* place = E.at_parent.data() + E.rows_begin[child];
      for (int k = 0; k < n_rhs; ++k)
        for (int i = 0; i < E.below(child); ++i)
          subtract_at(place[i] < columns ? E.first[s] + place[i]
                                         : E.target[E.rows_begin[s] + place[i] - columns],
                      k) += in(i, k);
    }
    const Scalar* block = supernodes_[s].block.get();
    if (s < root && active[s + 1])
      fetch(supernodes_[s + 1].block.get(),
            E.columns(s + 1) * index(E.columns(s + 1) + E.below(s + 1)));
    if (y.rows() < below || y.cols() != n_rhs)
      y.resize(std::max<Eigen::Index>(below, 2 * y.rows()), n_rhs);
    const int ldy = y.rows();
    dense::forward(columns, height, n_rhs, block, &x(E.first[s], 0), E.n, y.data(), ldy);
    const int* target = E.target.data() + E.rows_begin[s];
    for (int k = 0; k < n_rhs; ++k)
      for (int i = 0; i < below; ++i) subtract_at(target[i], k) -= y(i, k);
  }
}

template <class Scalar>
void Cholesky<Scalar>::backward(int t, const std::vector<char>& active, Dense& x) const {
  const Elimination& E = *structure_;
  const int n_rhs = x.cols();
  Dense y;
  for (int s = E.task_first[t + 1]; s-- > E.task_first[t];) {
    if (!active[s]) continue;
    const int columns = E.columns(s), below = E.below(s), height = columns + below;
    const Scalar* block = supernodes_[s].block.get();
    if (s > E.task_first[t] && active[s - 1])
      fetch(supernodes_[s - 1].block.get(),
            E.columns(s - 1) * index(E.columns(s - 1) + E.below(s - 1)));
    if (y.rows() < height || y.cols() != n_rhs)
      y.resize(std::max<Eigen::Index>(height, 2 * y.rows()), n_rhs);
    const int ldy = y.rows();
    const int* rows = E.rows.data() + E.rows_begin[s];
    for (int k = 0; k < n_rhs; ++k) {
      Scalar *v = &y(0, k), *own = &x(E.first[s], k);
      std::copy_n(own, columns, v);
      for (int i = 0; i < below; ++i) v[columns + i] = x(rows[i], k);
    }
    dense::backward(columns, height, n_rhs, block, y.data(), ldy);
    for (int k = 0; k < n_rhs; ++k) std::copy_n(&y(0, k), columns, &x(E.first[s], k));
  }
}

template <class Scalar>
RaisedCholesky<Scalar> raised_cholesky(const Eigen::SparseMatrix<Scalar>& lower,
                                       const std::shared_ptr<const Elimination>& structure,
                                       const Task& task, bool to_be_patched) {
  try {
    return {Cholesky<Scalar>(lower, structure, task, to_be_patched), 0};
  } catch (const SolveError&) {  // not positive definite to working precision
  }
  for (double share = 1e-14;; share *= 100) {
    Eigen::SparseMatrix<Scalar> higher = lower;
    higher.diagonal() *= 1 + share;
    try {
      return {Cholesky<Scalar>(higher, structure, task), share};
    } catch (const SolveError&) {
      if (share > 1e-9) throw;
    }
  }
}

template class Cholesky<double>;
template class Cholesky<Complex>;
template RaisedCholesky<double> raised_cholesky(const SpMat&,
                                                const std::shared_ptr<const Elimination>&,
                                                const Task&, bool);
template RaisedCholesky<Complex> raised_cholesky(const SpMatC&,
                                                 const std::shared_ptr<const Elimination>&,
                                                 const Task&, bool);

}  // namespace littoral
