// Blocks of supernodes: small ones factored by columns, which is half of the time of a first solve,
// and all passed by right-hand sides, most of that of a repeated one. Four doubles at once where
// the processor can, which is asked when the program runs.

#include "solve/direct/supernode_kernels.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/index.h"
#include "solve/direct/dense_products.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define LITTORAL_AVX2 __attribute__((target("avx2,fma")))
#endif

namespace littoral::dense {

namespace {

template <class Scalar>
using Column = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

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

enum class Into { replaced, added, subtracted };

/// y := A x, y + A x or y - A x, and x := x - A^* y, A m x n.
template <Into into, class Scalar>
void times_plain(int m, int n, const Scalar* A, int lda, const Scalar* x, Scalar* y) {
  Eigen::Map<Column<Scalar>> out(y, m);
  constexpr double sign = into == Into::subtracted ? -1 : 1;
  if (into == Into::replaced) out.setZero();
  for (int j = 0; j < n; ++j, A += lda)
    out += (sign * x[j]) * Eigen::Map<const Column<Scalar>>(A, m);
}

template <class Scalar>
void subtract_adjoint_plain(int m, int n, const Scalar* A, int lda, const Scalar* y, Scalar* x) {
  const Eigen::Map<const Column<Scalar>> in(y, m);
  for (int j = 0; j < n; ++j, A += lda) x[j] -= Eigen::Map<const Column<Scalar>>(A, m).dot(in);
}

#ifdef LITTORAL_AVX2

bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has;
}

/// A mask of the first k of four doubles.
LITTORAL_AVX2 inline __m256i first_of_four(int k) {
  alignas(32) static constexpr long long bits[8] = {-1, -1, -1, -1, 0, 0, 0, 0};
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(bits + 4 - k));
}

LITTORAL_AVX2 inline double sum(__m256d v) {
  const __m128d pair = _mm_add_pd(_mm256_castpd256_pd128(v), _mm256_extractf128_pd(v, 1));
  return _mm_cvtsd_f64(_mm_add_sd(pair, _mm_unpackhi_pd(pair, pair)));
}

/// Puts s to y, or adds or subtracts it there.
template <Into into>
LITTORAL_AVX2 inline void put(double* y, __m256d s) {
  if constexpr (into == Into::added) s = _mm256_add_pd(_mm256_loadu_pd(y), s);
  if constexpr (into == Into::subtracted) s = _mm256_sub_pd(_mm256_loadu_pd(y), s);
  _mm256_storeu_pd(y, s);
}
template <Into into>
LITTORAL_AVX2 inline void put(double* y, __m256i mask, __m256d s) {
  if constexpr (into == Into::added) s = _mm256_add_pd(_mm256_maskload_pd(y, mask), s);
  if constexpr (into == Into::subtracted) s = _mm256_sub_pd(_mm256_maskload_pd(y, mask), s);
  _mm256_maskstore_pd(y, mask, s);
}

template <Into into>
LITTORAL_AVX2 void times(int m, int n, const double* A, int lda, const double* x, double* y) {
  int i = 0;
  for (; i + 8 <= m; i += 8) {
    __m256d s = _mm256_setzero_pd(), t = s;
    const double* a = A + i;
    for (int j = 0; j < n; ++j, a += lda) {
      const __m256d xj = _mm256_broadcast_sd(x + j);
      s = _mm256_fmadd_pd(_mm256_loadu_pd(a), xj, s);
      t = _mm256_fmadd_pd(_mm256_loadu_pd(a + 4), xj, t);
    }
    put<into>(y + i, s);
    put<into>(y + i + 4, t);
  }
  for (; i < m; i += 4) {
    const __m256i mask = first_of_four(std::min(4, m - i));
    __m256d s = _mm256_setzero_pd();
    const double* a = A + i;
    for (int j = 0; j < n; ++j, a += lda)
      s = _mm256_fmadd_pd(_mm256_maskload_pd(a, mask), _mm256_broadcast_sd(x + j), s);
    put<into>(y + i, mask, s);
  }
}

LITTORAL_AVX2 inline __m256d combined(__m256d re, __m256d im) {
  return _mm256_addsub_pd(re, _mm256_permute_pd(im, 5));
}

/// The same for complex numbers as pairs: y is a x's real part plus a's swapped pairs, turned, by
/// its imaginary part.
template <Into into>
LITTORAL_AVX2 void times(int m, int n, const Complex* A, int lda, const Complex* x, Complex* y) {
  const auto* in = reinterpret_cast<const double*>(x);
  int i = 0;
  for (; i + 4 <= m; i += 4) {
    __m256d s = _mm256_setzero_pd(), s_im = s, t = s, t_im = s;
    const auto* a = reinterpret_cast<const double*>(A + i);
    for (int j = 0; j < n; ++j, a += 2 * index(lda)) {
      const __m256d re = _mm256_broadcast_sd(in + 2 * j), im = _mm256_broadcast_sd(in + 2 * j + 1);
      const __m256d u = _mm256_loadu_pd(a), v = _mm256_loadu_pd(a + 4);
      s = _mm256_fmadd_pd(u, re, s);
      s_im = _mm256_fmadd_pd(u, im, s_im);
      t = _mm256_fmadd_pd(v, re, t);
      t_im = _mm256_fmadd_pd(v, im, t_im);
    }
    auto* out = reinterpret_cast<double*>(y + i);
    put<into>(out, combined(s, s_im));
    put<into>(out + 4, combined(t, t_im));
  }
  for (; i < m; i += 2) {
    const __m256i mask = first_of_four(2 * std::min(2, m - i));
    __m256d s = _mm256_setzero_pd(), s_im = s;
    const auto* a = reinterpret_cast<const double*>(A + i);
    for (int j = 0; j < n; ++j, a += 2 * index(lda)) {
      const __m256d u = _mm256_maskload_pd(a, mask);
      s = _mm256_fmadd_pd(u, _mm256_broadcast_sd(in + 2 * j), s);
      s_im = _mm256_fmadd_pd(u, _mm256_broadcast_sd(in + 2 * j + 1), s_im);
    }
    put<into>(reinterpret_cast<double*>(y + i), mask, combined(s, s_im));
  }
}

