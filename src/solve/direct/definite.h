#pragma once
// Symmetric positive definite systems solved to working accuracy, and changes to their matrices.

#include <functional>
#include <memory>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "littoral/types.h"
#include "solve/direct/cholesky.h"
#include "solve/multigrid/banded_multigrid.h"

namespace littoral {

/// A x for A given by its lower triangle.
VecX times_symmetric(const SpMat& lower, const VecX& x);

/// Adds R^T W R to the lower triangle of A, if A has an entry for every pair of unknowns that share
/// a row of R; else nothing is changed. lower: compressed.
bool add_rows_in_place(SpMat& lower, const SpMat& R, const VecX& W);

/// A + R^T W R whatever the pattern of A; lower triangles.
SpMat with_rows(const SpMat& lower, const SpMat& R, const VecX& W);

/// K with the rows and columns of the marked unknowns those of the identity. Lower triangles.
SpMat eliminated(const SpMat& K, const std::vector<char>& gone);

/// Unknowns that occur in rows of R, ascending.
std::vector<int> unknowns_of(const SpMat& R);

/// Cholesky, lifted on the diagonal if the matrix is numerically singular, and conjugate gradients
/// preconditioned by the factor on the exact matrix until the residual is down to round-off. Large
/// Laplacians by multigrid instead. Immutable; copies share the factor.
class DefiniteSystem {
 public:
  DefiniteSystem(const SpMat& lower, const Task& task);
  DefiniteSystem(SpMat&& lower, std::shared_ptr<const Elimination> structure, const Task& task,
                 bool to_be_patched = false);

  /// The system of a matrix that differs in some rows and columns only, on what the factor of this
  /// one has in common with its. This system must be one `to_be_patched`.
  DefiniteSystem patched(SpMat&& lower, const std::vector<int>& changed, const Task& task) const;

  /// No factor: a Laplacian with penalties on few unknowns, `stiff`, by BandedMultigrid, which the
  /// first solve sets up: systems that others are made from are often not solved themselves. lower:
  /// makes the matrix, which is given up afterwards.
  static DefiniteSystem by_multigrid(std::function<SpMat()> lower, std::vector<int> stiff);

  VecX solve(const VecX& b) const;
  /// The same where it may take long.
  VecX solve(const VecX& b, const Task& task, Report& report) const;
  /// One pass through the factor, for outer loops that correct each other's rounding; `solve` where
  /// the matrix had to be lifted.
  VecX solve_once(const VecX& b) const;
  /// By multigrid: x and a correction of it that leaves a few per cent of its residual, for outer
  /// loops that go on from their last x.
  VecX improved(const VecX& x, const VecX& b, const Task& task) const;
  /// One solve with the factor, or multigrid to a relative 1e-6.
  MatX approximate(const MatX& b, const Task& task) const;
  /// The same with b corrected on the way: Cholesky::solve_corrected; by multigrid a solve a round.
  VecX approximate(VecX b, const std::vector<int>& at, int rounds,
                   const Cholesky<double>::Correction& correct, const Task& task) const;
  double relative_residual(const VecX& x, const VecX& b) const;
  double nonzeros() const;  // of the factor, or of the multigrid levels there are so far
  const std::shared_ptr<const Elimination>& structure() const { return factor_->structure(); }
  /// Null with multigrid, and where the matrix had to be lifted.
  const Cholesky<double>* exact_factor() const { return lift_ == 0 ? factor_.get() : nullptr; }
  const SpMat& lower() const { return *A_; }  // with a factor
  bool can_be_patched() const { return patchable_; }
  bool iterates() const { return multigrid_ != nullptr; }

 private:
  DefiniteSystem() = default;
  void factor(const Task& task, const std::shared_ptr<const Elimination>& structure,
              bool to_be_patched);
  VecX residual(const VecX& x, const VecX& b, const Task& task) const;

  std::shared_ptr<const SpMat> A_;                  // none with multigrid, which has its own
  std::shared_ptr<const Cholesky<double>> factor_;  // one of the two
  struct LazyMultigrid;
  std::shared_ptr<LazyMultigrid> multigrid_;
  double lift_ = 0;
  bool patchable_ = false;
};

}  // namespace littoral
