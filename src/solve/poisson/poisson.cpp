#include "solve/poisson/poisson.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/dense_decompositions.h"
#include "base/index.h"
#include "base/taken.h"
#include "littoral/error.h"

namespace littoral {

namespace {

double mean_diagonal(const SpMat& L) {
  const VecX d = L.diagonal();
  const double n = static_cast<double>((d.array() > 0).count());
  return n > 0 ? d.sum() / n : 1;
}

std::vector<int> first_of_components(const std::vector<int>& component, int n_components) {
  std::vector<int> first(n_components, -1);
  for (std::size_t i = 0; i < component.size(); ++i)
    if (component[i] >= 0 && first[component[i]] < 0) first[component[i]] = i;
  return first;
}

/// L with an entry on the whole diagonal, so that every matrix made from it has one pattern with
/// the diagonal first in every column.
std::shared_ptr<const SpMat> with_diagonal(std::shared_ptr<const SpMat> L) {
  bool whole = L->isCompressed();
  for (Eigen::Index j = 0; whole && j < L->cols(); ++j) {
    const int first = L->outerIndexPtr()[j];
    whole = first < L->outerIndexPtr()[j + 1] && L->innerIndexPtr()[first] == j;
  }
  if (whole) return L;
  SpMat I(L->rows(), L->cols());
  I.setIdentity();
  SpMat K = *L + 0.0 * I;
  K.makeCompressed();
  return shared_taken(K);
}

/// L with `d` added to the diagonal at the unknowns `at`.
SpMat lifted(const SpMat& L, const std::vector<int>& at, double d) {
  SpMat K = copied(L);
  for (const int i : at) K.valuePtr()[K.outerIndexPtr()[i]] += d;
  return K;
}

std::shared_ptr<const Elimination> structure_of(const SpMat& L, const Ordering& order,
                                                const Task& task) {
  if (!order.empty()) return std::make_shared<const Elimination>(L, order, task);
  return std::make_shared<const Elimination>(L, dissection(L, task), task);
}

/// Rows that say no more than which constant to add: one a component at most, all of its unknowns
/// in that component, its value given.
struct ConstantRows {
  Eigen::SparseMatrix<double, Eigen::RowMajor> A;
  std::vector<int> component;  // per row
  VecX sum;                    // of each row
};

std::optional<ConstantRows> constant_rows(const LevelRows& rows, const std::vector<int>& component,
                                          std::size_t n_components) {
  if (rows.A.rows() > index(n_components)) return std::nullopt;
  for (const int anchored : rows.anchor)
    if (!anchored) return std::nullopt;
  ConstantRows out{rows.A, {}, VecX::Zero(rows.A.rows())};
  std::vector<char> taken(n_components, 0);
  for (int r = 0; r < out.A.rows(); ++r) {
    int of = -1;
    double size = 0;
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(out.A, r); it; ++it) {
      const int c = component[it.col()];
      if (c < 0 || (of >= 0 && c != of)) return std::nullopt;
      of = c;
      out.sum[r] += it.value();
      size += std::abs(it.value());
    }
    if (of < 0 || taken[of] || !(std::abs(out.sum[r]) > 0.5 * size)) return std::nullopt;
    taken[of] = 1;
    out.component.push_back(of);
  }
  return out;
}

// Beyond, the factor costs too much memory, or more time than the iterations of one solve.
constexpr int largest_direct = 2'000'000, largest_solved_once = 400'000;

}  // namespace

Poisson::Poisson(std::shared_ptr<const SpMat> L, std::vector<int> component, int n_components,
                 const Task& task, const Ordering& order, PoissonSolver solver)
    : L_(with_diagonal(std::move(L))),
      mean_diagonal_(mean_diagonal(*L_)),
      component_(std::move(component)),
      first_(first_of_components(component_, n_components)),
      one_solve_(solver == PoissonSolver::automatic_for_one_solve) {
  const int largest = one_solve_ ? largest_solved_once : largest_direct;
  if (solver == PoissonSolver::multigrid ||
      (solver != PoissonSolver::direct && L_->rows() > largest))
    return;
  structure_ = structure_of(*L_, order, task);
  if (!one_solve_) system(task);
}

