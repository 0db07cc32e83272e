#include "solve/poisson/constrained_system.h"

#include <algorithm>
#include <cmath>

#include "base/dense_decompositions.h"
#include "base/index.h"
#include "base/parallel.h"
#include "base/taken.h"

namespace littoral {

namespace {

constexpr Eigen::Index few_rows = 64;
constexpr std::size_t unknowns_at_once = 1 << 14;
constexpr double stiffness = 1e8;  // of many rows, times the mean diagonal

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

bool holds_one_unknown(const RowMatrix& rows, Eigen::Index r) {
  int n = 0;
  for (RowMatrix::InnerIterator it(rows, r); it; ++it)
    if (it.value() != 0) ++n;
  return n == 1;
}

int component_of_row(const RowMatrix& rows, Eigen::Index r, const std::vector<int>& component) {
  for (RowMatrix::InnerIterator it(rows, r); it; ++it)
    if (it.value() != 0) return component[it.col()];
  return -1;
}

/// `pinned` and the first unknown of every component that is not fixed, and unknowns in none.
std::vector<char> pin_first(const std::vector<int>& component, std::vector<char> fixed,
                            std::vector<char> pinned) {
  pinned.resize(component.size(), 0);
  for (std::size_t i = 0; i < component.size(); ++i) {
    const int c = component[i];
    if (c >= 0 && fixed[c]) continue;
    pinned[i] = 1;
    if (c >= 0) fixed[c] = 1;
  }
  return pinned;
}

}  // namespace

ConstrainedSystem::ConstrainedSystem(SpMat K, std::vector<int> component, int n_components,
                                     const Task& task, Rows expected)
    : K_(shared_taken(K)),
      component_(std::move(component)),
      n_components_(n_components),
      pinned_(pin_first(component_, std::vector<char>(n_components, 0), {})),
      factor_(std::make_shared<Kept<DefiniteSystem>>()) {
  if (expected == Rows::many) return;
  const SpMat pinned = eliminated(*K_, pinned_);
  structure_ = std::make_shared<const Elimination>(pinned, dissection(pinned, task), task);
}

/// Single unknowns by elimination, other rows and those that give by a penalty.
void ConstrainedSystem::constrain_many(const SpMat& A, const VecX& give, Constrained& constrained,
                                       const Task& task) const {
  const RowMatrix rows = A;
  std::vector<char> fixed(n_components_, 0);
  Triplets others;
  std::vector<double> weight;  // of the others
  const double stiff = stiffness * K_->diagonal().mean();
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    const int c = component_of_row(rows, r, component_);
    if (c < 0) continue;
    fixed[c] = 1;
    const bool gives = give.size() > 0 && give[r] > 0;
    const bool single = !gives && holds_one_unknown(rows, r);
    for (RowMatrix::InnerIterator it(rows, r); it; ++it) {
      if (it.value() == 0) continue;
      if (single)
        constrained.gone_[it.col()] = 1;
      else
        others.emplace_back(weight.size(), it.col(), it.value());
    }
    if (!single) weight.push_back(gives ? 1 / give[r] : stiff);
  }
  constrained.pinned_ = pin_first(component_, fixed, constrained.gone_);
  SpMat penalised(weight.size(), K_->cols());
  penalised.setFromTriplets(others.begin(), others.end());
  const Eigen::Map<const VecX> weights(weight.data(), index(weight.size()));
  SpMat K =
      eliminated(weight.empty() ? *K_ : with_rows(*K_, penalised, weights), constrained.pinned_);
  constrained.factor_ = of_many_
                            ? std::make_shared<const DefiniteSystem>(std::move(K), of_many_, task)
                            : std::make_shared<const DefiniteSystem>(K, task);
}

ConstrainedSystem::Constrained ConstrainedSystem::constrain_like(const Constrained& like,
                                                                 SpMat matrix, const SpMat& rows,
                                                                 const Task& task,
                                                                 const VecX& give) const {
  ConstrainedSystem other = *this;
  other.K_ = shared_taken(matrix);
  other.factor_ = std::make_shared<Kept<DefiniteSystem>>();
  if (like.factor_ && like.factor_->structure() != structure_)
    other.of_many_ = like.factor_->structure();
  return other.constrain(rows, task, give);
}

