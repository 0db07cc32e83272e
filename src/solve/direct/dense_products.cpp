#include "solve/direct/dense_products.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <type_traits>

#include "base/index.h"
#include "base/kernel_choice.h"
#include "littoral/types.h"
#include "solve/direct/dense_tiles.h"

namespace littoral::dense {

namespace {

// Bounds of what is copied at once: of A `deep` columns and `tall` rows, which stay in the cache of
// a core, of B `wide` columns. They do not depend on tiles, so that sums are made alike for all.
template <class Scalar>
constexpr int deep = std::is_same_v<Scalar, double> ? 256 : 128;
template <class Scalar>
constexpr int tall = std::is_same_v<Scalar, double> ? 192 : 96;
template <class Scalar>
constexpr int wide = std::is_same_v<Scalar, double> ? 1024 : 512;

constexpr int narrow = 32;  // columns of a triangle that rows are solved with

constexpr int up(int n, int step) { return (n + step - 1) / step * step; }

/// Copies of a thread's own.
struct Copies {
  static constexpr std::size_t a_size = 192 * 256 + 4096, b_size = 1024 * 256 + 8192;
  struct Free {
    void operator()(double* at) const { ::operator delete[](at, std::align_val_t(64)); }
  };
  using Array = std::unique_ptr<double[], Free>;
  static Array array(std::size_t size) {
    return Array(
        static_cast<double*>(::operator new[](size * sizeof(double), std::align_val_t(64))));
  }
  Array a = array(a_size), b = array(b_size);

  static_assert((a_size + b_size) * sizeof(double) <= bytes_of_copies);

