#pragma once
// Sparse Cholesky for many matrices of one pattern: ordered and analysed once, factored often.

#include <memory>

#include "littoral/base/task.h"
#include "littoral/base/types.h"

namespace littoral {

/// The symbolic factorization of all symmetric matrices with one pattern; immutable, copies share
/// it. CHOLMOD's supernodal code where the build has it, Eigen's simplicial one otherwise.
class CholeskyPattern {
 public:
  /// Orders and analyses the lower triangle's pattern (values are ignored). Throws SolveError if
  /// memory runs out, Cancelled within 0.05 s of a request.
  CholeskyPattern(std::shared_ptr<const SpMat> lower, const Task& task);

  double nonzeros() const;  // of the factor

 private:
  friend class CholeskyOfPattern;
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// Factors of matrices of one pattern, one after the other. Not for several threads at once.
class CholeskyOfPattern {
 public:
  explicit CholeskyOfPattern(const CholeskyPattern& pattern);

  /// Factors; `lower` has the pattern. False if it is not positive definite to working precision;
  /// throws SolveError if memory runs out, Cancelled within 0.05 s of a request.
  bool factor(std::shared_ptr<const SpMat> lower, const Task& task);

  /// Solves with the last factor.
  VecX solve(const VecX& b) const;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace littoral
