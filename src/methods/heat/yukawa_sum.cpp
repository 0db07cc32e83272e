#include "methods/heat/yukawa_sum.h"

#include <bit>
#include <cstdint>

#include "base/kernel_choice.h"

namespace littoral {

namespace {

constexpr int lanes = PointBlocks<float>::lanes;
static_assert(lanes == 16);

// Loops that compilers turn into vector instructions: no calls, no branches.

/// max(a, b) of numbers that are not negative: they are in the order of their bits. Comparing
/// floats would keep compilers from making vectors, as it might trap.
[[gnu::always_inline]] inline float at_least(float a, float b) {
  const auto i = std::bit_cast<std::int32_t>(a), j = std::bit_cast<std::int32_t>(b);
  return std::bit_cast<float>(i > j ? i : j);
}

/// The nearest number in [-60, 60].
[[gnu::always_inline]] inline float clamped(float x) {
  constexpr auto most = std::bit_cast<std::uint32_t>(60.0f);
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t size = bits & 0x7fffffffu;
  return std::bit_cast<float>((size < most ? size : most) | (bits & 0x80000000u));
}

/// 1 / sqrt(x): a guess from the exponent, then Newton's iteration.
[[gnu::always_inline]] inline float inverse_root(float x) {
  float y = std::bit_cast<float>(0x5f375a86 - (std::bit_cast<std::int32_t>(x) >> 1));
  y *= 1.5f - 0.5f * x * y * y;
  y *= 1.5f - 0.5f * x * y * y;
  return y * (1.5f - 0.5f * x * y * y);
}

/// e^x, x taken to the nearest number in [-60, 60].
[[gnu::always_inline]] inline float exponential(float x) {
  const float z = clamped(x) * 1.44269504f;
  // Adding this rounds to a whole number, found in the lowest bits.
  constexpr float whole = 12582912.0f;
  const float rounded = z + whole;
  const float f = z - (rounded - whole);  // in [-1/2, 1/2]
  const float p =
      1.0f + f * (0.69314718f +
                  f * (0.24022651f + f * (0.05550411f + f * (0.00961813f + f * 0.00133336f))));
  const std::int32_t n = std::bit_cast<std::int32_t>(rounded) - std::bit_cast<std::int32_t>(whole);
  return std::bit_cast<float>(std::bit_cast<std::int32_t>(p) + n * (1 << 23));
}

[[gnu::always_inline]] inline void add(const PointBlocks<float>::Block& b, const YukawaPlace& q,
                                       YukawaSums& sums) {
  const float *x = b.x.data(), *y = b.y.data(), *z = b.z.data(), *area = b.area.data();
  const float *nx = b.nx.data(), *ny = b.ny.data(), *nz = b.nz.data();
  YukawaSums s = sums;
  alignas(64) float w[lanes];
  for (int l = 0; l < lanes; ++l) {
    const float dx = x[l] - q.x, dy = y[l] - q.y, dz = z[l] - q.z;
    const float squared = at_least(dx * dx + dy * dy + dz * dz, q.least);
    const float inverse = inverse_root(squared);
    w[l] = area[l] * inverse * exponential((q.shift - squared * inverse) * q.inverse);
  }
  for (int l = 0; l < lanes; ++l) {
    s.total[l] += w[l];
    s.x[l] += w[l] * nx[l];
    s.y[l] += w[l] * ny[l];
    s.z[l] += w[l] * nz[l];
  }
  sums = s;
}

void plain_sum(const PointBlocks<float>::Block& b, const YukawaPlace& q, YukawaSums& sums) {
  add(b, q, sums);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void avx2_sum(const PointBlocks<float>::Block& b, const YukawaPlace& q,
                                      YukawaSums& sums) {
  add(b, q, sums);
}
[[gnu::target(LITTORAL_AVX512)]] void avx512_sum(const PointBlocks<float>::Block& b,
                                                 const YukawaPlace& q, YukawaSums& sums) {
  add(b, q, sums);
}
#endif

}  // namespace

YukawaSum* yukawa_sum() {
#if defined(__x86_64__)
  if (LITTORAL_HAS_AVX512) return &avx512_sum;
  if (__builtin_cpu_supports("avx2")) return &avx2_sum;
#endif
  return &plain_sum;
}

}  // namespace littoral
