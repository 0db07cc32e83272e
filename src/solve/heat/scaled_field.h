#pragma once
// Fields that decay over more orders of magnitude than a floating-point number has.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"
#include "littoral/types.h"

namespace littoral {

constexpr std::size_t block_grain = 1 << 15;  // blocks, for loops over all of a field

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
    Eigen::Matrix<Scalar, Eigen::Dynamic, 1> y(x.size());
    const auto block = x.size() / std::max<Eigen::Index>(1, index(layer.size()));
    parallel_for(layer.size(), block_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto at = index(i) * block;
        if (layer[i] == p)
          y.segment(at, block) = x.segment(at, block);
        else
          y.segment(at, block).setZero();
      }
    });
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

/// A right-hand side that is zero but for some blocks, as those of sources are.
template <class Scalar>
struct HeatSource {
  std::vector<int> blocks;                         // ascending
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> value;  // of these

  int block() const {  // unknowns of one
    return static_cast<int>(value.size() / std::max<Eigen::Index>(1, index(blocks.size())));
  }
  /// Of one block; null where it is zero.
  const Scalar* at(int i) const {
    const auto found = std::lower_bound(blocks.begin(), blocks.end(), i);
    if (found == blocks.end() || *found != i) return nullptr;
    return value.data() + (found - blocks.begin()) * block();
  }
};

/// The blocks of b that are not zero.
template <class Vector>
HeatSource<typename Vector::Scalar> nonzero_blocks(const Vector& b, int block) {
  HeatSource<typename Vector::Scalar> out;
  for (Eigen::Index i = 0; i < b.size() / block; ++i)
    if (block_magnitude(b, i, block) > 0) out.blocks.push_back(static_cast<int>(i));
  out.value.resize(index(out.blocks.size()) * block);
  for (std::size_t s = 0; s < out.blocks.size(); ++s)
    out.value.segment(index(s) * block, block) =
        b.segment(Eigen::Index{out.blocks[s]} * block, block);
  return out;
}

/// Largest entry of b in each piece; `piece` names the piece of every block, -1: none.
template <class Scalar>
std::vector<double> largest_of_pieces(const HeatSource<Scalar>& b, const std::vector<int>& piece) {
  if (piece.empty()) return {};
  std::vector<double> largest(*std::max_element(piece.begin(), piece.end()) + 1, 0.0);
  for (std::size_t s = 0; s < b.blocks.size(); ++s)
    if (const int p = piece[b.blocks[s]]; p >= 0)
      largest[p] = std::max(largest[p], block_magnitude(b.value, index(s), b.block()));
  return largest;
}

}  // namespace littoral
