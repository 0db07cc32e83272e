// Loops over lanes, as in ray_kernels.cpp.

#include "methods/geodesic/window_kernels.h"

#include <algorithm>

#include "base/index.h"
#include "base/kernel_choice.h"
#include "methods/geodesic/ray_lanes.h"

namespace littoral {

namespace {

template <int width>
LITTORAL_INLINE bool whole_lanes(const WindowBlock& w, const EdgeEnds& ends) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  const std::int64_t n = std::int64_t(w.size()), same = WindowTag::page_all | WindowTag::open,
                     first = (w.tags()[0] & same) | WindowTag::open;
  const double narrow = ends.narrow();
  for (std::int64_t i = 0; i < n; i += width) {
    V b0, b1, d0, d1;
    B tag;
    load(b0, w.column(WindowBlock::b0) + i);
    load(b1, w.column(WindowBlock::b1) + i);
    load(d0, w.column(WindowBlock::d0) + i);
    load(d1, w.column(WindowBlock::d1) + i);
    load(tag, w.tags() + i);
    B broken = ~((d0 <= ends.tail + b0 + ends.tail_slack) &
                 (d1 <= ends.head + (ends.length - b1) + ends.head_slack) & (b1 - b0 > narrow) &
                 ((tag & same) == first));
    if (n - i < width) keep_first(broken, n - i);
    if (any<width>(broken)) return false;
  }
  return true;
}

template <class V>
LITTORAL_INLINE void take_size(V& v) {
  v = v < 0 ? -v : v;
}

/// As many windows of an edge as there are lanes; slopes, distances and bends are of rays of
/// points.
template <int width>
struct WindowLanes {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  V b0, b1, d0, d1, x, y, behind;

  LITTORAL_INLINE void load_from(const WindowBlock& w, std::size_t i) {
    load(b0, w.column(WindowBlock::b0) + i);
    load(b1, w.column(WindowBlock::b1) + i);
    load(d0, w.column(WindowBlock::d0) + i);
    load(d1, w.column(WindowBlock::d1) + i);
    load(x, w.column(WindowBlock::x) + i);
    load(y, w.column(WindowBlock::y) + i);
    load(behind, w.column(WindowBlock::behind) + i);
  }
  LITTORAL_INLINE void slope(const V& p, V& out) const {
    const V u = p - x;
    V r = u * u + y * y;
    take_root(r);
    out = u / r;
  }
  LITTORAL_INLINE void distance(const V& p, V& out) const {
    const V u = p - x;
    V r = u * u + y * y;
    take_root(r);
    out = behind + r;
  }
  LITTORAL_INLINE void bend(const V& p, const V& d, V& out) const {
    const V r = d - behind, slope = (p - x) / r;
    out = (1 - slope * slope) / r;
  }
  /// `Window::least`.
  LITTORAL_INLINE void least(const B& parallel, V& out) const {
    const B at_end = parallel | (x <= b0) | (x >= b1);
    const V ends = d1 < d0 ? d1 : d0;
    out = at_end ? ends : V(behind - y);
  }
  /// `largest_difference` of merge_windows.cpp.
  LITTORAL_INLINE void difference(const WindowLanes& other, V& out) const {
    V o0, o1, own, bends0, bends1;
    other.distance(b0, o0);
    other.distance(b1, o1);
    bend(b0, d0, own);
    other.bend(b0, o0, bends0);
    bends0 = own - bends0;
    bend(b1, d1, own);
    other.bend(b1, o1, bends1);
    bends1 = own - bends1;
    V away0 = d0 - o0, away1 = d1 - o1;
    for (V* v : {&bends0, &bends1, &away0, &away1}) take_size(*v);
    const V stretch = b1 - b0, bends = bends0 < bends1 ? bends1 : bends0;
    out = (away0 < away1 ? away1 : away0) + 0.25 * stretch * stretch * bends;
  }
};

template <int width>
LITTORAL_INLINE double least_lanes(const WindowBlock& w, std::size_t first, std::size_t last) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  V least = V{} + infinity;
  for (std::size_t i = first; i < last; i += width) {
    WindowLanes<width> windows;
    windows.load_from(w, i);
    B tag;
    load(tag, w.tags() + i);
    V here;
    windows.least((tag & WindowTag::parallel) != 0, here);
    B nearer = here < least;
    if (last - i < width) keep_first(nearer, std::int64_t(last - i));
    least = nearer ? here : least;
  }
  double found = infinity;
  for (int l = 0; l < width; ++l) found = std::min(found, least[l]);
  return found;
}