/// Up to four columns at once.
template <int columns>
LITTORAL_AVX2 void subtract_adjoint_of(int m, const double* A, std::ptrdiff_t lda, const double* y,
                                       double* x) {
  __m256d s[columns];
  for (auto& each : s) each = _mm256_setzero_pd();
  int i = 0;
  for (; i + 4 <= m; i += 4) {
    const __m256d in = _mm256_loadu_pd(y + i);
    for (int j = 0; j < columns; ++j)
      s[j] = _mm256_fmadd_pd(_mm256_loadu_pd(A + j * lda + i), in, s[j]);
  }
  if (i < m) {
    const __m256i mask = first_of_four(m - i);
    const __m256d in = _mm256_maskload_pd(y + i, mask);
    for (int j = 0; j < columns; ++j)
      s[j] = _mm256_fmadd_pd(_mm256_maskload_pd(A + j * lda + i, mask), in, s[j]);
  }
  for (int j = 0; j < columns; ++j) x[j] -= sum(s[j]);
}

template <int columns>
LITTORAL_AVX2 void subtract_adjoint_of(int m, const Complex* A, std::ptrdiff_t lda,
                                       const Complex* y, Complex* x) {
  // conj(a) y = (a_re y_re + a_im y_im, a_re y_im - a_im y_re): sums of a y, and of a by y's
  // swapped pairs.
  __m256d s[columns], t[columns];
  for (int j = 0; j < columns; ++j) s[j] = t[j] = _mm256_setzero_pd();
  const auto* from = reinterpret_cast<const double*>(y);
  int i = 0;
  for (; i + 2 <= m; i += 2) {
    const __m256d in = _mm256_loadu_pd(from + 2 * i), swapped = _mm256_permute_pd(in, 5);
    for (int j = 0; j < columns; ++j) {
      const __m256d a = _mm256_loadu_pd(reinterpret_cast<const double*>(A + j * lda + i));
      s[j] = _mm256_fmadd_pd(a, in, s[j]);
      t[j] = _mm256_fmadd_pd(a, swapped, t[j]);
    }
  }
  if (i < m) {
    const __m256i mask = first_of_four(2);
    const __m256d in = _mm256_maskload_pd(from + 2 * i, mask), swapped = _mm256_permute_pd(in, 5);
    for (int j = 0; j < columns; ++j) {
      const __m256d a = _mm256_maskload_pd(reinterpret_cast<const double*>(A + j * lda + i), mask);
      s[j] = _mm256_fmadd_pd(a, in, s[j]);
      t[j] = _mm256_fmadd_pd(a, swapped, t[j]);
    }
  }
  const __m256d minus_odd = _mm256_set_pd(-0.0, 0.0, -0.0, 0.0);
  for (int j = 0; j < columns; ++j) x[j] -= Complex(sum(s[j]), sum(_mm256_xor_pd(t[j], minus_odd)));
}

template <class Scalar>
LITTORAL_AVX2 void subtract_adjoint(int m, int n, const Scalar* A, int lda, const Scalar* y,
                                    Scalar* x) {
  if (n == 4) return subtract_adjoint_of<4>(m, A, lda, y, x);
  if (n == 3) return subtract_adjoint_of<3>(m, A, lda, y, x);
  if (n == 2) return subtract_adjoint_of<2>(m, A, lda, y, x);
  subtract_adjoint_of<1>(m, A, lda, y, x);
}

#endif

template <Into into, class Scalar>
void times_any(int m, int n, const Scalar* A, int lda, const Scalar* x, Scalar* y) {
#ifdef LITTORAL_AVX2
  if (has_avx2()) return times<into>(m, n, A, lda, x, y);
#endif
  times_plain<into>(m, n, A, lda, x, y);
}

/// n is four at most.
template <class Scalar>
void subtract_adjoint_any(int m, int n, const Scalar* A, int lda, const Scalar* y, Scalar* x) {
#ifdef LITTORAL_AVX2
  if (has_avx2()) return subtract_adjoint(m, n, A, lda, y, x);
#endif
  subtract_adjoint_plain(m, n, A, lda, y, x);
}

/// y := y - A r^*, or -A r^*, r being the first row of A, m x n; n is small.
template <Into into, class Scalar>
void subtract_by_first_row(int m, int n, const Scalar* A, int lda, Scalar* y) {
  constexpr double sign = into == Into::replaced ? -1 : 1;
  std::array<Scalar, small_supernode> x;
  for (int j = 0; j < n; ++j) x[j] = sign * Eigen::numext::conj(A[index(j) * lda]);
  times_any<into>(m, n, A, lda, x.data(), y);
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
    times_any<Into::subtracted>(n - j - w, w, D + w, height, x + j, x + j + w);
    if (j == 0)
      times_any<Into::replaced>(below, w, A, height, x, y);
    else
      times_any<Into::added>(below, w, A, height, x + j, y);
  }
}

template <class Scalar>
void backward_one(int n, int height, const Scalar* block, Scalar* v) {
  while (n > 0) {
    const int w = std::min(4, n);
    n -= w;
    const Scalar* D = block + n + index(n) * height;
    subtract_adjoint_any(height - n - w, w, D + w, height, v + n + w, v + n);
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