ConstrainedSystem::Constrained ConstrainedSystem::constrain(const SpMat& A, const Task& task,
                                                            const VecX& give) const {
  const RowMatrix rows = A;
  Constrained constrained;
  constrained.component_ = component_;
  constrained.active_.assign(n_components_, 0);
  constrained.gone_.assign(component_.size(), 0);
  constrained.pinned_ = pinned_;
  constrained.give_ = VecX::Zero(n_components_);
  std::vector<Eigen::Index> rest;
  Triplets gauge, others;
  auto put = [&](Triplets& out, Eigen::Index r, int column) {
    double sum = 0;
    for (RowMatrix::InnerIterator it(rows, r); it; ++it) sum += it.value();
    for (RowMatrix::InnerIterator it(rows, r); it; ++it)
      out.emplace_back(it.col(), column, it.value() / sum);
  };
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    const int c = component_of_row(rows, r, component_);
    if (c < 0) continue;
    if (constrained.active_[c]) {
      rest.push_back(r);
      continue;
    }
    constrained.active_[c] = 1;
    put(gauge, r, c);
    if (give.size() > 0) constrained.give_[c] = give[r];
  }
  const Eigen::Index n = component_.size();
  constrained.gauge_.resize(n, n_components_);
  if (!structure_ || index(rest.size()) > few_rows) {
    constrained.give_.setZero();
    constrain_many(A, give, constrained, task);
    return constrained;
  }
  constrained.factor_ =
      factor_->get([&] { return DefiniteSystem(eliminated(*K_, pinned_), structure_, task); });
  constrained.gauge_.setFromTriplets(gauge.begin(), gauge.end());
  if (rest.empty()) return constrained;
  for (std::size_t i = 0; i < rest.size(); ++i) put(others, rest[i], i);
  SpMat columns(n, rest.size());
  columns.setFromTriplets(others.begin(), others.end());
  Eigen::MatrixXd response(n, columns.cols());
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    task.checkpoint(double(i) / double(columns.cols()));
    response.col(i) = constrained.solve_gauged(VecX(columns.col(i)));
  }
  // Responses differ by many orders where thin triangles are, so each row is compared with itself:
  // a row whose unknowns would give way far more if all others were held depends on other rows.
  Eigen::MatrixXd S = columns.transpose() * response;
  for (std::size_t i = 0; i < rest.size() && give.size() > 0; ++i)
    S(index(i), index(i)) += give[rest[i]];
  const VecX stiffness_of = K_->diagonal();
  VecX scale(S.rows());
  for (Eigen::Index i = 0; i < S.rows(); ++i) {
    double alone = 0;
    for (SpMat::InnerIterator it(columns, i); it; ++it)
      if (stiffness_of[it.row()] > 0)
        alone = std::max(alone, it.value() * it.value() / stiffness_of[it.row()]);
    scale[i] = S(i, i) > 1e-12 * alone ? 1 / std::sqrt(S(i, i)) : 0;
  }
  constrained.inverse_ =
      scale.asDiagonal() *
      pseudo_inverse(Eigen::MatrixXd(scale.asDiagonal() * S * scale.asDiagonal())) *
      scale.asDiagonal();
  constrained.rest_ = std::move(columns);
  constrained.response_ = std::move(response);
  return constrained;
}

/// With the gauge rows alone: what they exert is the sum of b, so that K u = b - a sum(b) has a
/// solution; then the constant that makes a^T u = 0, or as much as the row gives under that force.
VecX ConstrainedSystem::Constrained::solve_gauged(const VecX& b) const {
  const std::size_t n = component_.size(), parts = gauge_.cols();
  const std::size_t grain = std::max(unknowns_at_once, 16 * parts);
  VecX rhs(b.size()), sum = VecX::Zero(gauge_.cols());
  // Between sums of two pieces there is a line of memory, which threads need not share then.
  const Eigen::Index line = 64 / sizeof(double);
  MatX of_piece = MatX::Zero(gauge_.cols() + line, index((n + grain - 1) / grain));
  parallel_for(n, grain, [&](std::size_t i, std::size_t end) {
    auto own = of_piece.col(index(i / grain));
    for (; i < end; ++i) {
      const int c = component_[i];
      const bool has_part = c >= 0 && active_[c] && !gone_[i];
      if (has_part) own[c] += b[index(i)];
      rhs[index(i)] = has_part && !pinned_[i] ? b[index(i)] : 0;
    }
  });
  for (Eigen::Index k = 0; k < of_piece.cols(); ++k) sum += of_piece.col(k).head(sum.size());
  for (int c = 0; c < gauge_.outerSize(); ++c)
    for (SpMat::InnerIterator it(gauge_, c); it; ++it)
      if (!pinned_[it.row()]) rhs[it.row()] -= it.value() * sum[c];
  VecX u = factor_->solve_once(rhs);
  const VecX shift = gauge_.transpose() * u - give_.cwiseProduct(sum);
  parallel_for(n, grain, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      const int c = component_[i];
      if (c < 0 || !active_[c])
        u[index(i)] = 0;
      else if (!gone_[i])
        u[index(i)] -= shift[c];
    }
  });
  return u;
}

double ConstrainedSystem::flops_of_number(const Constrained& like) const {
  const auto& structure = like.factor_ ? like.factor_->structure() : structure_;
  return structure ? structure->flops() / std::max<double>(1, structure->values()) : 0;
}

VecX ConstrainedSystem::Constrained::solve(const VecX& b) const {
  VecX u = solve_gauged(b);
  if (rest_.cols() == 0) return u;
  u -= response_ * (inverse_ * (rest_.transpose() * u));
  return u;
}

}  // namespace littoral
