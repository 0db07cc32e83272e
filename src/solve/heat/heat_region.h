#pragma once
// A connected part of a window of heat: what is known of it before its right-hand side is.

#include <vector>

#include "base/task.h"
#include "littoral/types.h"
#include "solve/direct/hermitian_rows.h"

namespace littoral {

/// Some blocks of a matrix of heat, to be solved for. Not moved, as Eigen 3.4 copies K then.
template <class Scalar>
struct HeatRegion {
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  /// own_blocks: in the order of elimination. local: per block of A -1, which it is again
  /// afterwards. Throws Cancelled.
  HeatRegion(const HermitianRows<Scalar>& A, std::vector<int> own_blocks, std::vector<int>& local,
             const Task& task);
  HeatRegion(const HeatRegion&) = delete;
  HeatRegion& operator=(const HeatRegion&) = delete;

  /// Solves for r (own blocks) and what follows from x (all blocks) at known ones beside these.
  /// Throws SolveError where the matrix is not positive definite, Cancelled.
  Vector solve(const HermitianRows<Scalar>& A, const std::vector<char>& known, const Vector& x,
               Vector r, const Task& task) const;

  std::vector<int> blocks;
  std::vector<char> at_border;    // blocks with neighbours elsewhere
  Eigen::SparseMatrix<Scalar> K;  // lower triangle
};

extern template struct HeatRegion<double>;
extern template struct HeatRegion<Complex>;

}  // namespace littoral
