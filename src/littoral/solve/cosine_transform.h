#pragma once
// Cosine transforms of arrays in three dimensions, of any size.

#include <array>

#include "littoral/base/task.h"
#include "littoral/base/types.h"

namespace littoral {

/// Orthonormal DCT-II along each axis of an n[0] x n[1] x n[2] array, first index fastest.
///
/// Done as products with the two halves of the cosine matrix (even and odd frequencies see the even
/// and the odd part of a line), which run at the speed of the machine's arithmetic: at the sizes
/// that fit into memory this is as fast as an FFT, and no size is slow. Time O(N (n0 + n1 + n2))
/// for N entries. Immutable.
class CosineTransform {
 public:
  explicit CosineTransform(std::array<int, 3> n);

  /// Values -> coefficients, in place. Along each axis the even frequencies come first.
  void forward(VecX& values, const Task& task) const;
  /// Coefficients -> values, in place.
  void backward(VecX& coefficients, const Task& task) const;

  /// The frequency 0 .. n - 1 at each place along an axis.
  std::vector<int> frequencies(int axis) const;

 private:
  struct Axis {
    int n = 1;
    Eigen::MatrixXd even;  // ceil(n/2) x ceil(n/2): frequencies x positions
    Eigen::MatrixXd odd;   // floor(n/2) x floor(n/2)
  };
  void transform(VecX& v, int axis, bool forward, const Task& task) const;

  std::array<Axis, 3> axes_;
};

/// L phi = b on a regular grid by cosine transform: L = G^T G, G the differences along grid edges
/// over `spacing`, is diagonal there with the eigenvalues sum over axes of
/// (2 - 2 cos(pi k / n)) / spacing^2. Immutable.
class GridPoisson {
 public:
  GridPoisson(std::array<int, 3> n, const Vec3& spacing);

  /// The solution of mean zero (the constant part of b is dropped), replacing b.
  void solve(VecX& b, const Task& task) const;

 private:
  CosineTransform cosine_;
  std::array<int, 3> n_;
  std::array<VecX, 3> eigenvalues_;  // per axis, in the order of the coefficients
};

}  // namespace littoral
