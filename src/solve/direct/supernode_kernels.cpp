// Blocks of supernodes: small ones factored by columns, which is half of the time of a first solve,
// and all passed by right-hand sides, most of that of a repeated one.

#include "solve/direct/supernode_kernels.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/index.h"
#include "solve/direct/block_times.h"
#include "solve/direct/dense_products.h"

namespace littoral::dense {

namespace {

double product(double a, double b) { return a * b; }
Complex product(const Complex& a, const Complex& b) {  // C++'s own looks for infinities
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// x := L^-1 x and x := L^-* x for the top of a block.
template <class Scalar>
void forward_top(int n, int height, const Scalar* block, Scalar* x) {
  for (int j = 0; j < n; ++j, block += height) {
    const Scalar xj = x[j] /= std::real(block[j]);
    for (int i = j + 1; i < n; ++i) x[i] -= product(block[i], xj);
  }
}

template <class Scalar>
[[gnu::always_inline]] inline void backward_top(int n, int height, const Scalar* block, Scalar* x) {
  block += index(n) * height;
  for (int j = n; j-- > 0;) {
    block -= height;
    Scalar sum = x[j];
    for (int i = j + 1; i < n; ++i) sum -= product(Eigen::numext::conj(block[i]), x[i]);
    x[j] = sum * (1 / std::real(block[j]));
  }
}

/// y := y - A r^*, or -A r^*, r being the first row of A, m x n; n is small.
template <Into into, class Scalar>
void subtract_by_first_row(int m, int n, const Scalar* A, int lda, Scalar* y) {
  constexpr double sign = into == Into::replaced ? -1 : 1;
  std::array<Scalar, small_supernode> x;
  for (int j = 0; j < n; ++j) x[j] = sign * Eigen::numext::conj(A[index(j) * lda]);
  times<into>(m, n, A, lda, x.data(), y);
}

/// Factors n columns in place, all `rows` of them, one after the other; n is small.
template <class Scalar>
bool factor_by_columns(int n, int rows, Scalar* A, int lda) {
  for (int j = 0; j < n; ++j) {
    Scalar* column = A + j + index(j) * lda;
    subtract_by_first_row<Into::subtracted>(rows - j, j, A + j, lda, column);
    const double pivot = std::real(column[0]);
    if (!(pivot > 0) || !std::isfinite(pivot)) return false;
    const double root = std::sqrt(pivot), factor = 1 / root;
    column[0] = root;
    for (int i = 1; i < rows - j; ++i) column[i] *= factor;
  }
  return true;
}

constexpr int few = 4;     // right-hand sides that pass one by one
constexpr int panel = 24;  // columns that right-hand sides pass at once
static_assert(small_supernode <= panel);

template <class Scalar>
void forward_one(int n, int height, const Scalar* block, Scalar* x, Scalar* y) {
  const int below = height - n;
  for (int j = 0; j < n; j += panel) {
    const int w = std::min(panel, n - j);
    const Scalar *D = block + j + index(j) * height, *A = block + n + index(j) * height;
    forward_top(w, height, D, x + j);
    times<Into::subtracted>(n - j - w, w, D + w, height, x + j, x + j + w);
    if (j == 0)
      times<Into::replaced>(below, w, A, height, x, y);
    else
      times<Into::added>(below, w, A, height, x + j, y);
  }
}

template <class Scalar>
void backward_one(int n, int height, const Scalar* block, Scalar* v) {
  while (n > 0) {
    const int w = std::min(4, n);
    n -= w;
    const Scalar* D = block + n + index(n) * height;
    subtract_adjoint(height - n - w, w, D + w, height, v + n + w, v + n);
    backward_top(w, height, D, v + n);
  }
}

}  // namespace

template <class Scalar>
bool cholesky(int n, Scalar* A, int lda) {
  for (int j = 0; j < n; j += small_supernode) {
    const int w = std::min(small_supernode, n - j), below = n - j - w;
    Scalar *D = A + j + index(j) * lda, *B = D + w;
    if (!factor_by_columns(w, w, D, lda)) return false;
    solve_right(below, w, D, lda, B, lda);
    subtract_product<Scalar>(below, below, w, {B, 1, lda}, {B, lda, 1, true}, B + index(w) * lda,
                             lda, {.lower = true});
  }
  return true;
}

template <class Scalar>
bool factor_small(int n, int height, Scalar* block, Scalar* C) {
  if (!factor_by_columns(n, height, block, height)) return false;
  const int below = height - n;
  for (int j = 0; j < below; ++j, C += below + 1) {
    subtract_by_first_row<Into::replaced>(below - j, n, block + n + j, height, C);
    C[0] = std::real(C[0]);
  }
  return true;
}

template <class Scalar>
void forward(int n, int height, int k, const Scalar* block, Scalar* x, int ldx, Scalar* y,
             int ldy) {
  if (k <= few) {
    for (int c = 0; c < k; ++c)
      forward_one(n, height, block, x + index(c) * ldx, y + index(c) * ldy);
    return;
  }
  for (int j = 0; j < n; j += panel) {
    const int w = std::min(panel, n - j);
    const Scalar* D = block + j + index(j) * height;
    for (int c = 0; c < k; ++c) forward_top(w, height, D, x + j + index(c) * ldx);
    subtract_product<Scalar>(n - j - w, k, w, {D + w, 1, height}, {x + j, 1, ldx}, x + j + w, ldx);
  }
  const int below = height - n;
  subtract_product<Scalar>(below, k, n, {block + n, 1, height}, {x, 1, ldx}, y, ldy,
                           {.from_zero = true});
  for (int c = 0; c < k; ++c)
    for (int i = 0; i < below; ++i) y[i + index(c) * ldy] = -y[i + index(c) * ldy];
}

template <class Scalar>
void backward(int n, int height, int k, const Scalar* block, Scalar* v, int ldv) {
  if (k <= few) {
    for (int c = 0; c < k; ++c) backward_one(n, height, block, v + index(c) * ldv);
    return;
  }
  subtract_product<Scalar>(n, k, height - n, {block + n, height, 1, true}, {v + n, 1, ldv}, v, ldv);
  for (int j = (n - 1) / panel * panel; j >= 0; j -= panel) {
    const int w = std::min(panel, n - j);
    for (int c = 0; c < k; ++c)
      backward_top(w, height, block + j + index(j) * height, v + j + index(c) * ldv);
    subtract_product<Scalar>(j, k, w, {block + j, height, 1, true}, {v + j, 1, ldv}, v, ldv);
  }
}

#define LITTORAL_SUPERNODES(S)                                      \
  template bool cholesky(int, S*, int);                             \
  template bool factor_small(int, int, S*, S*);                     \
  template void forward(int, int, int, const S*, S*, int, S*, int); \
  template void backward(int, int, int, const S*, S*, int);
LITTORAL_SUPERNODES(double)
LITTORAL_SUPERNODES(Complex)
#undef LITTORAL_SUPERNODES

}  // namespace littoral::dense
