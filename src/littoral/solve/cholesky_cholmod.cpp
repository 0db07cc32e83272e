// Cholesky through CHOLMOD's supernodal factorization.
#if LITTORAL_CHOLMOD

#include <cholmod.h>
#include <dlfcn.h>

#include <mutex>
#include <string>

#include "littoral/base/error.h"
#include "littoral/base/parallel.h"
#include "littoral/solve/cholesky.h"

namespace littoral {

namespace {

/// One thread of BLAS: results then do not depend on how many cores there are, and the many small
/// supernodes run faster. Independent factorizations run side by side instead.
void use_one_blas_thread() {
  static std::once_flag once;
  std::call_once(once, [] {
    using Setter = void (*)(int);
    if (void* symbol = dlsym(RTLD_DEFAULT, "openblas_set_num_threads"))
      reinterpret_cast<Setter>(symbol)(1);
  });
}

struct Common {
  cholmod_common c;
  Common() {
    use_one_blas_thread();
    cholmod_start(&c);
    c.supernodal = CHOLMOD_SUPERNODAL;
    c.final_ll = 1;
    c.print = 0;
    c.try_catch = 1;
    c.nmethods = 1;
    c.method[0].ordering = CHOLMOD_METIS;
    c.postorder = 1;
  }
  ~Common() { cholmod_finish(&c); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
};

template <class Scalar>
constexpr int xtype = std::is_same_v<Scalar, double> ? CHOLMOD_REAL : CHOLMOD_COMPLEX;

}  // namespace

template <class Scalar>
struct Cholesky<Scalar>::Impl {
  mutable Common common;
  cholmod_factor* factor = nullptr;
  Eigen::Index n = 0;

  explicit Impl(const Matrix& lower) : n(lower.rows()) {
    cholmod_sparse A{};
    A.nrow = A.ncol = static_cast<std::size_t>(n);
    A.nzmax = static_cast<std::size_t>(lower.nonZeros());
    A.p = const_cast<int*>(lower.outerIndexPtr());
    A.i = const_cast<int*>(lower.innerIndexPtr());
    A.x = const_cast<Scalar*>(lower.valuePtr());
    A.stype = -1;
    A.itype = CHOLMOD_INT;
    A.xtype = xtype<Scalar>;
    A.dtype = CHOLMOD_DOUBLE;
    A.sorted = A.packed = 1;
    factor = cholmod_analyze(&A, &common.c);
    if (factor) cholmod_factorize(&A, factor, &common.c);
    check(factor != nullptr);
  }
  ~Impl() { cholmod_free_factor(&factor, &common.c); }

  void check(bool ok) {
    const int status = common.c.status;
    if (ok && status >= CHOLMOD_OK && factor->minor >= factor->n) return;
    const bool memory = status == CHOLMOD_OUT_OF_MEMORY || status == CHOLMOD_TOO_LARGE;
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
  Common common;
  cholmod_dense B{};
  B.nrow = B.d = static_cast<std::size_t>(b.rows());
  B.ncol = static_cast<std::size_t>(b.cols());
  B.nzmax = B.nrow * B.ncol;
  B.x = const_cast<Scalar*>(b.data());
  B.xtype = xtype<Scalar>;
  B.dtype = CHOLMOD_DOUBLE;
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
