// Loops over lanes that compilers turn into vector instructions: no calls, no branches. CMakeLists
// lets the compiler assume for this file that square roots set no error number and comparisons do
// not trap, and keeps it from fusing products and sums, which rounds otherwise.

#include "methods/geodesic/ray_kernels.h"

#include <algorithm>

#include "base/kernel_choice.h"
#include "methods/geodesic/ray_lanes.h"

namespace littoral {

namespace {

template <bool turned, class Scalar, class V>
LITTORAL_INLINE void store_in_order(Scalar* to, const V& v) {
  if constexpr (!turned)
    store(to, v);
  else if constexpr (sizeof(V) == 4 * sizeof(double))
    store(to, V(__builtin_shufflevector(v, v, 3, 2, 1, 0)));
  else
    store(to, V(__builtin_shufflevector(v, v, 1, 0)));
}

/// Several windows of an edge.
template <int width>
struct SomeRays {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  V b0, b1, d0, d1, x, y, y2, behind;
  B parallel;

  LITTORAL_INLINE void load_left(const RayColumns& c, int i) {
    load(b0, c.to0 + i);
    load(b1, c.to1 + i);
    load(d0, c.to_d0 + i);
    load(d1, c.to_d1 + i);
    load(x, c.to_x + i);
    load(y, c.to_y + i);
    load(behind, c.to_behind + i);
    B tag;
    load(tag, c.tag + i);
    parallel = (tag & WindowTag::parallel) != 0;
    y2 = y * y;
  }
  LITTORAL_INLINE void at(const V& p, V& d) const {
    const V u = p - x;
    V r = u * u + y2;
    take_root(r);
    d = behind + (parallel ? x * p : r);
  }
};

/// Several windows on the edge below, and where the rays at their ends run.
template <int width>
struct EnteringRays {
  using V = typename Wide<width>::Lanes;
  V b0, b1, x, y, g0, g1, gy;
  typename Wide<width>::Bits straight;

  LITTORAL_INLINE void load_from(const RayColumns& c, int i) {
    load(b0, c.b0 + i);
    load(b1, c.b1 + i);
    load(x, c.x + i);
    load(y, c.y + i);
    typename Wide<width>::Bits tag;
    load(tag, c.tag + i);
    straight = (tag & WindowTag::parallel) != 0;
    g0 = straight ? x : b0 - x;
    g1 = straight ? x : b1 - x;
    gy = straight ? y : -y;
  }
};

template <int width>
LITTORAL_INLINE void look_lanes(const RayColumns& c, int n, double px, double py, double tolerance,
                                int covering[2]) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  int first = n, last = 0;
  for (int i = 0; i < n; i += width) {
    EnteringRays<width> w;
    w.load_from(c, i);
    const V a0 = w.g0 * py - w.gy * (px - w.b0), a1 = w.g1 * py - w.gy * (px - w.b1);
    store(c.apex0 + i, a0);
    store(c.apex1 + i, a1);
    const B covers = (a0 <= w.gy * tolerance) & (a1 >= -w.gy * tolerance);
    store(c.covers + i, covers);
    if (any<width>(covers)) {
      first = std::min(first, i);
      last = i + width;
    }
  }
  covering[0] = first;
  covering[1] = std::min(last, n);
}

template <int width>
LITTORAL_INLINE void where_lanes(const RayColumns& c, int n, const CornerNumbers& q) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  const double px = q.apex_x, py = q.apex_y, reach = q.far + py + q.slack;
  for (int i = 0; i < n; i += width) {
    V b0, b1, d0, d1, a0, a1;
    load(b0, c.b0 + i);
    load(b1, c.b1 + i);
    load(d0, c.d0 + i);
    load(d1, c.d1 + i);
    load(a0, c.apex0 + i);
    load(a1, c.apex1 + i);
    B tag;
    load(tag, c.tag + i);
    B left = a0 < 0;
    B right = a1 > 0;
    const B beyond_left = left & (b0 >= q.to), beyond_right = right & (b1 <= q.from);
    // py bounds the norms from below.
    const B far_left = left & (d0 > reach), far_right = right & (d1 > reach);
    if (any<width>(beyond_left | beyond_right | far_left | far_right)) {
      V x, y, behind;
      load(x, c.x + i);
      load(y, c.y + i);
      load(behind, c.behind + i);
      const V u = px - x, v = py - y, u0 = px - b0, u1 = px - b1;
      V r = u * u + v * v, r0 = u0 * u0 + py * py, r1 = u1 * u1 + py * py;
      take_root(r);
      take_root(r0);
      take_root(r1);
      const B parallel = (tag & WindowTag::parallel) != 0;
      const V at = parallel ? behind + x * px + y * py : behind + r;
      const B crossed = at > q.nearest + q.slack;
      left &= ~(beyond_left & crossed) & ~(far_left & (q.far + r0 + q.slack < d0));
      right &= ~(beyond_right & crossed) & ~(far_right & (q.far + r1 + q.slack < d1));
    }
    const B goes_on = ((tag & WindowTag::depth_all) >> 48) < q.most_straight;
    store(c.goes + i, ((left & 1) | (right & 2)) & goes_on);
  }
}

