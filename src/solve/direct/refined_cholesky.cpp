#include <utility>

#include "base/index.h"
#include "littoral/error.h"
#include "solve/direct/cholesky.h"

namespace littoral {

RefinedCholesky::RefinedCholesky(const SpMat& pattern, std::shared_ptr<const Elimination> structure)
    : lower_(pattern), rows_(pattern), structure_(std::move(structure)) {}

bool RefinedCholesky::factor(const Task& task) {
  double lift = 0;
  for (int attempt = 0; attempt < 5; ++attempt) {
    try {
      factor_.emplace(lower_, structure_, task);
      return true;
    } catch (const SolveError&) {  // not positive definite to working precision
    }
    const double next = lift == 0 ? 1e-13 : 100 * lift;
    for (int j = 0; j < lower_.cols(); ++j)
      lower_.valuePtr()[lower_.outerIndexPtr()[j]] *= (1 + next) / (1 + lift);
    lift = next;
  }
  return false;
}

VecX RefinedCholesky::solve(const VecX& rhs, double allowed, const Task& task) const {
  VecX x = factor_->solve(rhs);
  double last = infinity;
  for (int k = 0; k < 5; ++k) {
    task.checkpoint();
    const VecX residual = rows_.residual(lower_, x, rhs);
    const double size = residual.norm();
    if (size <= allowed || size > 0.5 * last) break;
    last = size;
    x += factor_->solve(residual);
  }
  return x;
}

}  // namespace littoral
