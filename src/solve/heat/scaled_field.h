#pragma once
// Fields that decay over more orders of magnitude than a floating-point number has.

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/index.h"
#include "littoral/types.h"

namespace littoral {

/// A decaying solution in layers, each at a scale of its own: block i is scale[0] * ... *
/// scale[layer[i]] * x_i. Neighbouring blocks are at most one layer apart. Layer -1: no source
/// reaches the block.
template <class Scalar>
struct ScaledField {
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> x;
  std::vector<int> layer;     // blocks
  std::vector<double> scale;  // layers

  /// The entries of layer p, in its units; 0 elsewhere.
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> in_layer(int p) const {
    Eigen::Matrix<Scalar, Eigen::Dynamic, 1> y = decltype(y)::Zero(x.size());
    const auto block = x.size() / std::max<Eigen::Index>(1, index(layer.size()));
    for (std::size_t i = 0; i < layer.size(); ++i) {
      const auto at = index(i) * block;
      if (layer[i] == p) y.segment(at, block) = x.segment(at, block);
    }
    return y;
  }
};

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

}  // namespace littoral
