#include "solve/direct/block_times.h"

#include <Eigen/Core>
#include <algorithm>
#include <utility>

#include "base/index.h"
#include "base/kernel_choice.h"
#include "base/vector_lanes.h"
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

/// The first n of some numbers, zeros to fill, and back.
template <class Lanes>
inline void load_first(Lanes& to, const double* from, int n) {
  to = Lanes{};
  for (int i = 0; i < n; ++i) to[i] = from[i];
}
template <class Lanes>
inline void store_first(double* to, const Lanes& from, int n) {
  for (int i = 0; i < n; ++i) to[i] = from[i];
}
#ifdef LITTORAL_AVX2
using Four = Wide<4>::Lanes;
using Eight = Wide<8>::Lanes;
/// A mask of the first k of four doubles.
LITTORAL_AVX2 inline __m256i first_of_four(int k) {
  alignas(32) static constexpr long long bits[8] = {-1, -1, -1, -1, 0, 0, 0, 0};
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(bits + 4 - k));
}
LITTORAL_AVX2 inline void load_first(Four& to, const double* from, int n) {
  to = Four(_mm256_maskload_pd(from, first_of_four(n)));
}
LITTORAL_AVX2 inline void store_first(double* to, const Four& from, int n) {
  _mm256_maskstore_pd(to, first_of_four(n), __m256d(from));
}
LITTORAL_WITH_AVX512 inline void load_first(Eight& to, const double* from, int n) {
  to = Eight(_mm512_maskz_loadu_pd(static_cast<__mmask8>((1u << n) - 1), from));
}
LITTORAL_WITH_AVX512 inline void store_first(double* to, const Eight& from, int n) {
  _mm512_mask_storeu_pd(to, static_cast<__mmask8>((1u << n) - 1), __m512d(from));
}
#endif

/// Lanes that are whole, or the last of a column: so many of them.
template <int width>
struct Whole {
  using Lanes = typename Wide<width>::Lanes;
  [[gnu::always_inline]] void load(Lanes& to, const double* from) const {
    littoral::load(to, from);
  }
  [[gnu::always_inline]] void store(double* to, const Lanes& from) const {
    littoral::store(to, from);
  }
};
template <int width>
struct First {
  using Lanes = typename Wide<width>::Lanes;
  int n;
  [[gnu::always_inline]] void load(Lanes& to, const double* from) const { load_first(to, from, n); }
  [[gnu::always_inline]] void store(double* to, const Lanes& from) const {
    store_first(to, from, n);
  }
};

/// Puts s to y, or adds or subtracts it there.
template <Into into, class Some, class Lanes>
[[gnu::always_inline]] inline void put(double* y, const Lanes& s, const Some& some) {
  Lanes before{};
  if constexpr (into != Into::replaced) some.load(before, y);
  if constexpr (into == Into::replaced) some.store(y, s);
  if constexpr (into == Into::added) some.store(y, Lanes(before + s));
  if constexpr (into == Into::subtracted) some.store(y, Lanes(before - s));
}

/// Products of complex numbers as pairs: what real parts gave, and, pairs swapped and turned, what
/// imaginary parts did.
template <class Lanes, int... i>
[[gnu::always_inline]] inline void combine(Lanes& re, const Lanes& im,
                                           std::integer_sequence<int, i...>) {
  constexpr int width = sizeof...(i);
  const Lanes swapped = __builtin_shufflevector(im, im, (i ^ 1)...);
  re = __builtin_shufflevector(Lanes(re - swapped), Lanes(re + swapped), (i + i % 2 * width)...);
}