/// What `one_of` finds of two windows, for several pairs at once.
template <int width>
LITTORAL_INLINE std::uint64_t pairs_lanes(const WindowBlock& w, std::size_t first,
                                          const Joining& how) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  constexpr std::int64_t kind = ~(WindowTag::depth_all | WindowTag::open | WindowTag::parallel);
  constexpr std::int64_t state = WindowTag::open | WindowTag::parallel;
  const std::size_t n = std::min<std::size_t>(w.size() - 1 - first, 64);
  std::uint64_t out = 0;
  for (std::size_t k = 0; k < n; k += width) {
    const std::size_t i = first + k;
    B tag, next_tag;
    load(tag, w.tags() + i);
    load(next_tag, w.tags() + i + 1);
    WindowLanes<width> a, b;
    a.load_from(w, i);
    b.load_from(w, i + 1);
    B joins = ((tag & state) == WindowTag::open) & ((next_tag & state) == WindowTag::open) &
              (((tag ^ next_tag) & kind) == 0) & (b.b0 - a.b1 <= how.widest_gap);
    if (n - k < width) keep_first(joins, std::int64_t(n - k));
    if (!any<width>(joins)) continue;
    WindowLanes<width> one;
    one.b0 = a.b0;
    one.b1 = b.b1;
    const V l = b.b1 - a.b0, rise = b.d1 - a.d0, squares = (l - rise) * (l + rise);
    V slope, r = a.d0;
    a.slope(a.b0, slope);
    const V over_first = 2 * (rise - l * slope), by_first = squares / over_first;
    r = ((over_first > 0) & (by_first < r)) ? by_first : r;
    b.slope(b.b1, slope);
    const V over_last = 2 * (l * slope - rise), by_last = squares / over_last - rise;
    r = ((over_last > 0) & (by_last < r)) ? by_last : r;
    const V s = rise / l - squares / (2 * r * l);
    joins &= (r > 0) & (s < 1) & (s > -1);
    V height = (1 - s) * (1 + s);
    take_root(height);
    one.behind = a.d0 - r;
    one.x = a.b0 - r * s;
    one.y = -r * height;
    V apart, apart_b, least, least_b;
    a.difference(one, apart);
    a.least(B{}, least);
    joins &= apart <= how.tolerance * least - how.error;
    if (!any<width>(joins)) continue;
    b.difference(one, apart_b);
    b.least(B{}, least_b);
    apart = apart < apart_b ? apart_b : apart;
    least = least_b < least ? least_b : least;
    joins &= apart <= how.tolerance * least - how.error;
    for (int lane = 0; lane < width; ++lane)
      out |= (joins[lane] != 0 ? std::uint64_t(1) : 0) << (k + std::size_t(lane));
  }
  return out;
}

bool whole_plain(const WindowBlock& w, const EdgeEnds& ends) { return whole_lanes<2>(w, ends); }
double least_plain(const WindowBlock& w, std::size_t first, std::size_t last) {
  return least_lanes<2>(w, first, last);
}
std::uint64_t pairs_plain(const WindowBlock& w, std::size_t first, const Joining& how) {
  return pairs_lanes<2>(w, first, how);
}
#if defined(__x86_64__)
[[gnu::target("avx2")]] bool whole_avx2(const WindowBlock& w, const EdgeEnds& ends) {
  return whole_lanes<4>(w, ends);
}
[[gnu::target("avx2")]] double least_avx2(const WindowBlock& w, std::size_t first,
                                          std::size_t last) {
  return least_lanes<4>(w, first, last);
}
[[gnu::target("avx2")]] std::uint64_t pairs_avx2(const WindowBlock& w, std::size_t first,
                                                 const Joining& how) {
  return pairs_lanes<4>(w, first, how);
}
#endif

}  // namespace

const WindowKernels plain_window_kernels = {&whole_plain, &least_plain, &pairs_plain};

const WindowKernels& window_kernels() {
#if defined(__x86_64__)
  static const WindowKernels wide = {&whole_avx2, &least_avx2, &pairs_avx2};
#endif
  static const WindowKernels& best = LITTORAL_FASTEST(plain_window_kernels, wide);
  return best;
}

}  // namespace littoral
