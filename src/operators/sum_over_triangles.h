#pragma once
// Sparse matrices as sums over triangles, without a list of all their terms.

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/fetch_ahead.h"
#include "base/now_and_then.h"
#include "base/parallel.h"
#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// What a triangle adds to a Hermitian matrix of its three unknowns.
template <class Scalar>
struct TriangleTerms {
  std::array<Scalar, 3> diagonal;
  std::array<Scalar, 3> beside;  // of unknowns k and k + 1: in the row of the larger number
};

/// Calls add(f, find(f)) for one triangle after the other. Terms of many are found side by side,
/// where add takes less time. Throws Cancelled.
template <class Find, class Add>
void add_in_order(Eigen::Index n_triangles, const Find& find, const Add& add,
                  const Task& task = {}) {
  constexpr Eigen::Index at_once = 1 << 16;
  constexpr std::size_t triangle_grain = 4096;
  std::vector<decltype(find(0))> batch(std::size_t(std::min(at_once, n_triangles)));
  for (Eigen::Index first = 0; first < n_triangles; first += at_once) {
    stop_if_cancelled(task);
    const Eigen::Index count = std::min(at_once, n_triangles - first);
    parallel_for(std::size_t(count), triangle_grain, [&](std::size_t i, std::size_t end) {
      for (; i < end; ++i) batch[i] = find(static_cast<int>(first + Eigen::Index(i)));
    });
    for (Eigen::Index i = 0; i < count; ++i) add(static_cast<int>(first + i), batch[i]);
  }
}

/// Lower triangle (n x n) of the sum of terms(f) over all triangles f, whose unknowns are the rows
/// of `unknowns` (triangles x 3). Terms are computed side by side and added in the order of the
/// triangles; beyond the matrix this takes the memory of its entries off the diagonal, once. Throws
/// Cancelled.
template <class Scalar, class Terms>
Eigen::SparseMatrix<Scalar> sum_over_triangles(int n, const Eigen::Ref<const MatX3i>& unknowns,
                                               const Terms& terms, const Task& task = {}) {
  constexpr std::size_t column_grain = 1 << 15;
  Eigen::SparseMatrix<Scalar> A(n, n);
  int* begin = A.outerIndexPtr();
  std::fill(begin, begin + n + 1, 0);
  const auto pair = [&](Eigen::Index f, int k) {  // of numbers: Eigen does not refer to any here
    return std::minmax({unknowns(f, k), unknowns(f, (k + 1) % 3)});
  };
  std::vector<char> used(n, 0);
  constexpr Eigen::Index ahead = 12;  // triangles: columns are met in any order
  for (Eigen::Index f = 0; f < unknowns.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      used[unknowns(f, k)] = 1;
      const auto [column, row] = pair(f, k);
      if (column != row) ++begin[column];
    }
  int sum = 0;
  for (int j = 0; j < n; ++j) sum += std::exchange(begin[j], sum) + used[j];
  begin[n] = sum;
  A.resizeNonZeros(sum);
  int* row_of = A.innerIndexPtr();
  Scalar* value = A.valuePtr();
  std::vector<int> end(n);  // of what is there of each column
  for (int j = 0; j < n; ++j) {
    end[j] = begin[j] + used[j];  // the diagonal comes first
    if (!used[j]) continue;
    row_of[begin[j]] = j;
    value[begin[j]] = 0;
  }
  const auto add = [&](int f, const TriangleTerms<Scalar>& t) {
    for (int k = 0; k < 3; ++k) {
      if (const Eigen::Index next = f + ahead; next < unknowns.rows()) {
        const int column = unknowns(next, k);
        fetch_ahead(&value[begin[column]]);
        fetch_ahead(&row_of[end[column]]);
      }
      value[begin[unknowns(f, k)]] += t.diagonal[k];
      const auto [column, row] = pair(f, k);
      if (column == row) {
        value[begin[column]] += t.beside[k];
        continue;
      }
      row_of[end[column]] = row;
      value[end[column]++] = t.beside[k];
    }
  };
  add_in_order(unknowns.rows(), terms, add, task);
  stop_if_cancelled(task);
  // Sorts the columns and adds up what is in the same place, in the order it came.
  parallel_for(n, column_grain, [&](std::size_t j, std::size_t last) {
    for (; j < last; ++j) {
      const int start = begin[j] + used[j];
      int stop = start;  // of what is sorted
      for (int e = start; e < end[j]; ++e) {
        const int row = row_of[e];
        const Scalar term = value[e];
        int at = stop;
        while (at > start && row_of[at - 1] > row) --at;
        if (at > start && row_of[at - 1] == row) {
          value[at - 1] += term;
          continue;
        }
        std::copy_backward(row_of + at, row_of + stop, row_of + stop + 1);
        std::copy_backward(value + at, value + stop, value + stop + 1);
        row_of[at] = row;
        value[at] = term;
        ++stop;
      }
      end[j] = stop;
    }
  });
  int at = 0;
  for (int j = 0; j < n; ++j) {
    const int from = std::exchange(begin[j], at);
    std::copy(row_of + from, row_of + end[j], row_of + at);
    std::copy(value + from, value + end[j], value + at);
    at += end[j] - from;
  }
  begin[n] = at;
  A.resizeNonZeros(at);
  if (at < sum) A.data().squeeze();
  return A;
}

}  // namespace littoral
