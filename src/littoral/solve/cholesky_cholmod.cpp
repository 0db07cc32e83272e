// Cholesky through CHOLMOD's supernodal factorization.
#if LITTORAL_CHOLMOD

#include <string>

#include "littoral/base/error.h"
#include "littoral/base/parallel.h"
#include "littoral/solve/cholesky.h"
#include "littoral/solve/cholmod_common.h"

namespace littoral {

template <class Scalar>
struct Cholesky<Scalar>::Impl {
  mutable CholmodCommon common;
  cholmod_factor* factor = nullptr;
  Eigen::Index n = 0;

  explicit Impl(const Matrix& lower) : n(lower.rows()) {
    cholmod_sparse A = cholmod_lower(lower);
    factor = cholmod_analyze(&A, &common.c);
    if (factor) cholmod_factorize(&A, factor, &common.c);
    check(factor != nullptr);
  }
  ~Impl() { cholmod_free_factor(&factor, &common.c); }

  void check(bool ok) {
    if (ok && common.c.status >= CHOLMOD_OK && factor->minor >= factor->n) return;
    const bool memory = common.out_of_memory();
    const std::string at = factor ? std::to_string(factor->minor) : "0";
    cholmod_free_factor(&factor, &common.c);
    if (memory)
      throw SolveError("not enough memory to factor a matrix of order " + std::to_string(n));
    throw SolveError("the matrix is not positive definite (column " + at + ")");
  }
};

template <class Scalar>
Cholesky<Scalar>::Cholesky(std::shared_ptr<const Matrix> lower, const Task& task) {
  auto made = std::make_shared<std::shared_ptr<const Impl>>();
  run_abandonable(task, [made, lower] { *made = std::make_shared<const Impl>(*lower); });
  impl_ = *made;
}

template <class Scalar>
typename Cholesky<Scalar>::Dense Cholesky<Scalar>::solve(const Dense& b) const {
  const FlushSubnormals flush;
  CholmodCommon common;
  cholmod_dense B = cholmod_columns(b);
  cholmod_dense* X = cholmod_solve(CHOLMOD_A, impl_->factor, &B, &common.c);
  if (!X) throw SolveError("not enough memory to solve");
  Dense x = Eigen::Map<Dense>(static_cast<Scalar*>(X->x), b.rows(), b.cols());
  cholmod_free_dense(&X, &common.c);
  return x;
}

template <class Scalar>
double Cholesky<Scalar>::nonzeros() const {
  return static_cast<double>(impl_->factor->xsize);
}

template class Cholesky<double>;
template class Cholesky<Complex>;

}  // namespace littoral

#endif