Poisson::Poisson(const SpMat& L, std::vector<int> component, int n_components, const Task& task,
                 const Ordering& order, PoissonSolver solver)
    : Poisson(std::make_shared<const SpMat>(L), std::move(component), n_components, task, order,
              solver) {}

const DefiniteSystem& Poisson::system(const Task& task) const {
  return *made_->free.get([&] { return unconstrained(task); });
}

double Poisson::nonzeros() const {
  return structure_ ? static_cast<double>(structure_->values()) : system().nonzeros();
}

DefiniteSystem Poisson::unconstrained(const Task& task) const {
  const std::vector<int> at = loose(std::vector<char>(first_.size(), 0));
  if (iterates())
    return DefiniteSystem::by_multigrid(
        [L = L_, at, d = mean_diagonal_] { return lifted(*L, at, d); }, {});
  return {pinned(at), structure_, task, !one_solve_};
}

std::vector<int> Poisson::loose(const std::vector<char>& fixed) const {
  // Unknowns in no equation, and the first of every component that nothing else holds: that gets a
  // spring to 0, which bears no force if b sums to 0, and changes one entry of the matrix only.
  std::vector<int> at;
  for (std::size_t i = 0; i < component_.size(); ++i)
    if (component_[i] < 0) at.push_back(static_cast<int>(i));
  for (std::size_t c = 0; c < first_.size(); ++c)
    if (!fixed[c]) at.push_back(first_[c]);
  return at;
}

SpMat Poisson::pinned(const std::vector<int>& loose) const {
  return lifted(*L_, loose, mean_diagonal_);
}

std::vector<char> Poisson::components_of(const SpMat& A) const {
  std::vector<char> fixed(first_.size(), 0);
  for (int j : unknowns_of(A))
    if (component_[j] >= 0) fixed[component_[j]] = 1;
  return fixed;
}

void Poisson::drop_constants(const std::vector<char>& fixed, VecX& x) const {
  VecX constant = VecX::Zero(first_.size());
  for (std::size_t c = 0; c < first_.size(); ++c)
    if (!fixed[c]) constant[c] = x[first_[c]];
  for (Eigen::Index i = 0; i < x.size(); ++i)
    x[i] = component_[i] < 0 ? 0 : x[i] - constant[component_[i]];
}

VecX Poisson::solve(const VecX& b, Report& report, const Task& task) const {
  const DefiniteSystem& free = system(task);
  VecX x = free.solve(b, task, report);
  report.residuals.emplace_back("poisson", free.relative_residual(x, b));
  drop_constants(std::vector<char>(first_.size(), 0), x);
  return x;
}

bool Poisson::Penalty::operator==(const Penalty& other) const {
  const auto same = [](const auto* a, const auto* b, Eigen::Index n) {
    return std::equal(a, a + n, b);
  };
  return A.rows() == other.A.rows() && A.cols() == other.A.cols() &&
         A.nonZeros() == other.A.nonZeros() && weight == other.weight &&
         same(A.outerIndexPtr(), other.A.outerIndexPtr(), A.outerSize() + 1) &&
         same(A.innerIndexPtr(), other.A.innerIndexPtr(), A.nonZeros()) &&
         same(A.valuePtr(), other.A.valuePtr(), A.nonZeros());
}

std::shared_ptr<const DefiniteSystem> Poisson::with_penalty(const SpMat& A, const VecX& weight,
                                                            const std::vector<char>& fixed,
                                                            const Task& task) const {
  const auto make = [&] { return penalized(A, weight, fixed, task); };
  if (!one_solve_ || iterates()) return std::make_shared<const DefiniteSystem>(make());
  Penalty penalty{A, weight};  // longer times and pieces at pinches solve with the same again
  penalty.A.makeCompressed();
  return made_->penalized.get(penalty, make);
}

