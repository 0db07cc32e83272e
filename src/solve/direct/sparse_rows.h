#pragma once
// Sparse matrices by rows, and products of them on several threads with the same bits for any
// number of these.

#include <vector>

#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

using SpRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// All of a symmetric matrix given by its lower triangle.
SpRows full_rows(const SpMat& lower);

/// y := A x. Throws Cancelled within 0.1 s of a request, as do the others.
void multiply(const SpRows& A, const VecX& x, VecX& y, const Task& task);

/// Rows [first, end) of it.
void multiply_rows(const SpRows& A, Eigen::Index first, Eigen::Index end, const double* x,
                   double* y);

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
