// Loops over lanes that compilers turn into vector instructions. CMakeLists lets the compiler
// assume for this file that square roots set no error number and comparisons do not trap, and keeps
// it from fusing products and sums, which rounds otherwise.

#include <cmath>
#include <cstddef>

#include "base/kernel_choice.h"
#include "base/vector_lanes.h"
#include "methods/heat/strip_cells.h"
#include "methods/heat/time_scale.h"

namespace littoral {

namespace {

#define LITTORAL_CELL_INLINE [[gnu::always_inline]] inline

constexpr std::int64_t all_but_sign = 0x7fffffffffffffff, exponent_bits = 0x7ff0000000000000;
constexpr std::int64_t twice_bias = 0x7fe0000000000000;

/// Vectors (x, y) of several columns.
template <int width>
struct SomeVectors {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  V x, y;

  LITTORAL_CELL_INLINE void add(const double* from, double slope_x, double slope_y) {
    V u;
    load(u, from);
    x += u * slope_x;
    y += u * slope_y;
  }
  LITTORAL_CELL_INLINE void largest(V& m) const {
    const V a = __builtin_bit_cast(V, __builtin_bit_cast(B, x) & all_but_sign);
    const V b = __builtin_bit_cast(V, __builtin_bit_cast(B, y) & all_but_sign);
    m = a > b ? a : b;
  }
  /// Divides by the power of two below m, the largest component: squares do not underflow then.
  LITTORAL_CELL_INLINE void rescale(const V& m) {
    const V s = __builtin_bit_cast(V, twice_bias - (__builtin_bit_cast(B, m) & exponent_bits));
    x *= s;
    y *= s;
  }
};

/// The gradients in cell c.
template <int width>
LITTORAL_CELL_INLINE void gradients(const StripCells& C, int c, const double* u,
                                    SomeVectors<width>* g) {
  constexpr int parts = strip_width / width;
  for (int p = 0; p < parts; ++p) g[p].x = g[p].y = typename Wide<width>::Lanes{};
  for (int e = C.begin[c]; e < C.begin[c + 1]; ++e) {
    const double* from = u + strip_width * std::ptrdiff_t{C.row[e]};
    const double sx = C.slope[2 * e], sy = C.slope[2 * e + 1];
    for (int p = 0; p < parts; ++p) g[p].add(from + width * p, sx, sy);
  }
}

template <int width>
LITTORAL_CELL_INLINE void divergence_lanes(const StripCells& C, int first, int end,
                                           const char* apart, const double* u, double* b,
                                           double* longest) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  constexpr int parts = strip_width / width;
  V most[parts];
  for (int p = 0; p < parts; ++p) load(most[p], longest + width * p);
  for (int c = first; c < end; ++c) {
    if (apart[c]) continue;
    SomeVectors<width> g[parts];
    gradients<width>(C, c, u, g);
    for (int p = 0; p < parts; ++p) {
      V m;
      g[p].largest(m);
      most[p] = m > most[p] ? m : most[p];
      g[p].rescale(m);
      V length = g[p].x * g[p].x + g[p].y * g[p].y;
      for (int l = 0; l < width; ++l) length[l] = std::sqrt(length[l]);
      const B any = m > no_gradient;
      const V f = __builtin_bit_cast(V, __builtin_bit_cast(B, V(-C.area[c] / length)) & any);
      g[p].x *= f;
      g[p].y *= f;
    }
    for (int e = C.begin[c]; e < C.begin[c + 1]; ++e) {
      double* to = b + strip_width * std::ptrdiff_t{C.row[e]};
      const double sx = C.slope[2 * e], sy = C.slope[2 * e + 1];
      for (int p = 0; p < parts; ++p) {
        V sum;
        load(sum, to + width * p);
        sum += g[p].x * sx + g[p].y * sy;
        store(to + width * p, sum);
      }
    }
  }
  for (int p = 0; p < parts; ++p) store(longest + width * p, most[p]);
}

template <int width>
LITTORAL_CELL_INLINE void shares_lanes(const StripCells& C, int first, int end, const char* apart,
                                       const double* u, const double* phi, double* sums) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  constexpr int parts = strip_width / width;
  constexpr double low = (1 - off_unit_by) * (1 - off_unit_by);
  constexpr double high = (1 + off_unit_by) * (1 + off_unit_by);
  V all[parts], against[parts], off[parts];
  for (int p = 0; p < parts; ++p) {
    load(all[p], sums + width * p);
    load(against[p], sums + strip_width + width * p);
    load(off[p], sums + 2 * strip_width + width * p);
  }
  for (int c = first; c < end; ++c) {
    if (apart[c]) continue;
    SomeVectors<width> of_u[parts], g[parts];
    gradients<width>(C, c, u, of_u);
    gradients<width>(C, c, phi, g);
    const V area = V{} + C.area[c];
    const B area_bits = __builtin_bit_cast(B, area);
    for (int p = 0; p < parts; ++p) {
      V m;
      of_u[p].largest(m);
      of_u[p].rescale(m);
      const V along = of_u[p].x * g[p].x + of_u[p].y * g[p].y;
      const V square = g[p].x * g[p].x + g[p].y * g[p].y;
      const B any = m > no_gradient, rises = along < 0.0;
      const B unit = (square >= low) & (square <= high);
      all[p] += __builtin_bit_cast(V, area_bits & any);
      against[p] += __builtin_bit_cast(V, area_bits & any & ~rises);
      off[p] += __builtin_bit_cast(V, area_bits & any & ~unit);
    }
  }
  for (int p = 0; p < parts; ++p) {
    store(sums + width * p, all[p]);
    store(sums + strip_width + width * p, against[p]);
    store(sums + 2 * strip_width + width * p, off[p]);
  }
}

void divergence_plain(const StripCells& C, int first, int end, const char* apart, const double* u,
                      double* b, double* longest) {
  divergence_lanes<2>(C, first, end, apart, u, b, longest);
}
void shares_plain(const StripCells& C, int first, int end, const char* apart, const double* u,
                  const double* phi, double* sums) {
  shares_lanes<2>(C, first, end, apart, u, phi, sums);
}
#if defined(__x86_64__)
[[gnu::target("avx2")]] void divergence_avx2(const StripCells& C, int first, int end,
                                             const char* apart, const double* u, double* b,
                                             double* longest) {
  divergence_lanes<4>(C, first, end, apart, u, b, longest);
}
[[gnu::target("avx2")]] void shares_avx2(const StripCells& C, int first, int end, const char* apart,
                                         const double* u, const double* phi, double* sums) {
  shares_lanes<4>(C, first, end, apart, u, phi, sums);
}
#endif

}  // namespace

const StripCellKernels plain_strip_cell_kernels = {&divergence_plain, &shares_plain};

const StripCellKernels& strip_cell_kernels() {
#if defined(__x86_64__)
  static const StripCellKernels wide = {&divergence_avx2, &shares_avx2};
#endif
  static const StripCellKernels& best = LITTORAL_FASTEST(plain_strip_cell_kernels, wide);
  return best;
}

}  // namespace littoral