  static const Copies& of_this_thread() {
    static thread_local const Copies copies;
    return copies;
  }
};

/// What the three products of complex numbers take of one.
[[gnu::always_inline]] inline void put(double real, double imaginary, double* to, int step) {
  to[0] = real;
  to[step] = imaginary;
  to[2 * step] = real + imaginary;
}

/// Rows of A, `rows` at a time and of each column one after the other, zeros to fill: of complex
/// numbers first all real parts, then all imaginary ones, then all sums of both.
template <int rows, class Scalar>
[[gnu::always_inline]] inline void copy_rows(int m, int k, const Operand<Scalar>& A, double* to) {
  [[maybe_unused]] const int step = k * rows;
  for (int i = 0; i < m; i += rows) {
    const int n = std::min(rows, m - i);
    const Scalar* from = A.at + i * A.row;
    for (int l = 0; l < k; ++l, from += A.column) {
      if constexpr (std::is_same_v<Scalar, double>) {
        if (n == rows && A.row == 1)
          for (int r = 0; r < rows; ++r) to[r] = from[r];
        else {
          for (int r = 0; r < n; ++r) to[r] = from[r * A.row];
          std::fill(to + n, to + rows, 0.0);
        }
        to += rows;
      } else {
        const double sign = A.conjugated ? -1 : 1;
        if (n == rows && A.row == 1)
          for (int r = 0; r < rows; ++r) put(from[r].real(), sign * from[r].imag(), to + r, step);
        else
          for (int r = 0; r < rows; ++r) {
            const Scalar a = r < n ? from[r * A.row] : Scalar(0);
            put(a.real(), sign * a.imag(), to + r, step);
          }
        to += rows;
      }
    }
    if constexpr (!std::is_same_v<Scalar, double>) to += 2 * step;
  }
}

/// Columns of -B, `columns` at a time and of each row one after the other.
template <int columns, class Scalar>
[[gnu::always_inline]] inline void copy_columns(int k, int n, const Operand<Scalar>& B,
                                                double* to) {
  [[maybe_unused]] const int step = k * columns;
  for (int j = 0; j < n; j += columns) {
    const int own = std::min(columns, n - j);
    const Scalar* from = B.at + j * B.column;
    for (int l = 0; l < k; ++l, from += B.row)
      for (int c = 0; c < columns; ++c) {
        const Scalar b = c < own ? from[c * B.column] : Scalar(0);
        if constexpr (std::is_same_v<Scalar, double>) {
          *to++ = -b;
        } else {
          put(-b.real(), B.conjugated ? b.imag() : -b.imag(), to++, step);
        }
      }
    if constexpr (!std::is_same_v<Scalar, double>) to += 2 * step;
  }
}

template <class Set, class Scalar>
void solve(int m, int n, const Scalar* L, int ldl, Scalar* B, int ldb) {
  constexpr int rows = Set::Rows::rows * int(sizeof(double)) / int(sizeof(Scalar));
  int i = 0;
  for (; i + rows <= m; i += rows) Set::solve_rows(n, L, ldl, B + i, ldb);
  if (i == m) return;
  Scalar last[rows * narrow] = {};
  for (int j = 0; j < n; ++j) std::copy_n(B + i + index(j) * ldb, m - i, last + j * rows);
  Set::solve_rows(n, L, ldl, last, rows);
  for (int j = 0; j < n; ++j) std::copy_n(last + j * rows, m - i, B + i + index(j) * ldb);
}

template <class Set, class Scalar>
void subtract(int m, int n, int k, const Operand<Scalar>& A, const Operand<Scalar>& B, Scalar* C,
              int ldc, const ProductOptions& options) {
  using T = typename Set::Tile;
  if (m == 0 || n == 0 || k == 0) {
    for (int j = 0; options.from_zero && j < n; ++j) {
      const int above = options.lower ? std::min(j, m) : 0;
      std::fill_n(C + above + index(j) * ldc, m - above, Scalar(0));
    }
    return;
  }
  constexpr int numbers = std::is_same_v<Scalar, double> ? 1 : 3;
  constexpr int high = tall<Scalar>, far = wide<Scalar>;
  static_assert(std::size_t(up(high, T::rows)) * deep<Scalar> * numbers <= Copies::a_size);
  static_assert(std::size_t(up(far, T::columns)) * deep<Scalar> * numbers <= Copies::b_size);
  const Copies& copies = Copies::of_this_thread();
  Scalar own[T::rows * T::columns];
  for (int j0 = 0; j0 < n; j0 += far) {
    const int columns = std::min(far, n - j0);
    for (int l0 = 0; l0 < k; l0 += deep<Scalar>) {
      const int depth = std::min(deep<Scalar>, k - l0);
      Set::copy_columns(
          depth, columns,
          Operand<Scalar>{B.at + l0 * B.row + j0 * B.column, B.row, B.column, B.conjugated},
          copies.b.get());
      for (int i0 = options.lower ? j0 / T::rows * T::rows : 0; i0 < m; i0 += high) {
        const int rows = std::min(high, m - i0);
        Set::copy_rows(
            rows, depth,
            Operand<Scalar>{A.at + i0 * A.row + l0 * A.column, A.row, A.column, A.conjugated},
            copies.a.get());
        for (int j = 0; j < columns; j += T::columns) {
          const double* b = copies.b.get() + std::ptrdiff_t(j) * depth * numbers;
          const int tile_columns = std::min(T::columns, columns - j);
          for (int i = 0; i < rows; i += T::rows) {
            const int first = i0 + i, column = j0 + j, tile_rows = std::min(T::rows, rows - i);
            if (options.lower && first + tile_rows <= column) continue;
            const double* a = copies.a.get() + std::ptrdiff_t(i) * depth * numbers;
            Scalar* c = C + first + index(column) * ldc;
            const bool below = !options.lower || first >= column + tile_columns;
            const bool from_zero = options.from_zero && l0 == 0;
            if (below && tile_rows == T::rows && tile_columns == T::columns) {
              Set::add(depth, a, b, c, ldc, from_zero);
              continue;
            }
            Set::add(depth, a, b, own, T::rows, true);
            for (int q = 0; q < tile_columns; ++q)
              for (int p = below ? 0 : std::max(0, column + q - first); p < tile_rows; ++p) {
                Scalar& to = c[p + q * std::ptrdiff_t(ldc)];
                to = (from_zero ? Scalar(0) : to) + own[p + q * T::rows];
                if (!below && first + p == column + q) to = std::real(to);
              }
          }
        }
      }
    }
  }
}

/// What is done by one set of instructions. Shapes: tiles of real and of complex numbers, and
/// rows that are solved at once.
#define LITTORAL_INSTRUCTIONS(Set, Shapes, target)                                                 \
  template <class Scalar>                                                                          \
  struct Set {                                                                                     \
    using Tile =                                                                                   \
        std::conditional_t<std::is_same_v<Scalar, double>, Shapes::Real, Shapes::Complex>;         \
    using Rows = Shapes::Rows;                                                                     \
    target static void add(int k, const double* a, const double* b, Scalar* C, std::ptrdiff_t ldc, \
                           bool from_zero) {                                                       \
      add_tile_of<Tile>(k, a, b, C, ldc, from_zero);                                               \
    }                                                                                              \
    target static void solve_rows(int n, const Scalar* L, std::ptrdiff_t ldl, Scalar* B,           \
                                  std::ptrdiff_t ldb) {                                            \
      solve_rows_of<Rows>(n, L, ldl, B, ldb);                                                      \
    }                                                                                              \
    target static void copy_rows(int m, int k, const Operand<Scalar>& A, double* to) {             \
      dense::copy_rows<Tile::rows>(m, k, A, to);                                                   \
    }                                                                                              \
    target static void copy_columns(int k, int n, const Operand<Scalar>& B, double* to) {          \
      dense::copy_columns<Tile::columns>(k, n, B, to);                                             \
    }                                                                                              \
  };

// Sixteen registers of two doubles, or thirty-two: sums and what they are made of.
struct PlainShapes {
#if defined(__aarch64__)
  using Real = Tile<2, 4, 6>;
#else
  using Real = Tile<2, 2, 4>;
#endif
  using Complex = Real;
  using Rows = Tile<2, 4, 0>;
};
LITTORAL_INSTRUCTIONS(Plain, PlainShapes, )

#if defined(__x86_64__)
struct Avx2Shapes {
  using Real = Tile<4, 2, 6>;
  using Complex = Real;
  using Rows = Tile<4, 4, 0>;
};
LITTORAL_INSTRUCTIONS(Avx2, Avx2Shapes, [[gnu::target("avx2,fma")]])
struct Avx512Shapes {
  using Real = Tile<8, 2, 12>;
  using Complex = Tile<8, 2, 6>;  // as fast, and less of it beyond the edges of blocks
  using Rows = Tile<8, 4, 0>;
};
LITTORAL_INSTRUCTIONS(Avx512, Avx512Shapes, [[gnu::target(LITTORAL_AVX512 ",avx2,fma")]])
#endif
#undef LITTORAL_INSTRUCTIONS

template <class Scalar>
struct Kernels {
  void (*subtract)(int, int, int, const Operand<Scalar>&, const Operand<Scalar>&, Scalar*, int,
                   const ProductOptions&);
  void (*solve)(int, int, const Scalar*, int, Scalar*, int);

