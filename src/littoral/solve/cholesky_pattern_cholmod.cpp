// Repeated Cholesky of one pattern through CHOLMOD's supernodal factorization.
#if LITTORAL_CHOLMOD

#include <string>

#include "littoral/base/error.h"
#include "littoral/base/parallel.h"
#include "littoral/solve/cholesky_pattern.h"
#include "littoral/solve/cholmod_common.h"

namespace littoral {

namespace {

[[noreturn]] void throw_no_memory(Eigen::Index n) {
  throw SolveError("not enough memory to factor a matrix of order " + std::to_string(n));
}

}  // namespace

struct CholeskyPattern::Impl {
  mutable CholmodCommon common;
  cholmod_factor* factor = nullptr;

  explicit Impl(const SpMat& lower) {
    cholmod_sparse A = cholmod_lower(lower);
    factor = cholmod_analyze(&A, &common.c);
    if (!factor) throw_no_memory(lower.rows());
  }
  ~Impl() { cholmod_free_factor(&factor, &common.c); }
};

CholeskyPattern::CholeskyPattern(std::shared_ptr<const SpMat> lower, const Task& task) {
  auto made = std::make_shared<std::shared_ptr<const Impl>>();
  run_abandonable(task, [made, lower] { *made = std::make_shared<const Impl>(*lower); });
  impl_ = *made;
}

double CholeskyPattern::nonzeros() const { return static_cast<double>(impl_->factor->xsize); }

struct CholeskyOfPattern::Impl {
  mutable CholmodCommon common;
  cholmod_factor* factor = nullptr;
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;  // workspace of solves

  explicit Impl(const CholeskyPattern::Impl& pattern) {
    factor = cholmod_copy_factor(pattern.factor, &common.c);
    if (!factor) throw_no_memory(static_cast<Eigen::Index>(pattern.factor->n));
  }
  ~Impl() {
    cholmod_free_dense(&x, &common.c);
    cholmod_free_dense(&y, &common.c);
    cholmod_free_dense(&e, &common.c);
    cholmod_free_factor(&factor, &common.c);
  }
};

CholeskyOfPattern::CholeskyOfPattern(const CholeskyPattern& pattern)
    : impl_(std::make_shared<Impl>(*pattern.impl_)) {}

bool CholeskyOfPattern::factor(std::shared_ptr<const SpMat> lower, const Task& task) {
  run_abandonable(task, [impl = impl_, lower] {
    cholmod_sparse A = cholmod_lower(*lower);
    cholmod_factorize(&A, impl->factor, &impl->common.c);
  });
  if (impl_->common.out_of_memory()) throw_no_memory(lower->rows());
  return impl_->common.c.status >= CHOLMOD_OK && impl_->factor->minor >= impl_->factor->n;
}

VecX CholeskyOfPattern::solve(const VecX& b) const {
  const FlushSubnormals flush;
  cholmod_dense B = cholmod_columns(b);
  Impl& s = *impl_;
  if (!cholmod_solve2(CHOLMOD_A, s.factor, &B, nullptr, &s.x, nullptr, &s.y, &s.e, &s.common.c))
    throw SolveError("not enough memory to solve");
  return Eigen::Map<const VecX>(static_cast<const double*>(s.x->x), b.size());
}

}  // namespace littoral

#endif
