#include "solve/multigrid/cosine_transform.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/parallel.h"

namespace littoral {

namespace {

constexpr Eigen::Index columns_at_once = 128;

template <class S>
using Matrix = typename CosineTransform<S>::Matrix;
template <class S>
using Strided = Eigen::Map<Matrix<S>, 0, Eigen::OuterStride<>>;

/// Transforms the columns of V.
template <class S>
void transform_columns(const Matrix<S>& even, const Matrix<S>& odd, bool forward, Strided<S> V) {
  const Eigen::Index m = even.rows(), o = odd.rows();
  if (forward) {
    Matrix<S> E(m, V.cols()), O(o, V.cols());
    E.topRows(o) = V.topRows(o) + V.bottomRows(o).colwise().reverse();
    if (m > o) E.row(o) = V.row(o);
    O = V.topRows(o) - V.bottomRows(o).colwise().reverse();
    V.topRows(m).noalias() = even * E;
    V.bottomRows(o).noalias() = odd * O;
  } else {
    const Matrix<S> E = even.transpose() * V.topRows(m), O = odd.transpose() * V.bottomRows(o);
    V.topRows(o) = E.topRows(o) + O;
    if (m > o) V.row(o) = E.row(o);
    V.bottomRows(o) = (E.topRows(o) - O).colwise().reverse();
  }
}

/// Transforms the rows of V.
template <class S>
void transform_rows(const Matrix<S>& even, const Matrix<S>& odd, bool forward, Strided<S> V) {
  const Eigen::Index m = even.rows(), o = odd.rows();
  if (forward) {
    Matrix<S> E(V.rows(), m), O(V.rows(), o);
    E.leftCols(o) = V.leftCols(o) + V.rightCols(o).rowwise().reverse();
    if (m > o) E.col(o) = V.col(o);
    O = V.leftCols(o) - V.rightCols(o).rowwise().reverse();
    V.leftCols(m).noalias() = E * even.transpose();
    V.rightCols(o).noalias() = O * odd.transpose();
  } else {
    const Matrix<S> E = V.leftCols(m) * even, O = V.rightCols(o) * odd;
    V.leftCols(o) = E.leftCols(o) + O;
    if (m > o) V.col(o) = E.col(o);
    V.rightCols(o) = (E.leftCols(o) - O).rowwise().reverse();
  }
}

}  // namespace

template <class S>
CosineTransform<S>::CosineTransform(std::array<int, 3> n) {
  for (int a = 0; a < 3; ++a) {
    Axis& axis = axes_[a];
    axis.n = n[a];
    const int m = (axis.n + 1) / 2, o = axis.n / 2;
    const auto cosine = [&](int k, int j) {
      // The angle is reduced first: k (2 j + 1) may be large.
      const long long turn = static_cast<long long>(k) * (2 * j + 1) % (4LL * axis.n);
      return static_cast<S>(std::sqrt((k == 0 ? 1.0 : 2.0) / axis.n) *
                            std::cos(M_PI * static_cast<double>(turn) / (2.0 * axis.n)));
    };
    axis.even.resize(m, m);
    axis.odd.resize(o, o);
    for (int j = 0; j < m; ++j)
      for (int k = 0; k < m; ++k) axis.even(k, j) = cosine(2 * k, j);
    for (int j = 0; j < o; ++j)
      for (int k = 0; k < o; ++k) axis.odd(k, j) = cosine(2 * k + 1, j);
  }
}

template <class S>
std::vector<int> CosineTransform<S>::frequencies(int axis) const {
  std::vector<int> out;
  const int n = axes_[axis].n;
  for (int k = 0; k < n; k += 2) out.push_back(k);
  for (int k = 1; k < n; k += 2) out.push_back(k);
  return out;
}

template <class S>
void CosineTransform<S>::transform(Vector& v, int axis, bool forward, const Task& task) const {
  const auto& [n, even, odd] = axes_[axis];
  if (n == 1) return;
  Eigen::Index stride = 1;
  for (int a = 0; a < axis; ++a) stride *= axes_[a].n;
  // Columns of n entries where the axis runs fastest; elsewhere, in each slab of stride x n
  // entries, rows.
  if (axis == 0) {
    const Eigen::Index lines = v.size() / n;
    const std::size_t pieces = (lines + columns_at_once - 1) / columns_at_once;
    parallel_for(pieces, 1, [&, n = n, &even = even, &odd = odd](std::size_t p, std::size_t) {
      task.checkpoint();
      const Eigen::Index first = index(p) * columns_at_once;
      const Eigen::Index count = std::min(columns_at_once, lines - first);
      transform_columns<S>(even, odd, forward,
                           Strided<S>(v.data() + first * n, n, count, Eigen::OuterStride<>(n)));
    });
    return;
  }
  const Eigen::Index slabs = v.size() / (stride * n);
  const Eigen::Index blocks = (stride + columns_at_once - 1) / columns_at_once;
  parallel_for(slabs * blocks, 1, [&, n = n, &even = even, &odd = odd](std::size_t p, std::size_t) {
    task.checkpoint();
    const Eigen::Index slab = index(p) / blocks;
    const Eigen::Index first = index(p) % blocks * columns_at_once;
    const Eigen::Index count = std::min(columns_at_once, stride - first);
    transform_rows<S>(
        even, odd, forward,
        Strided<S>(v.data() + slab * stride * n + first, count, n, Eigen::OuterStride<>(stride)));
  });
}

template <class S>
void CosineTransform<S>::forward(Vector& values, const Task& task) const {
  for (int a = 0; a < 3; ++a) transform(values, a, true, task);
}

template <class S>
void CosineTransform<S>::backward(Vector& coefficients, const Task& task) const {
  for (int a = 2; a >= 0; --a) transform(coefficients, a, false, task);
}

template <class S>
GridPoisson<S>::GridPoisson(std::array<int, 3> n, const Vec3& spacing) : cosine_(n), n_(n) {
  for (int a = 0; a < 3; ++a) {
    const std::size_t s = a;
    eigenvalues_[s].resize(n[s]);
    const std::vector<int> frequencies = cosine_.frequencies(a);
    for (int i = 0; i < n[s]; ++i) {
      const double sine = std::sin(M_PI * frequencies[i] / (2.0 * n[s]));
      eigenvalues_[s][i] = static_cast<S>(4 * sine * sine / (spacing[a] * spacing[a]));
    }
  }
}

template <class S>
void GridPoisson<S>::solve(Vector& b, const Task& task) const {
  cosine_.forward(b, task);
  const Eigen::Index nx = n_[0], ny = n_[1];
  parallel_for(n_[2], 4, [&](std::size_t begin, std::size_t end) {
    task.checkpoint();
    for (Eigen::Index k = begin; k < index(end); ++k)
      for (Eigen::Index j = 0; j < ny; ++j) {
        const S yz = eigenvalues_[1][j] + eigenvalues_[2][k];
        b.segment((k * ny + j) * nx, nx).array() /= eigenvalues_[0].array() + yz;
      }
  });
  b[0] = 0;  // the constants
  cosine_.backward(b, task);
}

template class CosineTransform<double>;
template class CosineTransform<float>;
template class GridPoisson<double>;
template class GridPoisson<float>;

}  // namespace littoral
