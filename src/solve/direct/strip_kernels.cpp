// Strips of right-hand sides on one supernode and through sparse rows. Four doubles at once where
// the processor can, which is asked when the program runs.

#include <Eigen/Core>
#include <algorithm>
#include <utility>

#include "base/index.h"
#include "base/kernel_choice.h"
#include "solve/direct/strip_solve.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define LITTORAL_STRIP_AVX2 __attribute__((target("avx2,fma")))
#endif

namespace littoral::dense {

namespace {

constexpr int width = strip_width;
using StripRow = Eigen::Array<double, 1, width, Eigen::RowMajor>;

Eigen::Map<StripRow> row_at(double* strip, std::ptrdiff_t i) {
  return Eigen::Map<StripRow>(strip + width * i);
}
Eigen::Map<const StripRow> row_at(const double* strip, std::ptrdiff_t i) {
  return Eigen::Map<const StripRow>(strip + width * i);
}

}  // namespace

void forward_plain(int n, int height, const double* block, double* own, double* strip,
                   const int* rows) {
  for (int j = 0; j < n; ++j, block += height) {
    const StripRow pivot = row_at(own, j) * (1 / block[j]);
    row_at(own, j) = pivot;
    for (int i = j + 1; i < n; ++i) row_at(own, i) -= block[i] * pivot;
    for (int i = n; i < height; ++i) row_at(strip, rows[i - n]) -= block[i] * pivot;
  }
}

void backward_plain(int n, int height, const double* block, double* own, const double* strip,
                    const int* rows) {
  block += index(n) * height;
  for (int j = n; j-- > 0;) {
    block -= height;
    StripRow pivot = row_at(own, j);
    for (int i = n; i < height; ++i) pivot -= block[i] * row_at(strip, rows[i - n]);
    for (int i = j + 1; i < n; ++i) pivot -= block[i] * row_at(own, i);
    row_at(own, j) = pivot * (1 / block[j]);
  }
}

void residual_plain(int n, const int* begin, const int* to, const double* a, const double* b,
                    const double* x, double* r, double* sums) {
  StripRow r2 = StripRow::Zero(), b2 = r2, x2 = r2;
  for (int i = 0; i < n; ++i) {
    StripRow left = row_at(b, i);
    b2 += left.square();
    for (int e = begin[i]; e < begin[i + 1]; ++e) left -= a[e] * row_at(x, to[e]);
    r2 += left.square();
    x2 += row_at(x, i).square();
    if (r) row_at(r, i) = left;
  }
  row_at(sums, 0) = r2;
  row_at(sums, 1) = b2;
  row_at(sums, 2) = x2;
}

namespace {

#ifdef LITTORAL_STRIP_AVX2

constexpr int quads = width / 4;

bool strips_by_avx2() { return fused_instructions() != Instructions::plain; }

/// Sums for some rows of a strip, quad by quad. They stay in registers only if all subscripts are
/// constants, which loops are not yet where compilers decide that.
template <int some>
struct StripSums {
  __m256d s[some * quads];
  using Each = std::make_integer_sequence<int, some * quads>;

