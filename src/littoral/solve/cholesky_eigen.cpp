// Cholesky through Eigen, for builds without GPL parts.
#if !LITTORAL_CHOLMOD

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <string>

#include "littoral/base/error.h"
#include "littoral/base/parallel.h"
#include "littoral/solve/cholesky.h"

namespace littoral {

/// Eigen's simplicial code keeps ordering and pattern together with the numbers, and its analysis
/// is cheap beside its factorization: nothing is shared.
template <class Scalar>
struct CholeskyPattern<Scalar>::Impl {};

template <class Scalar>
CholeskyPattern<Scalar>::CholeskyPattern(std::shared_ptr<const Eigen::SparseMatrix<Scalar>>,
                                         const Task& task) {
  task.checkpoint();
}

template <class Scalar>
struct Cholesky<Scalar>::Impl {
  Eigen::SimplicialLLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>> factor;

  explicit Impl(const Matrix& lower) : factor(lower) {
    if (factor.info() != Eigen::Success) throw SolveError("the matrix is not positive definite");
  }
};

template <class Scalar>
Cholesky<Scalar>::Cholesky(std::shared_ptr<const Matrix> lower, const Task& task) {
  auto made = std::make_shared<std::shared_ptr<const Impl>>();
  run_abandonable(task, [made, lower] {
    try {
      *made = std::make_shared<const Impl>(*lower);
    } catch (const std::bad_alloc&) {
      throw SolveError("not enough memory to factor a matrix of order " +
                       std::to_string(lower->rows()));
    }
  });
  impl_ = *made;
}

template <class Scalar>
Cholesky<Scalar>::Cholesky(std::shared_ptr<const Matrix> lower, const CholeskyPattern<Scalar>&,
                           const Task& task)
    : Cholesky(std::move(lower), task) {}

template <class Scalar>
typename Cholesky<Scalar>::Dense Cholesky<Scalar>::solve(const Dense& b) const {
  const FlushSubnormals flush;
  return impl_->factor.solve(b);
}

template <class Scalar>
double Cholesky<Scalar>::nonzeros() const {
  return static_cast<double>(impl_->factor.matrixL().nestedExpression().nonZeros());
}

template class CholeskyPattern<double>;
template class CholeskyPattern<Complex>;
template class Cholesky<double>;
template class Cholesky<Complex>;

}  // namespace littoral

#endif
