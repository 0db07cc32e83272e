#include "solve/direct/definite.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "base/taken.h"
#include "littoral/error.h"

namespace littoral {

namespace {
constexpr double rough = 1e-6;  // of solves whose errors an outer loop corrects
}

VecX times_symmetric(const SpMat& lower, const VecX& x) {
  return lower.selfadjointView<Eigen::Lower>() * x;
}

bool add_rows_in_place(SpMat& lower, const SpMat& R, const VecX& W) {
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  const Rows rows = R;
  std::vector<std::pair<int, double>> added;  // place among the entries, what is added there
  for (int r = 0; r < rows.outerSize(); ++r) {
    for (Rows::InnerIterator a(rows, r); a; ++a) {
      const auto column = a.col();
      const int* begin = lower.innerIndexPtr() + lower.outerIndexPtr()[column];
      const int* end = lower.innerIndexPtr() + lower.outerIndexPtr()[column + 1];
      for (Rows::InnerIterator b(rows, r); b; ++b) {
        if (b.col() < column) continue;
        const int* at = std::lower_bound(begin, end, static_cast<int>(b.col()));
        if (at == end || *at != b.col()) return false;
        added.emplace_back(static_cast<int>(at - lower.innerIndexPtr()),
                           W[r] * a.value() * b.value());
      }
    }
  }
  for (const auto& [at, value] : added) lower.valuePtr()[at] += value;
  return true;
}

SpMat with_rows(const SpMat& lower, const SpMat& R, const VecX& W) {
  const SpMat WR = W.asDiagonal() * R;
  const SpMat P = SpMat(R.transpose()) * WR;
  SpMat K = lower + SpMat(P.triangularView<Eigen::Lower>());
  K.makeCompressed();
  return K;
}

SpMat eliminated(const SpMat& K, const std::vector<char>& gone) {
  SpMat P(K.rows(), K.cols());
  P.reserve(K.nonZeros() + K.cols());
  for (int j = 0; j < K.outerSize(); ++j) {
    P.startVec(j);
    if (gone[j]) {
      P.insertBack(j, j) = 1;
      continue;
    }
    for (SpMat::InnerIterator it(K, j); it; ++it)
      if (!gone[it.row()]) P.insertBack(it.row(), j) = it.value();
  }
  P.finalize();
  return P;
}

std::vector<int> unknowns_of(const SpMat& R) {
  std::vector<int> out;
  for (int j = 0; j < R.outerSize(); ++j)
    if (SpMat::InnerIterator(R, j)) out.push_back(j);
  return out;
}

DefiniteSystem::DefiniteSystem(const SpMat& lower, const Task& task)
    : DefiniteSystem(SpMat(lower),
                     std::make_shared<const Elimination>(lower, dissection(lower, task), task),
                     task) {}

DefiniteSystem::DefiniteSystem(SpMat&& lower, std::shared_ptr<const Elimination> structure,
                               const Task& task, bool to_be_patched)
    : A_(shared_taken(lower)) {
  factor(task, structure, to_be_patched);
}

void DefiniteSystem::factor(const Task& task, const std::shared_ptr<const Elimination>& structure,
                            bool to_be_patched) {
  RaisedCholesky<double> made = raised_cholesky(*A_, structure, task, to_be_patched);
  factor_ = std::make_shared<const Cholesky<double>>(std::move(made.factor));
  lift_ = made.raised;
  patchable_ = to_be_patched && lift_ == 0;
}

DefiniteSystem DefiniteSystem::patched(SpMat&& lower, const std::vector<int>& changed,
                                       const Task& task) const {
  DefiniteSystem out;
  out.A_ = shared_taken(lower);
  try {
    out.factor_ =
        std::make_shared<const Cholesky<double>>(factor_->patched(*out.A_, changed, task));
  } catch (const SolveError&) {
    out.factor(task, factor_->structure(), false);
  }
  return out;
}

struct DefiniteSystem::LazyMultigrid {
  LazyMultigrid(std::function<SpMat()> matrix, std::vector<int> stiff_unknowns)
      : lower(std::move(matrix)), stiff(std::move(stiff_unknowns)) {}

  const BandedMultigrid& get(const Task& task) {
    const std::lock_guard lock(mutex);
    if (!multigrid) {
      multigrid.emplace(lower(), stiff, task);
      lower = nullptr;
    }
    return *multigrid;
  }

