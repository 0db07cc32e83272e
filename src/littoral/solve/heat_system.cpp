#include "littoral/solve/heat_system.h"

#include <algorithm>
#include <cmath>

#include "littoral/base/error.h"

namespace littoral {

namespace {

constexpr double front =
    1e-100;  // entries below this share of the largest belong to the next layer

template <class Scalar>
double magnitude(const Scalar& z) {
  return std::max(std::abs(std::real(z)), std::abs(std::imag(z)));  // a norm would underflow
}

template <class Vector>
double block_magnitude(const Vector& x, Eigen::Index i, int block) {
  double m = 0;
  for (int k = 0; k < block; ++k) m = std::max(m, magnitude(x[i * block + k]));
  return m;
}

}  // namespace

template <class Scalar>
Eigen::Matrix<Scalar, Eigen::Dynamic, 1> LayeredField<Scalar>::around_layer(int p) const {
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> y = decltype(y)::Zero(x.size());
  const Eigen::Index block =
      x.size() / std::max<Eigen::Index>(1, static_cast<Eigen::Index>(layer.size()));
  for (std::size_t i = 0; i < layer.size(); ++i) {
    const Eigen::Index at = static_cast<Eigen::Index>(i) * block;
    if (layer[i] == p) y.segment(at, block) = x.segment(at, block);
    if (layer[i] == p + 1) y.segment(at, block) = x.segment(at, block) * scale[p + 1];
  }
  return y;
}

template <class Scalar>
HeatSystem<Scalar>::HeatSystem(Matrix lower, int block, const Task& task)
    : A_(std::make_shared<const Matrix>(std::move(lower))), block_(block), factor_(A_, task) {}

template <class Scalar>
LayeredField<Scalar> HeatSystem<Scalar>::solve(const Vector& b, const std::vector<int>& piece,
                                               const Task& task, Report& report) const {
  const Eigen::Index n = b.size() / block_;
  LayeredField<Scalar> field;
  field.layer.assign(static_cast<std::size_t>(n), -1);
  field.scale.assign(1, 1.0);
  field.x = Vector::Zero(b.size());

  std::vector<double> largest;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (piece[i] < 0) continue;
    if (piece[i] >= static_cast<int>(largest.size())) largest.resize(piece[i] + 1, 0.0);
    largest[piece[i]] = std::max(largest[piece[i]], block_magnitude(b, i, block_));
  }
  Vector r = Vector::Zero(b.size());
  Eigen::Index left = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (piece[i] < 0 || !(largest[piece[i]] > 0)) continue;
    r.segment(i * block_, block_) = b.segment(i * block_, block_) / largest[piece[i]];
    ++left;
  }

  int passes = 0;
  while (left > 0) {
    task.checkpoint();
    const int p = passes++;
    const Vector z = factor_.solve(r);
    double top = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      if (field.layer[i] < 0 && piece[i] >= 0 && largest[piece[i]] > 0)
        top = std::max(top, block_magnitude(z, i, block_));
    if (!(top > 0) || !std::isfinite(top)) break;
    Eigen::Index taken = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (field.layer[i] >= 0 || piece[i] < 0 || !(largest[piece[i]] > 0)) continue;
      field.x.segment(i * block_, block_) = z.segment(i * block_, block_);
      if (block_magnitude(z, i, block_) < front * top) continue;
      field.layer[i] = p;
      ++taken;
    }
    left -= taken;
    if (left == 0 || taken == 0) break;

    // b - A (x truncated to the layers so far): nonzero on both sides of the front only.
    r.setZero();
    auto inside = [&](Eigen::Index i) { return field.layer[i / block_] >= 0; };
    auto fresh = [&](Eigen::Index i) { return field.layer[i / block_] == p; };
    for (int j = 0; j < A_->outerSize(); ++j) {
      for (typename Matrix::InnerIterator it(*A_, j); it; ++it) {
        const Eigen::Index i = it.row();
        if (inside(i) == inside(j)) continue;
        const Scalar a = it.value(), a_transposed = Eigen::numext::conj(a);
        if (fresh(j)) {  // i outside
          r[i] -= a * field.x[j];
          r[j] += a_transposed * field.x[i];
        } else if (fresh(i)) {  // j outside
          r[j] -= a_transposed * field.x[i];
          r[i] += a * field.x[j];
        }
      }
    }
    double m = 0;
    for (Eigen::Index i = 0; i < r.size(); ++i) m = std::max(m, magnitude(r[i]));
    if (!(m > 0)) break;
    r /= m;
    field.scale.push_back(m);
  }
  report.iterations.emplace_back("heat passes", passes);
  for (Eigen::Index i = 0; i < n; ++i)
    if (field.layer[i] < 0) field.x.segment(i * block_, block_).setZero();
  if (left > 0)
    report.warn("heat did not reach " + std::to_string(left) +
                " elements; their directions are left to the Poisson step");
  return field;
}

template struct LayeredField<double>;
template struct LayeredField<Complex>;
template class HeatSystem<double>;
template class HeatSystem<Complex>;

}  // namespace littoral