DefiniteSystem Poisson::penalized(const SpMat& A, const VecX& weight,
                                  const std::vector<char>& fixed, const Task& task) const {
  const std::vector<int> at = loose(fixed);
  if (iterates())
    return DefiniteSystem::by_multigrid(
        [L = L_, at, d = mean_diagonal_, A, weight]() -> SpMat {
          SpMat K = lifted(*L, at, d);
          if (!add_rows_in_place(K, A, weight)) with_rows(K, A, weight).swap(K);
          return K;
        },
        unknowns_of(A));
  SpMat K = pinned(at);
  if (add_rows_in_place(K, A, weight)) {
    if (one_solve_ || !system().can_be_patched()) return {taken(K), structure_, task};
    std::vector<int> changed = unknowns_of(A);
    for (std::size_t c = 0; c < first_.size(); ++c)
      if (fixed[c]) changed.push_back(first_[c]);
    return system().patched(taken(K), changed, task);
  }
  SpMat wider = with_rows(K, A, weight);
  const auto structure = std::make_shared<const Elimination>(wider, structure_->old_of, task);
  return {taken(wider), structure, task};
}

VecX Poisson::solve_soft(const VecX& b, const SpMat& A, const VecX& weight, const Task& task,
                         Report& report, const VecX& value) const {
  const auto fixed = components_of(A);
  const auto with = with_penalty(A, weight, fixed, task);
  const DefiniteSystem& system = *with;
  VecX pulled = b;
  if (value.size() > 0) pulled += A.transpose() * weight.cwiseProduct(value);
  VecX x = system.solve(pulled, task, report);
  report.residuals.emplace_back("poisson, soft constraints", system.relative_residual(x, pulled));
  drop_constants(fixed, x);
  return x;
}

