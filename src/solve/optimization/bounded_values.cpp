#include "solve/optimization/bounded_values.h"

#include <algorithm>
#include <utility>

namespace littoral {

BoundedEnergy::BoundedEnergy(const GradientEnergy& inner, int dim, Eigen::Index cells,
                             std::vector<int> sign, VecX bound)
    : inner_(inner), dim_(dim), cells_(cells), sign_(std::move(sign)), bound_(std::move(bound)) {}

void BoundedEnergy::prox(Eigen::Index cell, double rho, const double* w, double* z) const {
  if (cell < cells_) return inner_.prox(cell, rho, w, z);
  const int sign = sign_[cell - cells_];
  for (int d = 0; d < dim_; ++d) z[d] = 0;
  z[0] = sign * std::clamp(sign * w[0], 0.0, bound_[cell - cells_]);
}

void BoundedEnergy::prox_all(Eigen::Index first, Eigen::Index count, int dim, const double* rho,
                             const double* w, double* z) const {
  const Eigen::Index of_inner = std::clamp<Eigen::Index>(cells_ - first, 0, count);
  inner_.prox_all(first, of_inner, dim, rho, w, z);
  for (Eigen::Index k = of_inner; k < count; ++k) prox(first + k, rho[k], w + k * dim, z + k * dim);
}

double BoundedEnergy::value(Eigen::Index cell, const double* z) const {
  return cell < cells_ ? inner_.value(cell, z) : 0;
}

double BoundedEnergy::conjugate(Eigen::Index cell, const double* y) const {
  if (cell < cells_) return inner_.conjugate(cell, y);
  const Eigen::Index i = cell - cells_;
  return bound_[i] * std::max(0.0, sign_[i] * y[0]);
}

double BoundedEnergy::gauge(Eigen::Index cell, const double* z) const {
  return cell < cells_ ? inner_.gauge(cell, z) : 0;
}

SpRows stacked(const SpRows& G, const SpMat& R, int dim) {
  Triplets entries;
  entries.reserve(G.nonZeros() + R.nonZeros());
  for (int r = 0; r < G.outerSize(); ++r)
    for (SpRows::InnerIterator it(G, r); it; ++it) entries.emplace_back(r, it.col(), it.value());
  for (int j = 0; j < R.outerSize(); ++j)
    for (SpMat::InnerIterator it(R, j); it; ++it)
      entries.emplace_back(G.rows() + dim * it.row(), j, it.value());
  SpRows both(G.rows() + dim * R.rows(), G.cols());
  both.setFromTriplets(entries.begin(), entries.end());
  return both;
}

}  // namespace littoral
