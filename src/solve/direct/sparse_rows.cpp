#include "solve/direct/sparse_rows.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "base/fetch_ahead.h"
#include "base/index.h"
#include "base/now_and_then.h"
#include "base/parallel.h"

namespace littoral {

namespace {

constexpr std::size_t row_grain = 1 << 14;
constexpr std::size_t rows_of_piece = 1 << 11;  // where a piece needs nothing of its own
constexpr Eigen::Index entries_ahead = 16;
constexpr std::size_t entries_of_piece = 1 << 18;

void counts_to_begins(int* begin, Eigen::Index rows) {
  std::partial_sum(begin, begin + rows + 1, begin);
}

}  // namespace

SpMat copied(const SpMat& A) {
  SpMat out(A.rows(), A.cols());
  std::copy_n(A.outerIndexPtr(), A.outerSize() + 1, out.outerIndexPtr());
  out.resizeNonZeros(A.nonZeros());
  parallel_for(std::size_t(A.nonZeros()), entries_of_piece, [&](std::size_t e, std::size_t end) {
    std::copy(A.innerIndexPtr() + e, A.innerIndexPtr() + end, out.innerIndexPtr() + e);
    std::copy(A.valuePtr() + e, A.valuePtr() + end, out.valuePtr() + e);
  });
  return out;
}

SpRows full_rows(const SpMat& lower) {
  const Eigen::Index n = lower.cols();
  SpRows A(n, n);
  int* const begin = A.outerIndexPtr();  // zeros
  const auto left = [&](std::size_t from, std::size_t end, const auto& see) {
    for (int j = 0; j < n && j < index(end); ++j)
      for (SpMat::InnerIterator it(lower, j); it; ++it)
        if (it.row() != j && std::size_t(it.row()) - from < end - from) see(j, it);
  };
  parallel_ranges(std::size_t(n), row_grain, [&](std::size_t from, std::size_t end) {
    left(from, end, [&](int, const SpMat::InnerIterator& it) { ++begin[it.row() + 1]; });
    for (std::size_t j = from; j < end; ++j)
      for (SpMat::InnerIterator it(lower, index(j)); it; ++it) ++begin[j + 1];
  });
  counts_to_begins(begin, n);
  A.resizeNonZeros(begin[n]);
  std::vector<int> at(begin, begin + n);
  // Left of the diagonal from columns in ascending order, then the diagonal and what is right of
  // it: every row comes out sorted.
  parallel_ranges(std::size_t(n), row_grain, [&](std::size_t from, std::size_t end) {
    const auto put = [&](Eigen::Index i, int j, double a) {
      A.innerIndexPtr()[at[i]] = j;
      A.valuePtr()[at[i]++] = a;
    };
    left(from, end, [&](int j, const SpMat::InnerIterator& it) { put(it.row(), j, it.value()); });
    for (int j = int(from); j < int(end); ++j)
      for (SpMat::InnerIterator it(lower, j); it; ++it) put(j, int(it.row()), it.value());
  });
  return A;
}

void multiply_rows(const SpRows& A, Eigen::Index first, Eigen::Index end, const double* x,
                   double* y) {
  const int* const begin = A.outerIndexPtr();
  const int* const to = A.innerIndexPtr();
  const double* const a = A.valuePtr();
  for (Eigen::Index i = first; i < end; ++i) {
    double sum = 0;
    for (int e = begin[i]; e < begin[i + 1]; ++e) sum += a[e] * x[to[e]];
    y[i] = sum;
  }
}

void multiply(const SpRows& A, const VecX& x, VecX& y, const Task& task) {
  y.resize(A.rows());
  parallel_for(A.rows(), rows_of_piece, [&](std::size_t i, std::size_t end) {
    stop_if_cancelled(task);
    multiply_rows(A, index(i), index(end), x.data(), y.data());
  });
}

SpRows made_rows(Eigen::Index rows, Eigen::Index columns,
                 const std::function<void(int, RowInMaking&)>& make, const Task& task) {
  const auto n = std::size_t(rows);
  // Pieces of rows, each with markers of its own over the columns.
  const std::size_t grain = std::max<std::size_t>(row_grain, (n + 31) / 32);
  struct Piece {
    std::vector<int> columns;
    std::vector<double> values;
  };
  std::vector<Piece> pieces((n + grain - 1) / grain);
  SpRows out(rows, columns);
  int* const begin = out.outerIndexPtr();
  parallel_for(n, grain, [&](std::size_t first, std::size_t end) {
    RowInMaking row(columns);  // in nobody else's lines of memory
    for (std::size_t i = first; i < end; ++i) {
      if (i % 4096 == 0) stop_if_cancelled(task);
      row.start_ = int_size(row.columns_);
      make(int(i), row);
      begin[i + 1] = int_size(row.columns_) - row.start_;
      if (i + 1 == first + (end - first) / 16) row.reserve(18);  // the others are alike
    }
    pieces[first / grain] = {std::move(row.columns_), std::move(row.values_)};
  });
  counts_to_begins(begin, rows);
  out.resizeNonZeros(begin[rows]);
  // Copied as they are: Eigen wants columns ascending where it copies.
  parallel_for(pieces.size(), 1, [&](std::size_t p, std::size_t) {
    const Piece piece = std::move(pieces[p]);
    std::copy(piece.columns.begin(), piece.columns.end(), out.innerIndexPtr() + begin[p * grain]);
    std::copy(piece.values.begin(), piece.values.end(), out.valuePtr() + begin[p * grain]);
  });
  return out;
}

SpRows product(const SpRows& A, const SpRows& B, const Task& task) {
  const auto make = [&](int i, RowInMaking& row) {
    for (int e = A.outerIndexPtr()[i]; e < A.outerIndexPtr()[i + 1]; ++e) {
      const int k = A.innerIndexPtr()[e];
      const double a = A.valuePtr()[e];
      for (int g = B.outerIndexPtr()[k]; g < B.outerIndexPtr()[k + 1]; ++g)
        row.at(B.innerIndexPtr()[g]) += a * B.valuePtr()[g];
    }
  };
  return made_rows(A.rows(), B.cols(), make, task);
}

SymmetricRows::SymmetricRows(const SpMat& lower) : begin_(lower.cols() + 1, 0) {
  const int n = lower.cols();
  const auto for_entries = [&](const auto& put) {
    for (int j = 0; j < n; ++j)
      for (int e = lower.outerIndexPtr()[j]; e < lower.outerIndexPtr()[j + 1]; ++e)
        if (lower.innerIndexPtr()[e] != j) put(lower.innerIndexPtr()[e], j, e);
  };
  for_entries([&](int i, int, int) { ++begin_[i + 1]; });
  counts_to_begins(begin_.data(), n);
  column_.resize(begin_[n]);
  place_.resize(column_.size());
  std::vector<int> at(begin_.begin(), begin_.end() - 1);
  for_entries([&](int i, int j, int e) {
    column_[at[i]] = j;
    place_[at[i]++] = e;
  });
}

VecX SymmetricRows::residual(const SpMat& lower, const VecX& x, const VecX& b) const {
  VecX r(b.size());
  const double* const a = lower.valuePtr();
  parallel_for(r.size(), row_grain, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      double left = 0, right = 0;
      for (int e = begin_[i]; e < begin_[i + 1]; ++e) left += a[place_[e]] * x[column_[e]];
      for (SpMat::InnerIterator it(lower, index(i)); it; ++it) {
        if (it.row() == index(i))
          left += it.value() * x[it.row()];
        else
          right += it.value() * x[it.row()];
      }
      r[index(i)] = b[index(i)] - (left + right);
    }
  });
  return r;
}

