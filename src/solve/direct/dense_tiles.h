#pragma once
// The innermost loops of products of blocks and of solves with triangles, for any width of vectors.

#include <cstddef>

#include "base/vector_lanes.h"
#include "littoral/types.h"

namespace littoral::dense {

/// A tile of the product: `vectors` of `width` rows times `columns`, as many as registers hold.
template <int width_, int vectors_, int columns_>
struct Tile {
  static constexpr int width = width_, vectors = vectors_, columns = columns_;
  static constexpr int rows = width * vectors;
};

/// C := C + a b, all of a tile, a and b as copied.
template <class T>
[[gnu::always_inline]] inline void add_tile(int k, const double* a, const double* b, double* C,
                                            std::ptrdiff_t ldc) {
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
      Lanes c;
      load(c, C + j * ldc + v * T::width);
      store(C + j * ldc + v * T::width, c + sum[j][v]);
    }
}

/// The same of complex numbers; C as doubles, ldc in complex numbers.
template <class T>
[[gnu::always_inline]] inline void add_complex_tile(int k, const double* a, const double* b,
                                                    double* C, std::ptrdiff_t ldc) {
  using Lanes = typename Wide<T::width>::Lanes;
  Lanes re[T::columns][T::vectors], im[T::columns][T::vectors];
#pragma GCC unroll 16
  for (int j = 0; j < T::columns; ++j)
#pragma GCC unroll 4
    for (int v = 0; v < T::vectors; ++v) re[j][v] = im[j][v] = Lanes{};
  for (int l = 0; l < k; ++l, a += 2 * T::rows, b += 2 * T::columns) {
    Lanes x[T::vectors], y[T::vectors];
#pragma GCC unroll 4
    for (int v = 0; v < T::vectors; ++v) {
      load(x[v], a + v * T::width);
      load(y[v], a + T::rows + v * T::width);
    }
#pragma GCC unroll 16
    for (int j = 0; j < T::columns; ++j) {
#pragma GCC unroll 4
      for (int v = 0; v < T::vectors; ++v) {
        re[j][v] += x[v] * b[2 * j];
        im[j][v] += x[v] * b[2 * j + 1];
        re[j][v] -= y[v] * b[2 * j + 1];
        im[j][v] += y[v] * b[2 * j];
      }
    }
  }
  for (int j = 0; j < T::columns; ++j) {
    double real[T::rows], imaginary[T::rows];
    for (int v = 0; v < T::vectors; ++v) {
      store(real + v * T::width, re[j][v]);
      store(imaginary + v * T::width, im[j][v]);
    }
    double* c = C + 2 * j * ldc;
    for (int i = 0; i < T::rows; ++i) {
      c[2 * i] += real[i];
      c[2 * i + 1] += imaginary[i];
    }
  }
}

template <class T>
[[gnu::always_inline]] inline void add_tile_of(int k, const double* a, const double* b, double* C,
                                               std::ptrdiff_t ldc) {
  add_tile<T>(k, a, b, C, ldc);
}
template <class T>
[[gnu::always_inline]] inline void add_tile_of(int k, const double* a, const double* b, Complex* C,
                                               std::ptrdiff_t ldc) {
  add_complex_tile<T>(k, a, b, reinterpret_cast<double*>(C), ldc);
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
