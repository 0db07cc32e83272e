#pragma once
// The innermost loops of products of blocks and of solves with triangles, for any width of vectors.

#include <cstddef>
#include <utility>

#include "base/vector_lanes.h"
#include "littoral/types.h"

namespace littoral::dense {

/// A tile of the product: `vectors` of `width` rows times `columns`, as many as registers hold.
template <int width_, int vectors_, int columns_>
struct Tile {
  static constexpr int width = width_, vectors = vectors_, columns = columns_;
  static constexpr int rows = width * vectors;
};

/// C := C + a b, all of a tile, a and b as copied; `from_zero`: C := a b.
template <class T>
[[gnu::always_inline]] inline void add_tile(int k, const double* a, const double* b, double* C,
                                            std::ptrdiff_t ldc, bool from_zero) {
  using Lanes = typename Wide<T::width>::Lanes;
  Lanes sum[T::columns][T::vectors];
#pragma GCC unroll 16
  for (int j = 0; j < T::columns; ++j)
#pragma GCC unroll 4
    for (int v = 0; v < T::vectors; ++v) sum[j][v] = Lanes{};
  for (int l = 0; l < k; ++l, a += T::rows, b += T::columns) {
    Lanes x[T::vectors];
#pragma GCC unroll 4
    for (int v = 0; v < T::vectors; ++v) load(x[v], a + v * T::width);
#pragma GCC unroll 16
    for (int j = 0; j < T::columns; ++j) {
#pragma GCC unroll 4
      for (int v = 0; v < T::vectors; ++v) sum[j][v] += x[v] * b[j];
    }
  }
#pragma GCC unroll 16
  for (int j = 0; j < T::columns; ++j)
#pragma GCC unroll 4
    for (int v = 0; v < T::vectors; ++v) {
      Lanes c{};
      if (!from_zero) load(c, C + j * ldc + v * T::width);
      store(C + j * ldc + v * T::width, c + sum[j][v]);
    }
}

/// Adds complex numbers, given by their real and imaginary parts, or puts them there.
template <int width, class Lanes, int... i>
[[gnu::always_inline]] inline void add_pairs(const Lanes& re, const Lanes& im, double* to,
                                             bool from_zero, std::integer_sequence<int, i...>) {
  Lanes first{}, second{};
  if (!from_zero) {
    load(first, to);
    load(second, to + width);
  }
  store(to, first + __builtin_shufflevector(re, im, (i / 2 + i % 2 * width)...));
  store(to + width, second + __builtin_shufflevector(re, im, ((i + width) / 2 + i % 2 * width)...));
}

/// The same of complex numbers, C as doubles, ldc in complex numbers: three products of real
/// numbers, one after the other, where there could be four, as (a + i b)(c + i d) = ac - bd +
/// i ((a + b)(c + d) - ac - bd). Copied are all a of a tile, then all b, then all a + b.
template <class T>
[[gnu::always_inline]] inline void add_complex_tile(int k, const double* a, const double* b,
                                                    double* C, std::ptrdiff_t ldc, bool from_zero) {
  using Lanes = typename Wide<T::width>::Lanes;
  alignas(64) double sums[3][T::columns * T::rows];
  for (int p = 0; p < 3; ++p)
    add_tile<T>(k, a + std::ptrdiff_t(p) * k * T::rows, b + std::ptrdiff_t(p) * k * T::columns,
                sums[p], T::rows, true);
  for (int j = 0; j < T::columns; ++j)
    for (int v = 0; v < T::vectors; ++v) {
      const int at = j * T::rows + v * T::width;
      Lanes ac, bd, all;
      load(ac, sums[0] + at);
      load(bd, sums[1] + at);
      load(all, sums[2] + at);
      add_pairs<T::width>(Lanes(ac - bd), Lanes(all - ac - bd), C + 2 * (j * ldc + v * T::width),
                          from_zero, std::make_integer_sequence<int, T::width>());
    }
}

template <class T>
[[gnu::always_inline]] inline void add_tile_of(int k, const double* a, const double* b, double* C,
                                               std::ptrdiff_t ldc, bool from_zero) {
  add_tile<T>(k, a, b, C, ldc, from_zero);
}
template <class T>
[[gnu::always_inline]] inline void add_tile_of(int k, const double* a, const double* b, Complex* C,
                                               std::ptrdiff_t ldc, bool from_zero) {
  add_complex_tile<T>(k, a, b, reinterpret_cast<double*>(C), ldc, from_zero);
}

/// B := B L^-T, of `T::rows` rows of B, n x n.
template <class T>
[[gnu::always_inline]] inline void solve_rows_of(int n, const double* L, std::ptrdiff_t ldl,
                                                 double* B, std::ptrdiff_t ldb) {
  using Lanes = typename Wide<T::width>::Lanes;
  for (int j = 0; j < n; ++j) {
    double* to = B + j * ldb;
    Lanes x[T::vectors];
    for (int v = 0; v < T::vectors; ++v) load(x[v], to + v * T::width);
    for (int l = 0; l < j; ++l) {
      const double factor = L[j + l * ldl];
      const double* from = B + l * ldb;
      for (int v = 0; v < T::vectors; ++v) {
        Lanes b;
        load(b, from + v * T::width);
        x[v] -= b * factor;
      }
    }
    const double factor = 1 / L[j + j * ldl];
    for (int v = 0; v < T::vectors; ++v) store(to + v * T::width, x[v] * factor);
  }
}

/// B := B L^-*: b conj(l) is b re(l), and what it has in the other place by im(l).
template <class T>
[[gnu::always_inline]] inline void solve_rows_of(int n, const Complex* L, std::ptrdiff_t ldl,
                                                 Complex* B, std::ptrdiff_t ldb) {
  using Lanes = typename Wide<T::width>::Lanes;
  Lanes sign;
  for (int i = 0; i < T::width; ++i) sign[i] = i % 2 == 0 ? 1 : -1;
  for (int j = 0; j < n; ++j) {
    auto* to = reinterpret_cast<double*>(B + j * ldb);
    Lanes x[T::vectors], y[T::vectors];
    for (int v = 0; v < T::vectors; ++v) {
      load(x[v], to + v * T::width);
      y[v] = Lanes{};
    }
    for (int l = 0; l < j; ++l) {
      const double re = L[j + l * ldl].real(), im = L[j + l * ldl].imag();
      const auto* from = reinterpret_cast<const double*>(B + l * ldb);
      for (int v = 0; v < T::vectors; ++v) {
        Lanes b;
        load(b, from + v * T::width);
        x[v] -= b * re;
        y[v] += b * im;
      }
    }
    const double factor = 1 / L[j + j * ldl].real();
    for (int v = 0; v < T::vectors; ++v) {
      double swapped[T::width];
      for (int i = 0; i < T::width; ++i) swapped[i] = y[v][i ^ 1];
      Lanes turned;
      load(turned, swapped);
      store(to + v * T::width, (x[v] - turned * sign) * factor);
    }
  }
}

}  // namespace littoral::dense
