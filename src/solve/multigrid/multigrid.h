#pragma once
// Smoothed aggregation multigrid (Vanek, Mandel, Brezina 1996), as a preconditioner.

#include <deque>
#include <memory>
#include <vector>

#include "base/movable.h"
#include "base/task.h"
#include "littoral/types.h"
#include "solve/direct/cholesky.h"
#include "solve/direct/sparse_rows.h"

namespace littoral {

/// A hierarchy of coarser and coarser matrices for a symmetric positive definite matrix whose
/// smooth vectors are nearly constant, as Laplacians' are. Memory and time per cycle grow like the
/// number of unknowns. Immutable; the same bits for any number of threads.
class Multigrid {
 public:
  /// lower: lower triangle, given up once it is read. Throws Cancelled within 0.2 s of a request.
  Multigrid(SpMat&& lower, const Task& task);

  /// Vectors that cycles use again and again; of one solve.
  struct Work {
    struct OfLevel {
      VecX b, x, r, d;
    };
    std::vector<OfLevel> levels;
  };

  /// One symmetric V-cycle from zero: x becomes a positive definite approximation of A^-1 b.
  void cycle(const VecX& b, VecX& x, Work& work, const Task& task) const;

  const SpRows& matrix() const { return levels_.front().A; }
  double nonzeros() const;  // of all levels' matrices, prolongations and the coarsest factor

 private:
  struct Level {
    Movable<SpRows> A;
    VecX inverse_size = {};          // 1 / sum_j |A_ij|: A scaled by it has eigenvalues in (0, 1]
    Movable<SpRows> P = {}, R = {};  // prolongation from the next level and its transpose
  };

  void cycle_at(std::size_t level, const VecX& b, VecX& x, Work& work, const Task& task) const;

  std::deque<Level> levels_;  // the last one is factored; a vector would copy them as it grows
  std::shared_ptr<const Cholesky<double>> coarsest_;
};

/// The factor of a matrix or, where that is numerically singular, of one lifted on the diagonal.
std::shared_ptr<const Cholesky<double>> factor_for_preconditioning(SpMat lower, const Task& task);

/// Piecewise constant functions on groups of strongly coupled unknowns (-A_ij > strength
/// sqrt(A_ii A_jj)), smoothed by a step of damped Jacobi on the strong couplings: unknowns x
/// groups. Rows of unknowns that are coupled to nothing are empty.
SpRows smoothed_aggregation(const SpRows& A, double strength, const Task& task);

}  // namespace littoral
