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

template <int width>
LITTORAL_INLINE double least_lanes(const WindowBlock& w, std::size_t first, std::size_t last) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  V least = V{} + infinity;
  for (std::size_t i = first; i < last; i += width) {
    V b0, b1, d0, d1, x, y, behind;
    B tag;
    load(b0, w.column(WindowBlock::b0) + i);
    load(b1, w.column(WindowBlock::b1) + i);
    load(d0, w.column(WindowBlock::d0) + i);
    load(d1, w.column(WindowBlock::d1) + i);
    load(x, w.column(WindowBlock::x) + i);
    load(y, w.column(WindowBlock::y) + i);
    load(behind, w.column(WindowBlock::behind) + i);
    load(tag, w.tags() + i);
    const B at_end = ((tag & WindowTag::parallel) != 0) | (x <= b0) | (x >= b1);
    const V ends = d1 < d0 ? d1 : d0, here = at_end ? ends : behind - y;
    B nearer = here < least;
    if (last - i < width) keep_first(nearer, std::int64_t(last - i));
    least = nearer ? here : least;
  }
  double found = infinity;
  for (int l = 0; l < width; ++l) found = std::min(found, least[l]);
  return found;
}

bool whole_plain(const WindowBlock& w, const EdgeEnds& ends) { return whole_lanes<2>(w, ends); }
double least_plain(const WindowBlock& w, std::size_t first, std::size_t last) {
  return least_lanes<2>(w, first, last);
}
#if defined(__x86_64__)
[[gnu::target("avx2")]] bool whole_avx2(const WindowBlock& w, const EdgeEnds& ends) {
  return whole_lanes<4>(w, ends);
}
[[gnu::target("avx2")]] double least_avx2(const WindowBlock& w, std::size_t first,
                                          std::size_t last) {
  return least_lanes<4>(w, first, last);
}
#endif

}  // namespace

const WindowKernels plain_window_kernels = {&whole_plain, &least_plain};

const WindowKernels& window_kernels() {
#if defined(__x86_64__)
  static const WindowKernels wide = {&whole_avx2, &least_avx2};
#endif
  static const WindowKernels& best = LITTORAL_FASTEST(plain_window_kernels, wide);
  return best;
}

}  // namespace littoral
