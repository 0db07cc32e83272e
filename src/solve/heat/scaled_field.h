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

/// A right-hand side that is zero but for some blocks, as those of sources are.
template <class Scalar>
struct HeatSource {
  std::vector<int> blocks;                         // ascending
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> value;  // of these

  /// Of one block; null where it is zero.
  const Scalar* at(int i) const {
    const auto found = std::lower_bound(blocks.begin(), blocks.end(), i);
    if (found == blocks.end() || *found != i) return nullptr;
    return value.data() + (found - blocks.begin()) * (value.size() / index(blocks.size()));
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

constexpr std::size_t block_grain = 1 << 15;  // blocks, for loops over all of a field

/// Largest entry of b in each piece; `piece` names the piece of every block, -1: none.
template <class Vector>
std::vector<double> largest_of_pieces(const Vector& b, const std::vector<int>& piece) {
  if (piece.empty()) return {};
  const std::size_t n_pieces = *std::max_element(piece.begin(), piece.end()) + 1;
  const int block = b.size() / index(piece.size());
  const std::size_t grain =
      std::max(block_grain, n_pieces);  // so that the parts take little memory
  std::vector<std::vector<double>> parts((piece.size() + grain - 1) / grain);
  parallel_for(piece.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::vector<double>& largest = parts[begin / grain];
    largest.assign(n_pieces, 0.0);
    for (std::size_t i = begin; i < end; ++i)
      if (piece[i] >= 0)
        largest[piece[i]] = std::max(largest[piece[i]], block_magnitude(b, index(i), block));
  });
  for (std::size_t k = 1; k < parts.size(); ++k)
    for (std::size_t p = 0; p < n_pieces; ++p) parts[0][p] = std::max(parts[0][p], parts[k][p]);
  return std::move(parts[0]);
}

}  // namespace littoral