  template <class Set>
  static constexpr Kernels of() {
    return {&dense::subtract<Set, Scalar>, &dense::solve<Set, Scalar>};
  }
};

template <class Scalar>
const Kernels<Scalar>& kernels([[maybe_unused]] Instructions allowed) {
  static constexpr auto plain = Kernels<Scalar>::template of<Plain<Scalar>>();
#if defined(__x86_64__)
  static constexpr auto avx2 = Kernels<Scalar>::template of<Avx2<Scalar>>();
  static constexpr auto avx512 = Kernels<Scalar>::template of<Avx512<Scalar>>();
  const Instructions has = fused_instructions(allowed);
  if (has == Instructions::any) return avx512;
  if (has == Instructions::avx2) return avx2;
#endif
  return plain;
}

}  // namespace

template <class Scalar>
void subtract_product(int m, int n, int k, const Operand<Scalar>& A, const Operand<Scalar>& B,
                      Scalar* C, int ldc, const ProductOptions& options) {
  kernels<Scalar>(options.allowed).subtract(m, n, k, A, B, C, ldc, options);
}

template <class Scalar>
void solve_right(int m, int n, const Scalar* L, int ldl, Scalar* B, int ldb, Instructions allowed) {
  for (int j = 0; j < n; j += narrow) {
    const int w = std::min(narrow, n - j);
    Scalar* own = B + index(j) * ldb;
    kernels<Scalar>(allowed).solve(m, w, L + j + index(j) * ldl, ldl, own, ldb);
    subtract_product<Scalar>(m, n - j - w, w, {own, 1, ldb},
                             {L + j + w + index(j) * ldl, ldl, 1, true}, own + index(w) * ldb, ldb,
                             {.allowed = allowed});
  }
}

#define LITTORAL_PRODUCTS(S)                                                                   \
  template void subtract_product(int, int, int, const Operand<S>&, const Operand<S>&, S*, int, \
                                 const ProductOptions&);                                       \
  template void solve_right(int, int, const S*, int, S*, int, Instructions);
LITTORAL_PRODUCTS(double)
LITTORAL_PRODUCTS(Complex)
#undef LITTORAL_PRODUCTS

}  // namespace littoral::dense
