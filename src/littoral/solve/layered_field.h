#pragma once
// Fields that decay over more orders of magnitude than a floating-point number has.

#include <algorithm>
#include <cmath>
#include <vector>

#include "littoral/base/types.h"

namespace littoral {

/// Values in layers, each layer in units of its own: block i is x_i in units of layer[i], and the
/// unit of that layer is step[i] times the unit of the layer before, on the same connected piece.
/// Neighbouring blocks are at most one layer apart. Layer -1: no source reaches the block.
template <class Scalar>
struct LayeredField {
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> x;
  std::vector<int> layer;    // blocks
  std::vector<double> step;  // blocks; in layer 0: that layer's unit
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
