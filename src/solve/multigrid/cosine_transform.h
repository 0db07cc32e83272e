#pragma once
// Cosine transforms of arrays in three dimensions, of any size, and the Poisson equation by them.

#include <array>
#include <functional>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"
#include "solve/multigrid/cosine_lines.h"

namespace littoral {

/// Orthonormal DCT-II along each axis of an n[0] x n[1] x n[2] array, first index fastest. Time
/// O(N (n0 + n1 + n2)) for N entries; at the sizes that fit into memory this is as fast as an FFT.
/// S is double or float. Immutable.
template <class S = double>
class CosineTransform {
 public:
  using Vector = Eigen::Matrix<S, Eigen::Dynamic, 1>;

  explicit CosineTransform(std::array<int, 3> n);

  /// Values -> coefficients, in place, each where `frequencies` says.
  void forward(Vector& values, const Task& task) const;
  /// Coefficients -> values, in place.
  void backward(Vector& coefficients, const Task& task) const;
  /// What coefficients at j and k along the last two axes are multiplied by, first index i .. i +
  /// n.
  using Factor = std::function<void(int i, int n, int j, int k, S* out)>;
  /// Whether each line along the first axis counts, the second index fastest; empty: all do.
  using Lines = std::vector<char>;
  /// Forward, times a factor, backward. Lines that are not `given` are taken for 0; those that are
  /// not `wanted` come out undefined.
  void filter(Vector& values, const Factor& factor, const Lines& given, const Lines& wanted,
              const Task& task) const;

  /// The frequency 0 .. n - 1 at each place along an axis.
  const std::vector<int>& frequencies(int axis) const { return lines_[axis].frequencies(); }

 private:
  void planes(Vector& v, bool forward, const Lines& used, const Task& task) const;
  void columns(Vector& v, bool forward, bool backward, const Factor& factor,
               const Task& task) const;

  std::array<int, 3> n_;
  std::array<CosineLines<S>, 3> lines_;
};

/// L phi = b on a regular grid by cosine transform: L = G^T G, G the differences along grid edges
/// over `spacing`, is diagonal there with the eigenvalues sum over axes of
/// (2 - 2 cos(pi k / n)) / spacing^2. S is double or float. Immutable.
template <class S = double>
class GridPoisson {
 public:
  using Vector = typename CosineTransform<S>::Vector;

  GridPoisson(std::array<int, 3> n, const Vec3& spacing);

  using Lines = typename CosineTransform<S>::Lines;

  /// The solution of mean zero (the constant part of b is dropped), replacing b; given and wanted
  /// as in CosineTransform::filter.
  void solve(Vector& b, const Task& task, const Lines& given = {}, const Lines& wanted = {}) const;

 private:
  CosineTransform<S> cosine_;
  std::array<Vector, 3> eigenvalues_;  // per axis, in the order of the coefficients
};

}  // namespace littoral