  std::mutex mutex;
  std::function<SpMat()> lower;
  const std::vector<int> stiff;
  std::optional<BandedMultigrid> multigrid;
};

double DefiniteSystem::nonzeros() const {
  if (factor_) return factor_->nonzeros();
  const std::lock_guard lock(multigrid_->mutex);
  return multigrid_->multigrid ? multigrid_->multigrid->nonzeros() : 0;
}

DefiniteSystem DefiniteSystem::by_multigrid(std::function<SpMat()> lower, std::vector<int> stiff) {
  DefiniteSystem out;
  out.multigrid_ = std::make_shared<LazyMultigrid>(std::move(lower), std::move(stiff));
  return out;
}

MatX DefiniteSystem::approximate(const MatX& b, const Task& task) const {
  if (factor_) return factor_->solve(b);
  MatX x(b.rows(), b.cols());
  Report each;
  for (Eigen::Index k = 0; k < b.cols(); ++k)
    x.col(k) = multigrid_->get(task).solve(b.col(k), rough, task, each);
  return x;
}

VecX DefiniteSystem::approximate(VecX b, const std::vector<int>& at, int rounds,
                                 const Cholesky<double>::Correction& correct,
                                 const Task& task) const {
  if (factor_) return factor_->solve_corrected(b, at, rounds, correct);
  const BandedMultigrid& multigrid = multigrid_->get(task);
  Report each;
  VecX x = multigrid.solve(std::move(b), rough, task, each);
  for (int round = 0; round < rounds; ++round) {
    VecX more = VecX::Zero(x.size());
    more(at) = correct(x(at));
    x += multigrid.solve(std::move(more), rough, task, each);
  }
  return x;
}

VecX DefiniteSystem::improved(const VecX& x, const VecX& b, const Task& task) const {
  constexpr double left = 0.03;  // in the energy norm
  Report unread;
  return x + multigrid_->get(task).solve(residual(x, b, task), left, task, unread);
}

VecX DefiniteSystem::residual(const VecX& x, const VecX& b, const Task& task) const {
  if (!multigrid_) return b - times_symmetric(*A_, x);
  VecX r;
  multiply(multigrid_->get(task).matrix(), x, r, task);
  return b - r;
}

double DefiniteSystem::relative_residual(const VecX& x, const VecX& b) const {
  const double scale = b.norm();
  return scale > 0 ? residual(x, b, {}).norm() / scale : x.norm();
}

VecX DefiniteSystem::solve(const VecX& b) const {
  Report unread;
  return solve(b, {}, unread);
}

VecX DefiniteSystem::solve(const VecX& b, const Task& task, Report& report) const {
  if (multigrid_) return multigrid_->get(task).solve(b, 1e-11, task, report);
  // One step of conjugate gradients is iterative refinement.
  constexpr int max_steps = 60;
  constexpr double enough = 1e-14;
  VecX x = VecX::Zero(b.size()), best = x, r = b, p;
  const double scale = b.norm(), size = A_->size() ? A_->diagonal().maxCoeff() : 0;
  if (!(scale > 0)) return x;
  double best_norm = scale, rz = 0;
  for (int step = 0; step < max_steps; ++step) {
    const VecX z = factor_->solve(r);
    const double rz_new = r.dot(z);
    p = step == 0 ? z : VecX(z + (rz_new / rz) * p);
    rz = rz_new;
    const VecX Ap = times_symmetric(*A_, p);
    const double curvature = p.dot(Ap);
    if (!(curvature > 0)) break;
    x += (rz / curvature) * p;
    r = b - times_symmetric(*A_, x);
    const double norm = r.norm();
    if (!(norm < best_norm)) break;
    const bool stalled = lift_ == 0 && norm > 0.1 * best_norm;
    best = x;
    best_norm = norm;
    if (norm <= enough * (scale + size * x.norm()) || stalled) break;
  }
  if (!best.allFinite()) throw SolveError("the solution of a linear system is not finite");
  return best;
}

VecX DefiniteSystem::solve_once(const VecX& b) const {
  if (lift_ > 0 || !factor_) return solve(b);
  VecX x = factor_->solve(b);
  if (!x.allFinite()) throw SolveError("the solution of a linear system is not finite");
  return x;
}

}  // namespace littoral