VecX Poisson::solve_levels(const VecX& b, const LevelRows& rows, const Task& task,
                           Report& report) const {
  if (const auto constants = constant_rows(rows, component_, first_.size())) {
    // What such a row exerts is what b sums to: L x = b - A^T y is solved up to the constant.
    const auto n_rows = constants->A.rows();
    VecX sum = VecX::Zero(index(first_.size())), y(n_rows);
    for (Eigen::Index i = 0; i < b.size(); ++i)
      if (component_[i] >= 0) sum[component_[i]] += b[i];
    for (Eigen::Index r = 0; r < n_rows; ++r)
      y[r] = sum[constants->component[r]] / constants->sum[r];
    VecX x = solve(b - constants->A.transpose() * y, report, task);
    const VecX at_rows = constants->A * x;
    VecX shift = VecX::Zero(index(first_.size()));
    for (Eigen::Index r = 0; r < n_rows; ++r)
      shift[constants->component[r]] =
          ((rows.value.size() > 0 ? rows.value[r] : 0) - at_rows[r]) / constants->sum[r];
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (component_[i] >= 0) x[i] += shift[component_[i]];
    return x;
  }

  // Unknowns (x, c): rows A x - B c = 0, the constants of anchored groups left out.
  std::vector<int> column(rows.anchor.size(), -1);
  int n_free = 0;
  for (std::size_t g = 0; g < rows.anchor.size(); ++g)
    if (!rows.anchor[g]) column[g] = n_free++;
  auto spread = [&](const MatX& c) {  // B c
    MatX out = MatX::Zero(rows.A.rows(), c.cols());
    for (std::size_t r = 0; r < rows.group.size(); ++r)
      if (column[rows.group[r]] >= 0) out.row(r) = c.row(column[rows.group[r]]);
    return out;
  };
  auto gather = [&](const MatX& y) {  // B^T y
    MatX out = MatX::Zero(n_free, y.cols());
    for (std::size_t r = 0; r < rows.group.size(); ++r)
      if (column[rows.group[r]] >= 0) out.row(column[rows.group[r]]) += y.row(r);
    return out;
  };

  // Augmented Lagrangian: every step solves with the factor of K = L + w A^T A, and c by what is
  // left for it; dependent rows only make multipliers y that are not unique.
  const double w = 1e7 * mean_diagonal_;
  const auto fixed = components_of(rows.A);
  const std::vector<int> sprung = loose(fixed);
  const auto with = with_penalty(rows.A, VecX::Constant(rows.A.rows(), w), fixed, task);
  const DefiniteSystem& system = *with;
  const SpMat At = rows.A.transpose();
  std::optional<SymmetricFactor> rest;
  if (n_free > 0) {
    MatX S(n_free, n_free);
    constexpr int at_once = 16;
    for (int g = 0; g < n_free; g += at_once) {
      task.checkpoint();
      const int k = std::min(at_once, n_free - g);
      const MatX B = spread(MatX::Identity(n_free, n_free).middleCols(g, k));
      S.middleCols(g, k) = w * gather(B - rows.A * system.approximate(MatX(w * (At * B)), task));
    }
    rest.emplace(0.5 * (S + S.transpose()));
  }
  VecX x = VecX::Zero(L_->rows()), c = VecX::Zero(n_free), y = VecX::Zero(rows.A.rows());
  const VecX value = rows.value.size() > 0 ? rows.value : y;
  VecX miss = -value;  // A x - B c - value
  double violation = 0, residual = 0;
  const std::vector<int> at = unknowns_of(rows.A);
  SpMat A_at(rows.A.rows(), index(at.size()));
  for (std::size_t k = 0; k < at.size(); ++k) A_at.col(index(k)) = rows.A.col(at[k]);
  // What c adds to the right side, and without c what a second step adds, follows from x at the
  // rows alone. Rows of several unknowns, values and c leave the first step fewer digits, so that a
  // second with the matrix itself is needed and nothing is won.
  const bool twice =
      n_free == 0 && !system.iterates() && rows.A.nonZeros() == rows.A.rows() && value.isZero(0);
  const int rounds = n_free > 0 || twice ? 1 : 0;
  VecX r = b - At * (w * miss);
  constexpr int max_steps = 30;
  constexpr double enough = 1e-14;
  int step = 0;
  for (; step < max_steps; ++step) {
    task.checkpoint();
    const VecX dx = system.approximate(
        std::move(r), at, rounds,
        [&](const MatX& dx_at) -> MatX {
          const VecX there = A_at * dx_at;
          if (twice) {
            miss += there;
            y += w * miss;
            return A_at.transpose() * VecX(-w * miss);
          }
          const VecX dc = rest->solve(gather(VecX(y + w * (miss + there))));
          c += dc;
          return A_at.transpose() * VecX(w * spread(dc));
        },
        task);
    x += dx;
    miss = rows.A * x - spread(c) - value;
    y += w * miss;
    const double before = violation, residual_before = residual;
    const double range = std::max(x.maxCoeff() - x.minCoeff(), 1e-300);
    violation = miss.size() ? miss.cwiseAbs().maxCoeff() / range : 0;
    residual = dx.cwiseAbs().maxCoeff() / range;
    if (!std::isfinite(residual))
      throw SolveError("the constrained Poisson solve diverged: its values are not finite");
    const bool stalled = step > 0 && violation < 1e-9 && residual < 1e-8 &&
                         (violation > 0.2 * before || residual > 0.2 * residual_before);
    // The next step is as much shorter than this one as this one is than the last.
    const double next = step > 0 ? residual * (residual / residual_before) : residual;
    if ((violation < 1e-12 && std::min(residual, next) < 1e-9) || stalled) break;
    r = b - At * y - times_symmetric(*L_, x);
    for (const int i : sprung) r[i] -= mean_diagonal_ * x[i];
    const double size = mean_diagonal_ * x.norm();
    if (twice && violation < 1e-12 && r.norm() <= enough * (b.norm() + size)) break;
    r -= At * (w * miss);
  }
  report.iterations.emplace_back("constraint steps", step + 1);
  report.residuals.emplace_back("constraints", violation);
  if (violation > 1e-8) {
    report.status = "not converged";
    report.warn("constraints-unmet",
                "the constraints could not be met exactly, as where curves cross in one element; "
                "the result is their least-squares fit");
  }
  drop_constants(fixed, x);
  return x;
}

}  // namespace littoral
