#pragma once
// Sparse matrices by rows, and products of them on several threads with the same bits for any
// number of these.

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

}  // namespace littoral
