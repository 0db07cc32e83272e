#include "littoral/solve/poisson.h"

#include <algorithm>
#include <cmath>

#include "littoral/base/error.h"

namespace littoral {

namespace {

VecX times(const SpMat& lower, const VecX& x) { return lower.selfadjointView<Eigen::Lower>() * x; }

/// The lower triangle of L + A^T W A.
SpMat with_penalty(const SpMat& L, const SpMat& A, const VecX& weight) {
  const SpMat WA = weight.asDiagonal() * A;
  const SpMat P = SpMat(A.transpose()) * WA;
  SpMat K = L;
  K += SpMat(P.triangularView<Eigen::Lower>());
  K.makeCompressed();
  return K;
}

double mean_diagonal(const SpMat& L) {
  const VecX d = L.diagonal();
  const double n = static_cast<double>((d.array() > 0).count());
  return n > 0 ? d.sum() / n : 1;
}

}  // namespace

DefiniteSystem::DefiniteSystem(SpMat lower, const Task& task)
    : A_(std::make_shared<const SpMat>(std::move(lower))) {
  for (double lift : {0.0, 1e-14, 1e-12, 1e-10, 1e-8}) {
    auto K = A_;
    if (lift > 0) {
      auto lifted = std::make_shared<SpMat>(*A_);
      lifted->diagonal() *= 1 + lift;
      K = lifted;
    }
    lift_ = lift;
    try {
      factor_ = std::make_shared<const Cholesky<double>>(K, task);
      return;
    } catch (const SolveError&) {
      if (lift == 1e-8) throw;
    }
  }
}

double DefiniteSystem::relative_residual(const VecX& x, const VecX& b) const {
  const double scale = b.norm();
  return scale > 0 ? (b - times(*A_, x)).norm() / scale : x.norm();
}

VecX DefiniteSystem::solve(const VecX& b) const {
  // Conjugate gradients preconditioned by the factor: one step is iterative refinement.
  constexpr int max_steps = 60;
  constexpr double enough = 1e-14;
  VecX x = VecX::Zero(b.size()), best = x, r = b, p;
  const double scale = b.norm();
  if (!(scale > 0)) return x;
  double best_norm = scale, rz = 0;
  for (int step = 0; step < max_steps; ++step) {
    const VecX z = factor_->solve(r);
    const double rz_new = r.dot(z);
    p = step == 0 ? z : VecX(z + (rz_new / rz) * p);
    rz = rz_new;
    const VecX Ap = times(*A_, p);
    const double curvature = p.dot(Ap);
    if (!(curvature > 0)) break;
    x += (rz / curvature) * p;
    r = b - times(*A_, x);
    const double norm = r.norm();
    if (!(norm < best_norm)) break;
    const bool stalled = lift_ == 0 && norm > 0.1 * best_norm;
    best = x;
    best_norm = norm;
    if (norm <= enough * scale || stalled) break;
  }
  if (!best.allFinite()) throw SolveError("the solution of a linear system is not finite");
  return best;
}

VecX DefiniteSystem::solve_once(const VecX& b) const {
  if (lift_ > 0) return solve(b);
  VecX x = factor_->solve(b);
  if (!x.allFinite()) throw SolveError("the solution of a linear system is not finite");
  return x;
}

SpMat eliminated(const SpMat& K, const std::vector<char>& gone) {
  SpMat P(K.rows(), K.cols());
  Triplets entries;
  entries.reserve(static_cast<std::size_t>(K.nonZeros()));
  for (int j = 0; j < K.outerSize(); ++j) {
    if (gone[j]) {
      entries.emplace_back(j, j, 1);
      continue;
    }
    for (SpMat::InnerIterator it(K, j); it; ++it)
      if (!gone[it.row()]) entries.emplace_back(it.row(), j, it.value());
  }
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

SpMat Poisson::pinned(const SpMat& K, const std::vector<char>& held) const {
  // The first unknown of every component that nothing else holds is eliminated: its row and column
  // go, its diagonal stays positive.
  std::vector<char> pin(K.rows(), 0);
  for (Eigen::Index i = 0; i < K.rows(); ++i)
    if (i < static_cast<Eigen::Index>(component_.size()) && component_[i] < 0) pin[i] = 1;
  for (std::size_t c = 0; c < first_.size(); ++c)
    if (!held[c]) pin[first_[c]] = 1;
  return eliminated(K, pin);
}

std::vector<char> Poisson::components_of(const SpMat& A) const {
  std::vector<char> held(first_.size(), 0);
  for (int j = 0; j < A.outerSize(); ++j)
    for (SpMat::InnerIterator it(A, j); it; ++it)
      if (j < static_cast<int>(component_.size()) && component_[j] >= 0) held[component_[j]] = 1;
  return held;
}

namespace {
std::vector<int> first_of_components(const std::vector<int>& component, int n_components) {
  std::vector<int> first(n_components, -1);
  for (std::size_t i = 0; i < component.size(); ++i)
    if (component[i] >= 0 && first[component[i]] < 0) first[component[i]] = static_cast<int>(i);
  return first;
}
}  // namespace

Poisson::Poisson(const SpMat& L, std::vector<int> component, int n_components, const Task& task)
    : L_(L),
      component_(std::move(component)),
      first_(first_of_components(component_, n_components)),
      pinned_(pinned(L, std::vector<char>(n_components, 0)), task) {}

VecX Poisson::solve(const VecX& b, Report& report) const {
  VecX rhs = b;
  for (int i : first_) rhs[i] = 0;
  const VecX x = pinned_.solve(rhs);
  report.residuals.emplace_back("poisson", pinned_.relative_residual(x, rhs));
  return x;
}

VecX Poisson::solve_soft(const VecX& b, const SpMat& A, const VecX& weight, const Task& task,
                         Report& report) const {
  const auto held = components_of(A);
  const DefiniteSystem system(pinned(with_penalty(L_, A, weight), held), task);
  VecX rhs = b;
  for (std::size_t c = 0; c < first_.size(); ++c)
    if (!held[c]) rhs[first_[c]] = 0;
  VecX x = system.solve(rhs);
  report.residuals.emplace_back("poisson, soft constraints", system.relative_residual(x, rhs));
  return x;
}

VecX Poisson::solve_levels(const VecX& b, const LevelRows& rows, const Task& task,
                           Report& report) const {
  // Unknowns (x, c): rows A x - B c = 0, the constants of anchored groups left out.
  const Eigen::Index n = L_.rows();
  const int n_groups = static_cast<int>(rows.anchor.size());
  std::vector<int> column(n_groups, -1);
  Eigen::Index unknowns = n;
  for (int g = 0; g < n_groups; ++g)
    if (!rows.anchor[g]) column[g] = static_cast<int>(unknowns++);
  Triplets entries;
  for (int j = 0; j < rows.A.outerSize(); ++j)
    for (SpMat::InnerIterator it(rows.A, j); it; ++it)
      entries.emplace_back(it.row(), j, it.value());
  for (std::size_t r = 0; r < rows.group.size(); ++r)
    if (column[rows.group[r]] >= 0) entries.emplace_back(int(r), column[rows.group[r]], -1.0);
  SpMat R(rows.A.rows(), unknowns);
  R.setFromTriplets(entries.begin(), entries.end());
  SpMat L = L_;
  L.conservativeResize(unknowns, unknowns);

  // Augmented Lagrangian on one factorization of K = L + w R^T R: dependent rows only make
  // multipliers that are not unique.
  const double w = 1e5 * mean_diagonal(L_);
  const auto held = components_of(rows.A);
  const DefiniteSystem system(pinned(with_penalty(L, R, VecX::Constant(R.rows(), w)), held), task);
  VecX rhs = VecX::Zero(unknowns);
  rhs.head(n) = b;
  for (std::size_t c = 0; c < first_.size(); ++c)
    if (!held[c]) rhs[first_[c]] = 0;
  VecX y = VecX::Zero(R.rows()), x;
  double violation = 0, range = 1;
  constexpr int max_steps = 20;
  int step = 0;
  while (step < max_steps) {
    x = system.solve(rhs - SpMat(R.transpose()) * y);
    const VecX miss = R * x;
    ++step;
    range = std::max(x.head(n).maxCoeff() - x.head(n).minCoeff(), 1e-300);
    const double before = violation;
    violation = miss.size() ? miss.cwiseAbs().maxCoeff() / range : 0;
    const bool stalled = step > 1 && violation < 1e-9 && violation > 0.2 * before;  // round-off
    if (violation < 1e-12 || stalled) break;
    y += w * miss;
  }
  report.iterations.emplace_back("constraint steps", step);
  report.residuals.emplace_back("constraints", violation);
  if (violation > 1e-8) {
    report.status = "not converged";
    report.warn("the constraints could not be met exactly; the result is their least-squares fit");
  }
  return x.head(n);
}

}  // namespace littoral
