// Loops over lanes that compilers turn into vector instructions: no calls, no branches (see
// CMakeLists for what the compiler may assume here).

#include "methods/tori/torus_kernels.h"

#include <bit>
#include <cstdint>

#include "base/kernel_choice.h"
#include "methods/tori/torus.h"

namespace littoral {

namespace {

constexpr int lanes = torus_lanes;

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

/// In a fixed order, whatever the instructions.
template <class S>
[[gnu::always_inline]] inline S sum_of(S* a) {
  static_assert(lanes == 12);
  for (int l = 0; l < 4; ++l) a[l] += a[l + 4] + a[l + 8];
  return (a[0] + a[2]) + (a[1] + a[3]);
}

template <class S>
[[gnu::always_inline]] inline void blend_lanes(const TorusLanes<S>& t, int n, int known,
                                               BlendedTori<S>& out) {
  alignas(64) S d[lanes], decay[lanes], a[lanes], b[lanes], c[lanes];
  for (int l = 0; l < lanes; ++l) d[l] = std::sqrt(t.squared[l] + torus_tiny<S>);
  const S nearest = d[0], farthest = d[n - 1];
  for (int l = 0; l < lanes; ++l) {
    const S closeness = 1 - d[l] / farthest;
    const S w = t.used[l] * (closeness * closeness + S(1e-9));
    a[l] = w * t.rho[l];
    b[l] = w;
  }
  const S rho = sum_of(a) / sum_of(b);
  const S rate = -S(blend_sharpness) / rho;
  for (int l = 0; l < lanes; ++l) decay[l] = exponential(rate * (t.excess[l] / (d[l] + nearest)));
  const S last = decay[n - 1];
  const S side = static_cast<S>(known);
  for (int l = 0; l < lanes; ++l) {
    const S w = t.used[l] * (t.weight[l] * (decay[l] - last) + S(blend_floor));
    const S x = t.x[0][l], y = t.x[1][l], z = t.x[2][l];
    const S nx = t.n[0][l], ny = t.n[1][l], nz = t.n[2][l];
    const S ex = t.e1[0][l], ey = t.e1[1][l], ez = t.e1[2][l];
    const S fx = ny * ez - nz * ey, fy = nz * ex - nx * ez, fz = nx * ey - ny * ex;
    const S u = x * ex + y * ey + z * ez, v = x * fx + y * fy + z * fz;
    const S g = patch_distance<S, S>(t.k1[l], t.k2[l], t.rho[l], u, v, x * nx + y * ny + z * nz);
    const S size = g < 0 ? -g : g;
    a[l] = w * (side > 0 ? size : side < 0 ? -size : g);
    b[l] = w;
    c[l] = g < 0 ? w : S(0);
  }
  const S total = sum_of(b);
  out.phi = sum_of(a) / total;
  out.rho = rho;
  out.nearest = nearest;
  out.negative = sum_of(c) / total;
}

template <class S>
void blend_plain(const TorusLanes<S>& t, int n, int known, BlendedTori<S>& out) {
  blend_lanes(t, n, known, out);
}

#if defined(__x86_64__)
template <class S>
[[gnu::target("avx2")]] void blend_avx2(const TorusLanes<S>& t, int n, int known,
                                        BlendedTori<S>& out) {
  blend_lanes(t, n, known, out);
}
#endif

}  // namespace

template <class S>
BlendKernel<S>* blend_kernel() {
  static BlendKernel<S>* const best = LITTORAL_FASTEST(&blend_plain<S>, &blend_avx2<S>);
  return best;
}

template BlendKernel<float>* blend_kernel<float>();
template BlendKernel<double>* blend_kernel<double>();

}  // namespace littoral