template <int width, bool right>
LITTORAL_INLINE void carry_lanes(const RayColumns& c, int first, int last, const ExitNumbers& e) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  const double px = e.apex_x, py = e.apex_y, base = right ? e.triangle_length : 0.0;
  const double start = e.from_apex ? e.length : 0.0, step = e.from_apex ? -e.length : e.length;
  const bool turned = e.turned();
  for (int i = first; i < last; i += width) {
    EnteringRays<width> w;
    w.load_from(c, i);
    const auto& [b0, b1, x, y, g0, g1, gy, straight] = w;
    V behind, a0, a1;
    load(behind, c.behind + i);
    load(a0, c.apex0 + i);
    load(a1, c.apex1 + i);
    // Where the rays at the ends leave, as shares of the way from the edge below to the apex. The
    // outer ray leaves nearer to the edge; the inner one may pass the apex.
    V share0 = gy * (base - b0) / (g0 * py - gy * (px - base));
    V share1 = gy * (base - b1) / (g1 * py - gy * (px - base));
    share0 = share0 > 0 ? share0 : V{};
    share1 = share1 > 0 ? share1 : V{};
    const V one = V{} + 1;
    share0 = share0 < 1 ? share0 : one;
    share1 = share1 < 1 ? share1 : one;
    if (right)
      share0 = a0 > 0 ? share0 : one;
    else
      share1 = a1 < 0 ? share1 : one;
    const V to0 = start + step * (turned ? share1 : share0);
    const V to1 = start + step * (turned ? share0 : share1);
    const V dx = x - e.tail_x, dy = y - e.tail_y;
    const V from_x = straight ? x : dx, from_y = straight ? y : dy;
    const V to_x = from_x * e.along_x + from_y * e.along_y;
    const V to_y = from_x * e.up_x + from_y * e.up_y;
    const V to_behind = behind + (straight ? x * e.tail_x + y * e.tail_y : V{});
    const V u0 = to0 - to_x, u1 = to1 - to_x, y2 = to_y * to_y;
    V r0 = u0 * u0 + y2, r1 = u1 * u1 + y2;
    take_root(r0);
    take_root(r1);
    const V d0 = to_behind + (straight ? to_x * to0 : r0);
    const V d1 = to_behind + (straight ? to_x * to1 : r1);
    store(c.to0 + i, to0);
    store(c.to1 + i, to1);
    store(c.to_x + i, to_x);
    store(c.to_y + i, to_y);
    store(c.to_behind + i, to_behind);
    store(c.to_d0 + i, d0);
    store(c.to_d1 + i, d1);
    const B by_tail = d0 > e.tail + to0 + e.tail_slack;
    const B by_head = d1 > e.head + (e.edge_length - to1) + e.head_slack;
    const B wide = to1 - to0 > e.narrow;
    store(c.ends + i, (by_tail & 1) | (by_head & 2) | (~wide & 4));
  }
}