SpRows transposed(const SpRows& A) {
  SpRows T(A.cols(), A.rows());
  const int* const to = A.innerIndexPtr();
  const Eigen::Index n_entries = A.nonZeros();
  int* const begin = T.outerIndexPtr();  // zeros
  parallel_ranges(std::size_t(T.rows()), row_grain, [&](std::size_t from, std::size_t end) {
    for (Eigen::Index e = 0; e < n_entries; ++e)
      if (std::size_t(to[e]) - from < end - from) ++begin[to[e] + 1];
  });
  counts_to_begins(begin, T.rows());
  T.resizeNonZeros(n_entries);
  std::vector<int> at(begin, begin + T.rows());
  parallel_ranges(std::size_t(T.rows()), row_grain, [&](std::size_t from, std::size_t end) {
    const auto mine = [&](int row) { return std::size_t(row) - from < end - from; };
    for (int i = 0; i < A.rows(); ++i)
      for (int e = A.outerIndexPtr()[i]; e < A.outerIndexPtr()[i + 1]; ++e) {
        if (e + entries_ahead < n_entries && mine(to[e + entries_ahead])) {
          const int next = at[to[e + entries_ahead]];
          fetch_ahead(T.innerIndexPtr() + next);
          fetch_ahead(T.valuePtr() + next);
        }
        if (!mine(to[e])) continue;
        const int k = at[to[e]]++;
        T.innerIndexPtr()[k] = i;
        T.valuePtr()[k] = A.valuePtr()[e];
      }
  });
  return T;
}

}  // namespace littoral
