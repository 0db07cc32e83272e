// Repeated Cholesky of one pattern through Eigen, for builds without GPL parts.
#if !LITTORAL_CHOLMOD

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <string>

#include "littoral/base/error.h"
#include "littoral/base/parallel.h"
#include "littoral/solve/cholesky_pattern.h"

namespace littoral {

namespace {

using Permutation = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;

/// P A P^T, lower triangle.
SpMat permuted(const SpMat& lower, const Permutation& P) {
  SpMat B(lower.rows(), lower.cols());
  B.selfadjointView<Eigen::Lower>() = lower.selfadjointView<Eigen::Lower>().twistedBy(P);
  return B;
}

using Factor = Eigen::SimplicialLLT<SpMat, Eigen::Lower, Eigen::NaturalOrdering<int>>;

void without_memory_errors(Eigen::Index n, const std::function<void()>& call) {
  try {
    call();
  } catch (const std::bad_alloc&) {
    throw SolveError("not enough memory to factor a matrix of order " + std::to_string(n));
  }
}

}  // namespace

struct CholeskyPattern::Impl {
  Permutation P;
  double nonzeros = 0;

  explicit Impl(const SpMat& lower) {
    Permutation inverse;
    Eigen::AMDOrdering<int>()(lower.selfadjointView<Eigen::Lower>(), inverse);
    P = inverse.inverse();
    Factor symbolic;
    symbolic.analyzePattern(permuted(lower, P));
    nonzeros = static_cast<double>(symbolic.matrixL().nestedExpression().nonZeros());
  }
};

CholeskyPattern::CholeskyPattern(std::shared_ptr<const SpMat> lower, const Task& task) {
  auto made = std::make_shared<std::shared_ptr<const Impl>>();
  run_abandonable(task, [made, lower] {
    without_memory_errors(lower->rows(), [&] { *made = std::make_shared<const Impl>(*lower); });
  });
  impl_ = *made;
}

double CholeskyPattern::nonzeros() const { return impl_->nonzeros; }

struct CholeskyOfPattern::Impl {
  std::shared_ptr<const CholeskyPattern::Impl> pattern;
  Factor factor;
  bool analysed = false;
};

CholeskyOfPattern::CholeskyOfPattern(const CholeskyPattern& pattern)
    : impl_(std::make_shared<Impl>()) {
  impl_->pattern = pattern.impl_;
}

bool CholeskyOfPattern::factor(std::shared_ptr<const SpMat> lower, const Task& task) {
  run_abandonable(task, [impl = impl_, lower] {
    without_memory_errors(lower->rows(), [&] {
      const SpMat A = permuted(*lower, impl->pattern->P);
      if (!impl->analysed) impl->factor.analyzePattern(A);
      impl->analysed = true;
      impl->factor.factorize(A);
    });
  });
  return impl_->factor.info() == Eigen::Success;
}

VecX CholeskyOfPattern::solve(const VecX& b) const {
  const FlushSubnormals flush;
  const Permutation& P = impl_->pattern->P;
  return P.transpose() * impl_->factor.solve(VecX(P * b));
}

}  // namespace littoral

#endif
