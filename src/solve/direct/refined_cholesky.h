#pragma once
// Factors of matrices that are positive definite but for round-off, as in the last steps of an
// interior-point method.

#include <memory>
#include <optional>

#include "solve/direct/cholesky.h"

namespace littoral {

/// A Cholesky factorization whose diagonal is raised, by as little as possible, where a pivot
/// fails, and whose solutions are refined with that matrix.
class RefinedCholesky {
 public:
  /// False if raising the diagonal by 1e-7 of itself does not help.
  bool factor(SpMat lower, const std::shared_ptr<const Elimination>& structure, const Task& task);
  /// Refines until |rhs - A x| <= allowed, or as long as that helps, five times at most.
  VecX solve(const VecX& rhs, double allowed, const Task& task) const;

 private:
  SpMat lower_;
  std::optional<Cholesky<double>> factor_;
};

}  // namespace littoral