  template <int... n>
  [[gnu::always_inline]] LITTORAL_STRIP_AVX2 inline void load(const double* const* from,
                                                              std::integer_sequence<int, n...>) {
    ((s[n] = _mm256_loadu_pd(from[n % some] + 4 * (n / some))), ...);
  }
  template <int... n>
  [[gnu::always_inline]] LITTORAL_STRIP_AVX2 inline void store(
      double* const* to, std::integer_sequence<int, n...>) const {
    (_mm256_storeu_pd(to[n % some] + 4 * (n / some), s[n]), ...);
  }
  /// Subtracts the row x times a, a + stride, ...
  template <int... n>
  [[gnu::always_inline]] LITTORAL_STRIP_AVX2 inline void subtract(
      const double* a, std::ptrdiff_t stride, const double* x, std::integer_sequence<int, n...>) {
    ((s[n] = _mm256_fnmadd_pd(_mm256_broadcast_sd(a + n % some * stride),
                              _mm256_loadu_pd(x + 4 * (n / some)), s[n])),
     ...);
  }
};

/// to_r := to_r - sum_j A_rj own_j for some rows r of A, n columns `lda` apart.
template <int some>
LITTORAL_STRIP_AVX2 inline void subtract_rows(int n, const double* A, std::ptrdiff_t lda,
                                              const double* own, double* const* to) {
  using Each = typename StripSums<some>::Each;
  StripSums<some> sums;
  sums.load(to, Each());
  for (int j = 0; j < n; ++j, A += lda, own += width) sums.subtract(A, 1, own, Each());
  sums.store(to, Each());
}

LITTORAL_STRIP_AVX2 void forward_avx2(int n, int height, const double* block, double* own,
                                      double* strip, const int* rows) {
  constexpr int panel = 8;
  for (int j = 0; j < n; j += panel) {
    const double* const A = block + index(j) * height;
    double* const first = own + width * j;
    const int end = std::min(n, j + panel);
    for (int i = j; i < end; ++i) {
      double* const to[1] = {own + width * i};
      subtract_rows<1>(i - j, A + i, height, first, to);
      const __m256d inverse = _mm256_set1_pd(1 / block[i + index(i) * height]);
      for (int q = 0; q < quads; ++q)
        _mm256_storeu_pd(to[0] + 4 * q, _mm256_mul_pd(inverse, _mm256_loadu_pd(to[0] + 4 * q)));
    }
    int i = end;
    for (; i + 2 <= n; i += 2) {
      double* const to[2] = {own + width * i, own + width * (i + 1)};
      subtract_rows<2>(end - j, A + i, height, first, to);
    }
    if (i < n) {
      double* const to[1] = {own + width * i};
      subtract_rows<1>(end - j, A + i, height, first, to);
    }
  }
  const int below = height - n;
  int i = 0;
  for (; i + 3 <= below; i += 3) {
    double* const to[3] = {strip + width * index(rows[i]), strip + width * index(rows[i + 1]),
                           strip + width * index(rows[i + 2])};
    subtract_rows<3>(n, block + n + i, height, own, to);
  }
  for (; i + 2 <= below; i += 2) {
    double* const to[2] = {strip + width * index(rows[i]), strip + width * index(rows[i + 1])};
    subtract_rows<2>(n, block + n + i, height, own, to);
  }
  if (i < below) {
    double* const to[1] = {strip + width * index(rows[i])};
    subtract_rows<1>(n, block + n + i, height, own, to);
  }
}

/// own := L^-T (own - A^T x) for some columns, of which `rest` more rows of the supernode and
/// `below` others are known.
template <int some>
LITTORAL_STRIP_AVX2 inline void backward_columns(int rest, int below, const double* A,
                                                 std::ptrdiff_t lda, double* own,
                                                 const double* strip, const int* rows) {
  using Each = typename StripSums<some>::Each;
  double* to[some];
  for (int c = 0; c < some; ++c) to[c] = own + width * c;
  StripSums<some> sums;
  sums.load(to, Each());
  const double* a = A + some;
  const double* x = own + width * some;
  for (int i = 0; i < rest; ++i, ++a, x += width) sums.subtract(a, lda, x, Each());
  for (int i = 0; i < below; ++i, ++a)
    sums.subtract(a, lda, strip + width * index(rows[i]), Each());
  sums.store(to, Each());
  for (int c = some; c-- > 0;) {
    const __m256d inverse = _mm256_set1_pd(1 / A[c + c * lda]);
    for (int q = 0; q < quads; ++q) {
      __m256d sum = _mm256_loadu_pd(to[c] + 4 * q);
      for (int d = c + 1; d < some; ++d)
        sum = _mm256_fnmadd_pd(_mm256_broadcast_sd(A + d + c * lda), _mm256_loadu_pd(to[d] + 4 * q),
                               sum);
      _mm256_storeu_pd(to[c] + 4 * q, _mm256_mul_pd(inverse, sum));
    }
  }
}

LITTORAL_STRIP_AVX2 void backward_avx2(int n, int height, const double* block, double* own,
                                       const double* strip, const int* rows) {
  int j = n;
  const auto corner = [=](int k) { return block + k + index(k) * height; };
  for (; j >= 3; j -= 3)
    backward_columns<3>(n - j, height - n, corner(j - 3), height, own + width * (j - 3), strip,
                        rows);
  if (j == 2) backward_columns<2>(n - 2, height - n, corner(0), height, own, strip, rows);
  if (j == 1) backward_columns<1>(n - 1, height - n, corner(0), height, own, strip, rows);
}

LITTORAL_STRIP_AVX2 void residual_avx2(int n, const int* begin, const int* to, const double* a,
                                       const double* b, const double* x, double* r, double* sums) {
  __m256d all[3][quads];
  for (auto& each : all)
    for (auto& s : each) s = _mm256_setzero_pd();
  for (int i = 0; i < n; ++i) {
    __m256d left[quads];
    for (int q = 0; q < quads; ++q) {
      left[q] = _mm256_loadu_pd(b + width * index(i) + 4 * q);
      all[1][q] = _mm256_fmadd_pd(left[q], left[q], all[1][q]);
    }
    for (int e = begin[i]; e < begin[i + 1]; ++e) {
      const __m256d value = _mm256_broadcast_sd(a + e);
      const double* const from = x + width * index(to[e]);
      for (int q = 0; q < quads; ++q)
        left[q] = _mm256_fnmadd_pd(value, _mm256_loadu_pd(from + 4 * q), left[q]);
    }
    for (int q = 0; q < quads; ++q) {
      const __m256d own = _mm256_loadu_pd(x + width * index(i) + 4 * q);
      all[0][q] = _mm256_fmadd_pd(left[q], left[q], all[0][q]);
      all[2][q] = _mm256_fmadd_pd(own, own, all[2][q]);
      if (r) _mm256_storeu_pd(r + width * index(i) + 4 * q, left[q]);
    }
  }
  for (int k = 0; k < 3; ++k)
    for (int q = 0; q < quads; ++q) _mm256_storeu_pd(sums + width * k + 4 * q, all[k][q]);
}

#endif

}  // namespace

void forward_strip(int n, int height, const double* block, double* own, double* strip,
                   const int* rows) {
#ifdef LITTORAL_STRIP_AVX2
  if (strips_by_avx2()) return forward_avx2(n, height, block, own, strip, rows);
#endif
  forward_plain(n, height, block, own, strip, rows);
}

void backward_strip(int n, int height, const double* block, double* own, const double* strip,
                    const int* rows) {
#ifdef LITTORAL_STRIP_AVX2
  if (strips_by_avx2()) return backward_avx2(n, height, block, own, strip, rows);
#endif
  backward_plain(n, height, block, own, strip, rows);
}

void residual_strip(int n, const int* begin, const int* to, const double* a, const double* b,
                    const double* x, double* r, double* sums) {
#ifdef LITTORAL_STRIP_AVX2
  if (strips_by_avx2()) return residual_avx2(n, begin, to, a, b, x, r, sums);
#endif
  residual_plain(n, begin, to, a, b, x, r, sums);
}

}  // namespace littoral::dense
