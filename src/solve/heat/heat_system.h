#pragma once
// (M + t L) x = b for small t, right however fast x decays.

#include <memory>
#include <optional>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "solve/direct/cholesky.h"
#include "solve/heat/heat_windows.h"
#include "solve/heat/scaled_field.h"
#include "solve/poisson/poisson.h"

namespace littoral {

/// What a system is built for: many solves are worth a large factorization, one is not.
enum class SolveHint { single_rhs, many_rhs };

inline PoissonSolver solver_for(SolveHint hint) {
  return hint == SolveHint::single_rhs ? PoissonSolver::automatic_for_one_solve
                                       : PoissonSolver::automatic;
}

/// Entries of a solution below this share of the largest belong to its next layer.
inline constexpr double heat_front = 1e-250;

/// Unknowns of a HeatSystem beyond which the size of a factor is not even asked for.
Eigen::Index largest_to_factor(SolveHint hint);

/// A positive definite matrix whose inverse decays exponentially; immutable.
template <class Scalar>
class HeatSystem {
 public:
  using Matrix = Eigen::SparseMatrix<Scalar>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  /// lower: the matrix's lower triangle; unknowns come in blocks of `block` (a real matrix of
  /// complex unknowns has 2). M: blocks; must outlive this. order: of elimination, of the blocks;
  /// found here if empty. One factorization is made if it takes less than 4 GB for many
  /// solves, .4 GB for one. structure: of the factor in this order, if it is known.
  HeatSystem(std::shared_ptr<const Matrix> lower, int block, const VecX& M, SolveHint hint,
             const Task& task, Ordering order = {},
             std::shared_ptr<const Elimination> structure = nullptr);
  /// A matrix too large to be factored, which is never made as a whole unless windows do not fit.
  HeatSystem(std::shared_ptr<const HermitianRows<Scalar>> rows, const VecX& M,
             const Ordering& order);

  /// Solves by HeatWindows or, on one factorization, by renormalised passes: the first solve is
  /// good to 1e-250 of its largest entry; the rest is solved again from the residual that
  /// truncating there leaves, which lives next to the front, scaled to 1; and so on. `piece` names
  /// the block's connected piece; each piece of b is scaled to largest entry 1 first, as pieces do
  /// not interact.
  ScaledField<Scalar> solve(HeatSource<Scalar> b, const std::vector<int>& piece, const Task& task,
                            Report& report) const;
  ScaledField<Scalar> solve(const Eigen::Ref<const Vector>& b, const std::vector<int>& piece,
                            const Task& task, Report& report) const {
    return solve(nonzero_blocks(b, block_), piece, task, report);
  }

  /// The same with x prescribed as `values` on the blocks where that is not zero, and b = 0
  /// elsewhere.
  ScaledField<Scalar> solve_prescribed(const Vector& values, const std::vector<int>& piece,
                                       const Task& task, Report& report) const;

  double nonzeros() const { return factor_ ? factor_->nonzeros() : 0; }  // 0 without a factor
  /// Null where there is none.
  const Cholesky<Scalar>* factor() const { return factor_ ? &*factor_ : nullptr; }
  const Matrix& lower() const { return *A_; }  // with a factor

 private:
  std::shared_ptr<const Elimination> eliminated(const Matrix& A, const Task& task) const;
  ScaledField<Scalar> solve_in_passes(const Matrix& A, const Cholesky<Scalar>& factor, Vector r,
                                      const std::vector<int>& piece, const Task& task,
                                      Report& report) const;

  std::shared_ptr<const Matrix> A_;  // lower triangle; null where only rows are given
  std::shared_ptr<const HermitianRows<Scalar>> rows_;
  int block_;
  HeatWindows<Scalar> windows_;
  std::shared_ptr<const Elimination> structure_;  // null where it is not known
  std::optional<Cholesky<Scalar>> factor_;
};

extern template class HeatSystem<double>;
extern template class HeatSystem<Complex>;

}  // namespace littoral
