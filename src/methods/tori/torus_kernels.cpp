// Loops over lanes that compilers turn into vector instructions: no calls, no branches (see
// CMakeLists for what the compiler may assume here).

#include "methods/tori/torus_kernels.h"

#include <bit>
#include <cstdint>

#include "base/kernel_choice.h"
#include "methods/tori/torus.h"

namespace littoral {

namespace {

/// e^x for x <= 0, to rounding; e^-700 or e^-80 below.
[[gnu::always_inline]] inline double exponential(double x) {
  const double z = (x > -700 ? x : -700) * 1.4426950408889634;
  constexpr double whole = 6755399441055744.0;  // adding it rounds to a whole number
  const double rounded = z + whole;
  const double f = (z - (rounded - whole)) * 0.6931471805599453;  // in [-0.35, 0.35]
  double p = 1.0 / 6227020800;
  p = p * f + 1.0 / 479001600;
  p = p * f + 1.0 / 39916800;
  p = p * f + 1.0 / 3628800;
  p = p * f + 1.0 / 362880;
  p = p * f + 1.0 / 40320;
  p = p * f + 1.0 / 5040;
  p = p * f + 1.0 / 720;
  p = p * f + 1.0 / 120;
  p = p * f + 1.0 / 24;
  p = p * f + 1.0 / 6;
  p = p * f + 0.5;
  p = p * f + 1;
  p = p * f + 1;
  const auto n = std::bit_cast<std::uint64_t>(rounded) - std::bit_cast<std::uint64_t>(whole);
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(p) + (n << 52));
}

[[gnu::always_inline]] inline float exponential(float x) {
  const float z = (x > -80.0f ? x : -80.0f) * 1.44269504f;
  constexpr float whole = 12582912.0f;
  const float rounded = z + whole;
  const float f = (z - (rounded - whole)) * 0.69314718f;
  float p = 1.0f / 720;
  p = p * f + 1.0f / 120;
  p = p * f + 1.0f / 24;
  p = p * f + 1.0f / 6;
  p = p * f + 0.5f;
  p = p * f + 1;
  p = p * f + 1;
  const auto n = std::bit_cast<std::uint32_t>(rounded) - std::bit_cast<std::uint32_t>(whole);
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(p) + (n << 23));
}

template <class S>
[[gnu::always_inline]] inline Slope<S> exponential(const Slope<S>& x) {
  const S e = exponential(x.value);
  return x.chain(e, e);
}

/// Numbers by lanes, the parts of each in arrays of their own.
template <class T>
struct ByLane {
  alignas(64) T of[torus_lanes];
  [[gnu::always_inline]] T operator[](int l) const { return of[l]; }
  [[gnu::always_inline]] void put(int l, T a) { of[l] = a; }
};
template <class S>
struct ByLane<Slope<S>> {
  ByLane<S> value, x, y, z;
  [[gnu::always_inline]] Slope<S> operator[](int l) const { return {value[l], x[l], y[l], z[l]}; }
  [[gnu::always_inline]] void put(int l, const Slope<S>& a) {
    value.put(l, a.value);
    x.put(l, a.x);
    y.put(l, a.y);
    z.put(l, a.z);
  }
};

/// In a fixed order, whatever the instructions.
template <class S>
[[gnu::always_inline]] inline S sum_of(ByLane<S>& a) {
  static_assert(torus_lanes == 12);
  for (int l = 0; l < 4; ++l) a.of[l] += a.of[l + 4] + a.of[l + 8];
  return (a.of[0] + a.of[2]) + (a.of[1] + a.of[3]);
}
template <class S>
[[gnu::always_inline]] inline Slope<S> sum_of(ByLane<Slope<S>>& a) {
  return {sum_of(a.value), sum_of(a.x), sum_of(a.y), sum_of(a.z)};
}

/// What depends on the place, lane by lane: without its derivatives.
template <class S>
struct Plain {
  using Number = S;
  const TorusLanes<S>& t;

  [[gnu::always_inline]] S squared(int l) const { return t.squared[l]; }
  [[gnu::always_inline]] S excess(int l) const { return t.excess[l]; }
  [[gnu::always_inline]] S along(const S (&axis)[3][torus_lanes], int l) const {
    return t.x[0][l] * axis[0][l] + t.x[1][l] * axis[1][l] + t.x[2][l] * axis[2][l];
  }
  [[gnu::always_inline]] S patch(const S (&across)[3][torus_lanes], int l) const {
    return patch_distance<S, S>(t.k1[l], t.k2[l], t.rho[l], along(t.e1, l), along(across, l),
                                along(t.n, l));
  }
};

/// With them.
template <class S>
struct Sloped {
  using Number = Slope<S>;
  const TorusLanes<S>& t;
  const TorusAway<S>& away;

