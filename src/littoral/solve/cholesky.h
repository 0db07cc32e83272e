#pragma once
// Sparse Cholesky factorization of symmetric (Hermitian) positive definite matrices.

#include <memory>

#include "littoral/base/task.h"
#include "littoral/base/types.h"

namespace littoral {

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

  /// Solves A x = b for each column of b.
  Dense solve(const Dense& b) const;

  double nonzeros() const;  // of the factor

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

extern template class Cholesky<double>;
extern template class Cholesky<Complex>;

}  // namespace littoral