/// The commonest case of two neighbours, in order from the tail of the edge: the second starts
/// within the first and ends beyond it, and they are equally far at one point between.
template <int width, bool turned>
LITTORAL_INLINE void meet_lanes(const RayColumns& c, int first, int last, const ExitNumbers& e) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  for (int i = first; i < last - 1; i += width) {
    SomeRays<width> o, w;
    o.load_left(c, turned ? i + 1 : i);
    w.load_left(c, turned ? i : i + 1);
    const V low = w.b0, high = o.b1;
    V at_low, at_high;
    o.at(low, at_low);
    w.at(high, at_high);
    const V slack = e.slack_share * (at_low + e.edge_length);
    const B new_at_low = w.d0 + slack < at_low, new_at_high = at_high + slack < o.d1;
    // The bisector of the images, or the hyperbola (derived at `EdgeEnvelopes::hyperbola`).
    const V bisector = 0.5 * (w.x + o.x + (w.y - o.y) * (w.y + o.y) / (w.x - o.x));
    const V k = o.behind - w.behind, k4 = 4 * k * k;
    const V norm = w.x * w.x + w.y2, difference = norm - o.x * o.x - o.y2 + k * k,
            b = 2 * (w.x - o.x);
    const V square = k4 - b * b, half = k4 * w.x - difference * b,
            rest = k4 * norm - difference * difference;
    V root = half * half - square * rest;
    root = root > 0 ? root : V{};
    take_root(root);
    const V q = half + (half < 0 ? -root : root);
    const V near = q / square, other = rest / q;
    const B near_in = (near > low) & (near < high);
    V p = k == 0 ? bisector : (near_in ? near : other);
    // Parallel both: a line.
    const V f_low = w.d0 + slack - at_low, f_high = at_high + slack - o.d1;
    const B both_parallel = o.parallel & w.parallel;
    p = both_parallel ? low - f_low * (high - low) / (f_high - f_low) : p;
    // At a tie to the end of the first the second starts there, unless it is nearer where their
    // rays are parallel.
    const B tied = ~(new_at_low | new_at_high);
    p = tied ? (w.x * o.y - o.x * w.y) / (o.y - w.y) : p;
    V far_o, far_w;
    o.at(p, far_o);
    w.at(p, far_w);
    const B inside = (p > low) & (p < high), nearer = inside & (far_w + slack < far_o);
    V apart_by = far_w - far_o;
    apart_by = both_parallel ? apart_by + slack : apart_by;
    const V within = both_parallel ? 0.05 * slack : slack;
    const B met = new_at_high & inside & (apart_by <= within) & (-apart_by <= within);
    p = tied ? high : p;
    far_o = tied ? o.d1 : far_o;
    far_w = tied ? at_high : far_w;
    const B clear = ((tied & ~nearer) | met) & (w.b1 - p > e.narrow) & (o.b0 <= w.b0) &
                    (o.b1 <= w.b1) & ~new_at_low & ~(o.parallel ^ w.parallel);
    const B overlap = high > low;
    store(c.cut + i, p);
    store(c.cut_first + i, far_o);
    store(c.cut_second + i, far_w);
    store(c.meets + i, (overlap & clear & cut_once) | (overlap & ~clear & unclear));
  }
}

template <int width, bool turned>
LITTORAL_INLINE void follow_lanes(const RayColumns& c, int first, int last, const ExitNumbers& e) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  const std::int64_t side = e.right ? 2 : 1;
  for (int i = first; i < last; i += width) {
    B goes, ends;
    load(goes, c.goes + i);
    load(ends, c.ends + i);
    store(c.ends + i, ends | (((goes & side) == 0) & 8));
  }
  c.meets[turned ? last - 1 : first - 1] = apart;
  for (int i = first; i < last - 1; i += width) {
    const int o = turned ? i + 1 : i, w = turned ? i : i + 1, before = turned ? i + 1 : i - 1;
    V start, left, cut, cut_before;
    B ends, next_ends, meets, met_before;
    load(left, c.to0 + o);
    load(start, c.to0 + w);
    load(cut, c.cut + i);
    load(cut_before, c.cut + before);
    load(ends, c.ends + i);
    load(next_ends, c.ends + i + 1);
    load(meets, c.meets + i);
    load(met_before, c.meets + before);
    const V from = met_before == cut_once ? cut_before : left;
    const B cuts = (meets == cut_once) & (from <= start) & (cut - from > e.narrow);
    store(c.follows + i, ((ends | next_ends) == 0) & ((meets == apart) | cuts));
  }
}

template <int width>
LITTORAL_INLINE void leave_lanes(const RayColumns& c, int first, int last, const ExitNumbers& e) {
  if (e.right)
    carry_lanes<width, true>(c, first, last, e);
  else
    carry_lanes<width, false>(c, first, last, e);
  if (e.turned()) {
    meet_lanes<width, true>(c, first, last, e);
    follow_lanes<width, true>(c, first, last, e);
  } else {
    meet_lanes<width, false>(c, first, last, e);
    follow_lanes<width, false>(c, first, last, e);
  }
}

