#pragma once
// Sparse matrices by rows, and products of them on several threads with the same bits for any
// number of these.

#include <functional>
#include <span>
#include <vector>

#include "base/index.h"
#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

using SpRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The same matrix, which is compressed.
SpMat copied(const SpMat& A);

/// All of a symmetric matrix given by its lower triangle.
SpRows full_rows(const SpMat& lower);

/// y := A x. Throws Cancelled within 0.1 s of a request, as do the others.
void multiply(const SpRows& A, const VecX& x, VecX& y, const Task& task);

/// Rows [first, end) of it.
void multiply_rows(const SpRows& A, Eigen::Index first, Eigen::Index end, const double* x,
                   double* y);

/// A row of a matrix while it is made; entries are in the order in which they were asked for.
class RowInMaking {
 public:
  explicit RowInMaking(Eigen::Index columns) : place_(std::size_t(columns), -1) {}

  /// The entry of a column: zero when it is asked for the first time.
  double& at(int column) {
    int& place = place_[std::size_t(column)];
    if (place < start_) {
      place = int_size(columns_);
      columns_.push_back(column);
      values_.push_back(0);
    }
    return values_[std::size_t(place)];
  }
  std::span<double> entries() { return std::span(values_).subspan(std::size_t(start_)); }

 private:
  friend SpRows made_rows(Eigen::Index, Eigen::Index, const std::function<void(int, RowInMaking&)>&,
                          const Task&);
  void reserve(std::size_t times) {  // so many times what there is
    columns_.reserve(times * columns_.size());
    values_.reserve(times * values_.size());
  }

  std::vector<int> place_;  // of columns, in the row that had them last
  std::vector<int> columns_;
  std::vector<double> values_;  // of this row and those before it
  int start_ = 0;
};

/// A matrix whose rows are made one by one, on all threads: make(i, row), row empty.
SpRows made_rows(Eigen::Index rows, Eigen::Index columns,
                 const std::function<void(int, RowInMaking&)>& make, const Task& task);

/// A B; the entries of a row are in no particular order.
SpRows product(const SpRows& A, const SpRows& B, const Task& task);

SpRows transposed(const SpRows& A);

/// The rows of symmetric matrices of one pattern, which are given by their lower triangles.
class SymmetricRows {
 public:
  explicit SymmetricRows(const SpMat& lower);

  /// b - A x.
  VecX residual(const SpMat& lower, const VecX& x, const VecX& b) const;

 private:
  std::vector<int> begin_;           // rows + 1
  std::vector<int> column_, place_;  // left of the diagonal; place among the triangle's values
};

}  // namespace littoral
