#include "solve/direct/block_times.h"

#include <Eigen/Core>
#include <algorithm>

#include "base/index.h"
#include "base/kernel_choice.h"
#include "littoral/types.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define LITTORAL_AVX2 __attribute__((target("avx2,fma")))
#define LITTORAL_WITH_AVX512 __attribute__((target(LITTORAL_AVX512 ",avx2,fma")))
#endif

namespace littoral::dense {

namespace {

template <class Scalar>
using Column = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

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
LITTORAL_AVX2 void times_by_four(int m, int n, const double* A, int lda, const double* x,
                                 double* y) {
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
LITTORAL_AVX2 void times_by_four(int m, int n, const Complex* A, int lda, const Complex* x,
                                 Complex* y) {
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

bool has_avx512() {
  static const bool has = has_avx2() && LITTORAL_HAS_AVX512;
  return has;
}

template <Into into>
LITTORAL_WITH_AVX512 inline void put(double* y, __mmask8 mask, __m512d s) {
  if constexpr (into == Into::added) s = _mm512_add_pd(_mm512_maskz_loadu_pd(mask, y), s);
  if constexpr (into == Into::subtracted) s = _mm512_sub_pd(_mm512_maskz_loadu_pd(mask, y), s);
  _mm512_mask_storeu_pd(y, mask, s);
}

/// Sixteen rows of A x at a time, and the rest by eight.
template <Into into>
LITTORAL_WITH_AVX512 void times_by_eight(int m, int n, const double* A, int lda, const double* x,
                                         double* y) {
  int i = 0;
  for (; i + 16 <= m; i += 16) {
    __m512d s = _mm512_setzero_pd(), t = s;
    const double* a = A + i;
    for (int j = 0; j < n; ++j, a += lda) {
      const __m512d xj = _mm512_set1_pd(x[j]);
      s = _mm512_fmadd_pd(_mm512_loadu_pd(a), xj, s);
      t = _mm512_fmadd_pd(_mm512_loadu_pd(a + 8), xj, t);
    }
    put<into>(y + i, 0xff, s);
    put<into>(y + i + 8, 0xff, t);
  }
  for (; i < m; i += 8) {
    const auto mask = static_cast<__mmask8>((1u << std::min(8, m - i)) - 1);
    __m512d s = _mm512_setzero_pd();
    const double* a = A + i;
    for (int j = 0; j < n; ++j, a += lda)
      s = _mm512_fmadd_pd(_mm512_maskz_loadu_pd(mask, a), _mm512_set1_pd(x[j]), s);
    put<into>(y + i, mask, s);
  }
}

// By a mask of all, as what GCC makes of the plain permutation is warned about.
LITTORAL_WITH_AVX512 inline __m512d combined(__m512d re, __m512d im) {
  return _mm512_fmaddsub_pd(re, _mm512_set1_pd(1), _mm512_maskz_permute_pd(0xff, im, 0x55));
}

template <Into into>
LITTORAL_WITH_AVX512 void times_by_eight(int m, int n, const Complex* A, int lda, const Complex* x,
                                         Complex* y) {
  const auto* in = reinterpret_cast<const double*>(x);
  int i = 0;
  for (; i + 8 <= m; i += 8) {
    __m512d s = _mm512_setzero_pd(), s_im = s, t = s, t_im = s;
    const auto* a = reinterpret_cast<const double*>(A + i);
    for (int j = 0; j < n; ++j, a += 2 * index(lda)) {
      const __m512d re = _mm512_set1_pd(in[2 * j]), im = _mm512_set1_pd(in[2 * j + 1]);
      const __m512d u = _mm512_loadu_pd(a), v = _mm512_loadu_pd(a + 8);
      s = _mm512_fmadd_pd(u, re, s);
      s_im = _mm512_fmadd_pd(u, im, s_im);
      t = _mm512_fmadd_pd(v, re, t);
      t_im = _mm512_fmadd_pd(v, im, t_im);
    }
    auto* out = reinterpret_cast<double*>(y + i);
    put<into>(out, 0xff, combined(s, s_im));
    put<into>(out + 8, 0xff, combined(t, t_im));
  }
  for (; i < m; i += 4) {
    const auto mask = static_cast<__mmask8>((1u << 2 * std::min(4, m - i)) - 1);
    __m512d s = _mm512_setzero_pd(), s_im = s;
    const auto* a = reinterpret_cast<const double*>(A + i);
    for (int j = 0; j < n; ++j, a += 2 * index(lda)) {
      const __m512d u = _mm512_maskz_loadu_pd(mask, a);
      s = _mm512_fmadd_pd(u, _mm512_set1_pd(in[2 * j]), s);
      s_im = _mm512_fmadd_pd(u, _mm512_set1_pd(in[2 * j + 1]), s_im);
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
LITTORAL_AVX2 void subtract_adjoint_by_four(int m, int n, const Scalar* A, int lda, const Scalar* y,
                                            Scalar* x) {
  if (n == 4) return subtract_adjoint_of<4>(m, A, lda, y, x);
  if (n == 3) return subtract_adjoint_of<3>(m, A, lda, y, x);
  if (n == 2) return subtract_adjoint_of<2>(m, A, lda, y, x);
  subtract_adjoint_of<1>(m, A, lda, y, x);
}

#endif

}  // namespace

template <Into into, class Scalar>
void times(int m, int n, const Scalar* A, int lda, const Scalar* x, Scalar* y,
           [[maybe_unused]] Instructions allowed) {
#ifdef LITTORAL_AVX2
  if (has_avx512() && allowed == Instructions::any) return times_by_eight<into>(m, n, A, lda, x, y);
  if (has_avx2() && allowed != Instructions::plain) return times_by_four<into>(m, n, A, lda, x, y);
#endif
  times_plain<into>(m, n, A, lda, x, y);
}

template <class Scalar>
void subtract_adjoint(int m, int n, const Scalar* A, int lda, const Scalar* y, Scalar* x,
                      [[maybe_unused]] Instructions allowed) {
#ifdef LITTORAL_AVX2
  if (has_avx2() && allowed != Instructions::plain)
    return subtract_adjoint_by_four(m, n, A, lda, y, x);
#endif
  subtract_adjoint_plain(m, n, A, lda, y, x);
}

#define LITTORAL_BLOCK_TIMES(S)                                                               \
  template void times<Into::replaced>(int, int, const S*, int, const S*, S*, Instructions);   \
  template void times<Into::added>(int, int, const S*, int, const S*, S*, Instructions);      \
  template void times<Into::subtracted>(int, int, const S*, int, const S*, S*, Instructions); \
  template void subtract_adjoint(int, int, const S*, int, const S*, S*, Instructions);
LITTORAL_BLOCK_TIMES(double)
LITTORAL_BLOCK_TIMES(Complex)
#undef LITTORAL_BLOCK_TIMES

}  // namespace littoral::dense