template <int width, bool turned>
LITTORAL_INLINE void put_lanes(const RayColumns& c, int first, int last, std::uint16_t page,
                               WindowBlock& to, std::size_t at) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  // Stores could change any pointer that is not a local one.
  const double *to0 = c.to0, *to1 = c.to1, *to_d0 = c.to_d0, *to_d1 = c.to_d1, *to_x = c.to_x,
               *to_y = c.to_y, *to_behind = c.to_behind, *cut = c.cut, *cut_first = c.cut_first,
               *cut_second = c.cut_second;
  const std::int64_t *meets = c.meets, *tags = c.tag;
  double *out_b0 = to.column(WindowBlock::b0) + at, *out_b1 = to.column(WindowBlock::b1) + at,
         *out_d0 = to.column(WindowBlock::d0) + at, *out_d1 = to.column(WindowBlock::d1) + at,
         *out_x = to.column(WindowBlock::x) + at, *out_y = to.column(WindowBlock::y) + at,
         *out_behind = to.column(WindowBlock::behind) + at;
  std::int64_t* out_tags = to.tags() + at;
  for (int k = 0; k < last - first; k += width) {
    const int i = turned ? last - k - width : first + k;
    const int before = turned ? i : i - 1, after = turned ? i - 1 : i;
    V start, end, at_start, at_end, x, y, behind, cut0, cut1, at_cut0, at_cut1;
    B met0, met1, tag;
    load(start, to0 + i);
    load(end, to1 + i);
    load(at_start, to_d0 + i);
    load(at_end, to_d1 + i);
    load(x, to_x + i);
    load(y, to_y + i);
    load(behind, to_behind + i);
    load(cut0, cut + before);
    load(at_cut0, cut_second + before);
    load(met0, meets + before);
    load(cut1, cut + after);
    load(at_cut1, cut_first + after);
    load(met1, meets + after);
    load(tag, tags + i);
    const B cuts0 = met0 == cut_once, cuts1 = met1 == cut_once;
    const B deeper = (tag & WindowTag::depth_all) != WindowTag::depth_all;
    tag = (tag & ~WindowTag::page_all) | (page * WindowTag::page_one) | WindowTag::open;
    store_in_order<turned>(out_b0 + k, V(cuts0 ? cut0 : start));
    store_in_order<turned>(out_d0 + k, V(cuts0 ? at_cut0 : at_start));
    store_in_order<turned>(out_b1 + k, V(cuts1 ? cut1 : end));
    store_in_order<turned>(out_d1 + k, V(cuts1 ? at_cut1 : at_end));
    store_in_order<turned>(out_x + k, x);
    store_in_order<turned>(out_y + k, y);
    store_in_order<turned>(out_behind + k, behind);
    store_in_order<turned>(out_tags + k, B(tag + (deeper & WindowTag::depth_one)));
  }
}

template <int width>
LITTORAL_INLINE void put_lanes(const RayColumns& c, int first, int last, bool turned,
                               std::uint16_t page, WindowBlock& to, std::size_t at) {
  if (turned)
    put_lanes<width, true>(c, first, last, page, to, at);
  else
    put_lanes<width, false>(c, first, last, page, to, at);
}

void look_plain(const RayColumns& c, int n, double px, double py, double tolerance,
                int covering[2]) {
  look_lanes<2>(c, n, px, py, tolerance, covering);
}
void where_plain(const RayColumns& c, int n, const CornerNumbers& corner) {
  where_lanes<2>(c, n, corner);
}
void leave_plain(const RayColumns& c, int first, int last, const ExitNumbers& e) {
  leave_lanes<2>(c, first, last, e);
}
void put_plain(const RayColumns& c, int first, int last, bool turned, std::uint16_t page,
               WindowBlock& to, std::size_t at) {
  put_lanes<2>(c, first, last, turned, page, to, at);
}
#if defined(__x86_64__)
[[gnu::target("avx2")]] void look_avx2(const RayColumns& c, int n, double px, double py,
                                       double tolerance, int covering[2]) {
  look_lanes<4>(c, n, px, py, tolerance, covering);
}
[[gnu::target("avx2")]] void where_avx2(const RayColumns& c, int n, const CornerNumbers& corner) {
  where_lanes<4>(c, n, corner);
}
[[gnu::target("avx2")]] void leave_avx2(const RayColumns& c, int first, int last,
                                        const ExitNumbers& e) {
  leave_lanes<4>(c, first, last, e);
}
[[gnu::target("avx2")]] void put_avx2(const RayColumns& c, int first, int last, bool turned,
                                      std::uint16_t page, WindowBlock& to, std::size_t at) {
  put_lanes<4>(c, first, last, turned, page, to, at);
}
#endif

}  // namespace

const RayKernels plain_ray_kernels = {&look_plain, &where_plain, &leave_plain, &put_plain};

const RayKernels& ray_kernels() {
#if defined(__x86_64__)
  static const RayKernels wide = {&look_avx2, &where_avx2, &leave_avx2, &put_avx2};
#endif
  static const RayKernels& best = LITTORAL_FASTEST(plain_ray_kernels, wide);
  return best;
}

}  // namespace littoral
