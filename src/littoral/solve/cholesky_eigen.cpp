// Cholesky through Eigen, for builds without GPL parts.
#if !LITTORAL_CHOLMOD

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <string>

#include "littoral/base/error.h"
#include "littoral/base/parallel.h"
#include "littoral/solve/cholesky.h"

namespace littoral {

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
typename Cholesky<Scalar>::Dense Cholesky<Scalar>::solve(const Dense& b) const {
  const FlushSubnormals flush;
  return impl_->factor.solve(b);
}

template <class Scalar>
double Cholesky<Scalar>::nonzeros() const {
  return static_cast<double>(impl_->factor.matrixL().nestedExpression().nonZeros());
}

template class Cholesky<double>;
template class Cholesky<Complex>;

}  // namespace littoral

#endif
