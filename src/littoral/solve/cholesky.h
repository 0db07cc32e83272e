#pragma once
// Sparse Cholesky factorization of symmetric (Hermitian) positive definite matrices.

#include <memory>

#include "littoral/base/task.h"
#include "littoral/base/types.h"

namespace littoral {

template <class Scalar>
class Cholesky;

/// Ordering and pattern of a factor, shared by the factorizations of matrices of one pattern.
/// Immutable; copies share it.
template <class Scalar>
class CholeskyPattern {
 public:
  /// Analyses the pattern of a lower triangle. Throws SolveError where memory runs out, Cancelled.
  CholeskyPattern(std::shared_ptr<const Eigen::SparseMatrix<Scalar>> lower, const Task& task);

 private:
  friend class Cholesky<Scalar>;
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// A factorization A = L L^* of a matrix given by its lower triangle. CHOLMOD's supernodal code
/// where the build has it, Eigen's simplicial one otherwise. Immutable; copies share the factor;
/// `solve` may be called from several threads.
template <class Scalar>
class Cholesky {
 public:
  using Matrix = Eigen::SparseMatrix<Scalar>;
  using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  /// Factors. Throws SolveError if the matrix is not positive definite to working precision or
  /// memory runs out, Cancelled within 0.05 s of a request.
  Cholesky(std::shared_ptr<const Matrix> lower, const Task& task);

  /// The same with the analysis of a matrix of exactly this pattern.
  Cholesky(std::shared_ptr<const Matrix> lower, const CholeskyPattern<Scalar>& pattern,
           const Task& task);

  /// Solves A x = b for each column of b.
  Dense solve(const Dense& b) const;

  double nonzeros() const;  // of the factor

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

extern template class CholeskyPattern<double>;
extern template class CholeskyPattern<Complex>;
extern template class Cholesky<double>;
extern template class Cholesky<Complex>;

}  // namespace littoral