/// Some rows of A x, as many as fill `vectors` registers of `width` doubles.
template <Into into, int width, int vectors, class Some>
[[gnu::always_inline]] inline void some_rows(const Some& some, int n, const double* A,
                                             std::ptrdiff_t lda, const double* x, double* y) {
  using Lanes = typename Wide<width>::Lanes;
  Lanes s[vectors] = {};
  for (int j = 0; j < n; ++j, A += lda)
#pragma GCC unroll 2
    for (int v = 0; v < vectors; ++v) {
      Lanes a;
      some.load(a, A + v * width);
      s[v] += a * x[j];
    }
  for (int v = 0; v < vectors; ++v) put<into>(y + v * width, s[v], some);
}
template <Into into, int width, int vectors, class Some>
[[gnu::always_inline]] inline void some_rows(const Some& some, int n, const Complex* A,
                                             std::ptrdiff_t lda, const Complex* x, Complex* y) {
  using Lanes = typename Wide<width>::Lanes;
  Lanes re[vectors] = {}, im[vectors] = {};
  for (int j = 0; j < n; ++j, A += lda)
#pragma GCC unroll 2
    for (int v = 0; v < vectors; ++v) {
      Lanes a;
      some.load(a, reinterpret_cast<const double*>(A) + v * width);
      re[v] += a * x[j].real();
      im[v] += a * x[j].imag();
    }
  for (int v = 0; v < vectors; ++v) {
    combine(re[v], im[v], std::make_integer_sequence<int, width>());
    put<into>(reinterpret_cast<double*>(y) + v * width, re[v], some);
  }
}

/// Two registers of rows at a time, and the rest by one.
template <Into into, int width, class Scalar>
[[gnu::always_inline]] inline void times_of(int m, int n, const Scalar* A, int lda, const Scalar* x,
                                            Scalar* y) {
  constexpr int doubles = int(sizeof(Scalar)) / int(sizeof(double)), rows = width / doubles;
  int i = 0;
  for (; i + 2 * rows <= m; i += 2 * rows)
    some_rows<into, width, 2>(Whole<width>{}, n, A + i, lda, x, y + i);
  for (; i < m; i += rows)
    some_rows<into, width, 1>(First<width>{doubles * std::min(rows, m - i)}, n, A + i, lda, x,
                              y + i);
}

template <Into into, class Scalar>
void times_plain(int m, int n, const Scalar* A, int lda, const Scalar* x, Scalar* y) {
  times_of<into, 2>(m, n, A, lda, x, y);
}

template <class Scalar>
void subtract_adjoint_plain(int m, int n, const Scalar* A, int lda, const Scalar* y, Scalar* x) {
  const Eigen::Map<const Column<Scalar>> in(y, m);
  for (int j = 0; j < n; ++j, A += lda) x[j] -= Eigen::Map<const Column<Scalar>>(A, m).dot(in);
}

#ifdef LITTORAL_AVX2

template <Into into, class Scalar>
LITTORAL_AVX2 void times_by_four(int m, int n, const Scalar* A, int lda, const Scalar* x,
                                 Scalar* y) {
  times_of<into, 4>(m, n, A, lda, x, y);
}
template <Into into, class Scalar>
LITTORAL_WITH_AVX512 void times_by_eight(int m, int n, const Scalar* A, int lda, const Scalar* x,
                                         Scalar* y) {
  times_of<into, 8>(m, n, A, lda, x, y);
}

LITTORAL_AVX2 inline double sum(__m256d v) {
  const __m128d pair = _mm_add_pd(_mm256_castpd256_pd128(v), _mm256_extractf128_pd(v, 1));
  return _mm_cvtsd_f64(_mm_add_sd(pair, _mm_unpackhi_pd(pair, pair)));
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
  const Instructions has = fused_instructions(allowed);
  if (has == Instructions::any) return times_by_eight<into>(m, n, A, lda, x, y);
  if (has == Instructions::avx2) return times_by_four<into>(m, n, A, lda, x, y);
#endif
  times_plain<into>(m, n, A, lda, x, y);
}

template <class Scalar>
void subtract_adjoint(int m, int n, const Scalar* A, int lda, const Scalar* y, Scalar* x,
                      [[maybe_unused]] Instructions allowed) {
#ifdef LITTORAL_AVX2
  if (fused_instructions(allowed) != Instructions::plain)
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