  [[gnu::always_inline]] Slope<S> squared(int l) const {
    return {t.squared[l], 2 * away.x[0][l], 2 * away.x[1][l], 2 * away.x[2][l]};
  }
  [[gnu::always_inline]] Slope<S> excess(int l) const {
    return {t.excess[l], 2 * (away.x[0][l] - away.x[0][0]), 2 * (away.x[1][l] - away.x[1][0]),
            2 * (away.x[2][l] - away.x[2][0])};
  }
  [[gnu::always_inline]] Slope<S> patch(const S (&across)[3][torus_lanes], int l) const {
    const Plain<S> at{t};
    const PatchSlope<S> g = patch_slope<S>(t.k1[l], t.k2[l], t.rho[l], at.along(t.e1, l),
                                           at.along(across, l), at.along(t.n, l));
    const auto part = [&](int d) {
      return g.along * t.e1[d][l] + g.across * across[d][l] + g.normal * t.n[d][l];
    };
    return {g.g, part(0), part(1), part(2)};
  }
};

template <class Place, class S>
[[gnu::always_inline]] inline void blend_lanes(const Place& place, int n, int known,
                                               BlendedTori<S, typename Place::Number>& out) {
  using std::sqrt;
  using T = typename Place::Number;
  const TorusLanes<S>& t = place.t;
  ByLane<T> d, decay, a, b;
  ByLane<S> c;
  for (int l = 0; l < torus_lanes; ++l) d.put(l, sqrt(T(place.squared(l) + T(torus_tiny<S>))));
  const T nearest = d[0], farthest = d[n - 1];
  for (int l = 0; l < torus_lanes; ++l) {
    const T closeness = T(S(1)) - d[l] / farthest;
    const T w = t.used[l] * (closeness * closeness + T(S(1e-9)));
    a.put(l, w * t.rho[l]);
    b.put(l, w);
  }
  const T rho = sum_of(a) / sum_of(b);
  const T rate = T(-S(blend_sharpness)) / rho;
  for (int l = 0; l < torus_lanes; ++l)
    decay.put(l, exponential(T(rate * (place.excess(l) / (d[l] + nearest)))));
  const T last = decay[n - 1];
  const S side = static_cast<S>(known);
  alignas(64) S across[3][torus_lanes];
  for (int l = 0; l < torus_lanes; ++l) {
    const S nx = t.n[0][l], ny = t.n[1][l], nz = t.n[2][l];
    const S ex = t.e1[0][l], ey = t.e1[1][l], ez = t.e1[2][l];
    across[0][l] = ny * ez - nz * ey;
    across[1][l] = nz * ex - nx * ez;
    across[2][l] = nx * ey - ny * ex;
  }
  for (int l = 0; l < torus_lanes; ++l) {
    const T w = t.used[l] * (t.weight[l] * (decay[l] - last) + T(S(blend_floor)));
    const T g = place.patch(across, l);
    const bool inside = g < T(S(0));
    const S sign = inside ? S(-1) : S(1);
    a.put(l, w * ((side > 0 ? sign : side < 0 ? -sign : S(1)) * g));
    b.put(l, w);
    c.put(l, inside ? value_of(w) : S(0));
  }
  const T total = sum_of(b);
  out.phi = sum_of(a) / total;
  out.rho = rho;
  out.nearest = value_of(nearest);
  out.negative = sum_of(c) / value_of(total);
}

template <class S>
void blend_plain(const TorusLanes<S>& t, int n, int known, BlendedTori<S, S>& out) {
  blend_lanes(Plain<S>{t}, n, known, out);
}
template <class S>
void slope_plain(const TorusLanes<S>& t, const TorusAway<S>& away, int n, int known,
                 BlendedTori<S, Slope<S>>& out) {
  blend_lanes(Sloped<S>{t, away}, n, known, out);
}

#if defined(__x86_64__)
template <class S>
[[gnu::target("avx2")]] void blend_avx2(const TorusLanes<S>& t, int n, int known,
                                        BlendedTori<S, S>& out) {
  blend_lanes(Plain<S>{t}, n, known, out);
}
template <class S>
[[gnu::target("avx2")]] void slope_avx2(const TorusLanes<S>& t, const TorusAway<S>& away, int n,
                                        int known, BlendedTori<S, Slope<S>>& out) {
  blend_lanes(Sloped<S>{t, away}, n, known, out);
}
#endif

}  // namespace

template <class S>
BlendKernel<S>* blend_kernel() {
  static BlendKernel<S>* const best = LITTORAL_FASTEST(&blend_plain<S>, &blend_avx2<S>);
  return best;
}

template <class S>
SlopeKernel<S>* slope_kernel() {
  static SlopeKernel<S>* const best = LITTORAL_FASTEST(&slope_plain<S>, &slope_avx2<S>);
  return best;
}

template BlendKernel<float>* blend_kernel<float>();
template BlendKernel<double>* blend_kernel<double>();
template SlopeKernel<float>* slope_kernel<float>();
template SlopeKernel<double>* slope_kernel<double>();

}  // namespace littoral
