// Loops over lanes that compilers turn into vector instructions: no calls, no branches. CMakeLists
// lets the compiler assume for this file that square roots set no error number and comparisons do
// not trap, and keeps it from fusing products and sums, which rounds otherwise.

#include "methods/geodesic/ray_kernels.h"

#include <cmath>

#include "base/kernel_choice.h"
#include "base/vector_lanes.h"

namespace littoral {

namespace {

#define LITTORAL_INLINE [[gnu::always_inline]] inline

template <class V>
LITTORAL_INLINE void take_root(V& v) {
  for (int l = 0; l < int(sizeof v / sizeof(double)); ++l) v[l] = std::sqrt(v[l]);
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
    V p;
    load(p, c.parallel + i);
    parallel = p != 0;
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
    V parallel;
    load(parallel, c.parallel + i);
    straight = parallel != 0;
    g0 = straight ? x : b0 - x;
    g1 = straight ? x : b1 - x;
    gy = straight ? y : -y;
  }
};

template <int width>
LITTORAL_INLINE void look_lanes(const RayColumns& c, int n, double px, double py,
                                double tolerance) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  for (int i = 0; i < n; i += width) {
    EnteringRays<width> w;
    w.load_from(c, i);
    const V a0 = w.g0 * py - w.gy * (px - w.b0), a1 = w.g1 * py - w.gy * (px - w.b1);
    store(c.apex0 + i, a0);
    store(c.apex1 + i, a1);
    const B past = (a0 > w.gy * tolerance) | (a1 < -w.gy * tolerance);
    store(c.covers + i, ~past);
  }
}

template <int width>
LITTORAL_INLINE void where_lanes(const RayColumns& c, int n, double crossing, double reach) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  for (int i = 0; i < n; i += width) {
    V b0, b1, d0, d1, a0, a1;
    load(b0, c.b0 + i);
    load(b1, c.b1 + i);
    load(d0, c.d0 + i);
    load(d1, c.d1 + i);
    load(a0, c.apex0 + i);
    load(a1, c.apex1 + i);
    const B left = a0<0, right = a1> 0;
    const B not_left = (b0 >= crossing) | (d0 > reach), not_right = (b1 <= crossing) | (d1 > reach);
    store(c.goes + i, (left & 1) | (right & 2) | (((left & not_left) | (right & not_right)) & 4));
  }
}

template <int width, bool right>
LITTORAL_INLINE void carry_lanes(const RayColumns& c, int first, int last, const ExitNumbers& e) {
  using V = typename Wide<width>::Lanes;
  using B = typename Wide<width>::Bits;
  const double px = e.apex_x, py = e.apex_y, base = right ? e.triangle_length : 0.0;
  const double start = e.from_apex ? e.length : 0.0, step = e.from_apex ? -e.length : e.length;
  const bool turned = right != e.from_apex;
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

template <int width>
LITTORAL_INLINE void leave_lanes(const RayColumns& c, int first, int last, const ExitNumbers& e) {
  if (e.right)
    carry_lanes<width, true>(c, first, last, e);
  else
    carry_lanes<width, false>(c, first, last, e);
  if (e.right != e.from_apex)
    meet_lanes<width, true>(c, first, last, e);
  else
    meet_lanes<width, false>(c, first, last, e);
}

void look_plain(const RayColumns& c, int n, double px, double py, double tolerance) {
  look_lanes<2>(c, n, px, py, tolerance);
}
void where_plain(const RayColumns& c, int n, double crossing, double reach) {
  where_lanes<2>(c, n, crossing, reach);
}
void leave_plain(const RayColumns& c, int first, int last, const ExitNumbers& e) {
  leave_lanes<2>(c, first, last, e);
}
#if defined(__x86_64__)
[[gnu::target("avx2")]] void look_avx2(const RayColumns& c, int n, double px, double py,
                                       double tolerance) {
  look_lanes<4>(c, n, px, py, tolerance);
}
[[gnu::target("avx2")]] void where_avx2(const RayColumns& c, int n, double crossing, double reach) {
  where_lanes<4>(c, n, crossing, reach);
}
[[gnu::target("avx2")]] void leave_avx2(const RayColumns& c, int first, int last,
                                        const ExitNumbers& e) {
  leave_lanes<4>(c, first, last, e);
}
#endif

}  // namespace

const RayKernels plain_ray_kernels = {&look_plain, &where_plain, &leave_plain};

const RayKernels& ray_kernels() {
#if defined(__x86_64__)
  static const RayKernels wide = {&look_avx2, &where_avx2, &leave_avx2};
#endif
  static const RayKernels& best = LITTORAL_FASTEST(plain_ray_kernels, wide);
  return best;
}

}  // namespace littoral
