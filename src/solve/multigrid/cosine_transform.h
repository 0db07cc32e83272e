#pragma once
// Cosine transforms of arrays in three dimensions, of any size.

#include <array>

#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// Orthonormal DCT-II along each axis of an n[0] x n[1] x n[2] array, first index fastest.
///
/// Done as products with the two halves of the cosine matrix (even and odd frequencies see the even
/// and the odd part of a line), which run at the speed of the machine's arithmetic: at the sizes
/// that fit into memory this is as fast as an FFT, and no size is slow. Time O(N (n0 + n1 + n2))
/// for N entries. S is double or float. Immutable.
template <class S = double>
class CosineTransform {
 public:
  using Vector = Eigen::Matrix<S, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic>;

  explicit CosineTransform(std::array<int, 3> n);

  /// Values -> coefficients, in place. Along each axis the even frequencies come first.
  void forward(Vector& values, const Task& task) const;
  /// Coefficients -> values, in place.
  void backward(Vector& coefficients, const Task& task) const;

  /// The frequency 0 .. n - 1 at each place along an axis.
  std::vector<int> frequencies(int axis) const;

 private:
  struct Axis {
    int n = 1;
    Matrix even;  // ceil(n/2) x ceil(n/2): frequencies x positions
    Matrix odd;   // floor(n/2) x floor(n/2)
  };
  void transform(Vector& v, int axis, bool forward, const Task& task) const;

  std::array<Axis, 3> axes_;
};

/// L phi = b on a regular grid by cosine transform: L = G^T G, G the differences along grid edges
/// over `spacing`, is diagonal there with the eigenvalues sum over axes of
/// (2 - 2 cos(pi k / n)) / spacing^2. S is double or float. Immutable.
template <class S = double>
class GridPoisson {
 public:
  using Vector = typename CosineTransform<S>::Vector;

  GridPoisson(std::array<int, 3> n, const Vec3& spacing);

  /// The solution of mean zero (the constant part of b is dropped), replacing b.
  void solve(Vector& b, const Task& task) const;

 private:
  CosineTransform<S> cosine_;
  std::array<int, 3> n_;
  std::array<Vector, 3> eigenvalues_;  // per axis, in the order of the coefficients
};

}  // namespace littoral
