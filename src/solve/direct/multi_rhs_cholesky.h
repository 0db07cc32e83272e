#pragma once
// Many right-hand sides at once, sixteen side by side: every number of a sparse matrix or factor is
// read once for all of them, and goes to vectors as wide as registers.

#include <vector>

#include "littoral/types.h"
#include "solve/direct/elimination.h"
#include "solve/direct/sparse_rows.h"

namespace littoral {

constexpr Eigen::Index strip_width = 16;

/// A strip of sixteen right-hand sides, row by row.
template <class Number>
using StripOf = Eigen::Matrix<Number, Eigen::Dynamic, strip_width, Eigen::RowMajor>;
using Strip = StripOf<double>;

/// A factorization L L^T of a symmetric positive definite matrix, column by column: for matrices so
/// small that the many solves with them count, not the factorization. Immutable.
class MultiRhsCholesky {
 public:
  /// lower: lower triangle, with the pattern that the structure was made from. Throws SolveError if
  /// the matrix is not positive definite to working precision.
  MultiRhsCholesky(const SpMat& lower, const Elimination& structure);

  /// x := A^-1 x.
  void solve(Strip& x) const;

 private:
  std::vector<int> pivot_;          // unknowns in the order of elimination
  std::vector<std::size_t> begin_;  // columns + 1, into what follows
  std::vector<int> row_;            // unknowns below the diagonal
  std::vector<double> value_;       // of L there
  std::vector<double> inverse_;     // columns: 1 / the diagonal of L
};

}  // namespace littoral
