// Loops over lanes that compilers turn into vector instructions: no calls, no branches. CMakeLists
// lets the compiler assume for this file that square roots set no error number and comparisons do
// not trap.

#include "spatial/winding_kernels.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "base/kernel_choice.h"

namespace littoral {

namespace {

constexpr int lanes = winding_lanes;

// g(c) = (c - q) / |c - q|^3 about the cluster's centre, r = centre - q:
//   a.g = a.r/R^3 + [tr M - 3 r.M r/R^2]/R^3 + [-3/2 second.r + 15/2 cubic(r)/R^2]/R^5.
[[gnu::always_inline]] inline float far_sum(const ClusterLanes& c, const float* q, float accuracy,
                                            unsigned& near) {
  alignas(32) std::array<float, lanes> value;
  alignas(32) std::array<std::int32_t, lanes> is_far;
  const float qx = q[0], qy = q[1], qz = q[2], squared = accuracy * accuracy;
  for (int l = 0; l < lanes; ++l) {
    const float x = c.x[l] - qx, y = c.y[l] - qy, z = c.z[l] - qz;
    const float r2 = x * x + y * y + z * z, reach = squared * c.radius[l] * c.radius[l];
    is_far[l] = std::bit_cast<std::int32_t>(reach - r2) >> 31;  // the sign
    const float i2 = 1 / r2, i3 = i2 * std::sqrt(i2);
    const float quadratic = c.first[0][l] * x * x + c.first[1][l] * y * y + c.first[2][l] * z * z +
                            c.first[3][l] * x * y + c.first[4][l] * y * z + c.first[5][l] * z * x;
    const float cubic = x * (x * (c.cubic[0][l] * x + c.cubic[3][l] * y + c.cubic[4][l] * z) +
                             c.cubic[9][l] * y * z) +
                        y * (y * (c.cubic[1][l] * y + c.cubic[5][l] * x + c.cubic[6][l] * z)) +
                        z * (z * (c.cubic[2][l] * z + c.cubic[7][l] * x + c.cubic[8][l] * y));
    const float second = c.sx[l] * x + c.sy[l] * y + c.sz[l] * z;
    const float v = i3 * (c.ax[l] * x + c.ay[l] * y + c.az[l] * z + c.trace[l] -
                          3 * quadratic * i2 + i2 * (-1.5f * second + 7.5f * cubic * i2));
    value[l] = std::bit_cast<float>(std::bit_cast<std::int32_t>(v) & is_far[l]);
  }
  unsigned bits = 0;
  for (int l = 0; l < lanes; ++l) bits |= (is_far[l] == 0 ? 1u : 0u) << l;
  near = bits;
  // A fixed order of additions, whatever the instructions.
  return ((value[0] + value[4]) + (value[2] + value[6])) +
         ((value[1] + value[5]) + (value[3] + value[7]));
}

[[gnu::always_inline]] inline void angle_lanes(const TriangleLanes& t, const double* q,
                                               AngleLanes& out) {
  const double qx = q[0], qy = q[1], qz = q[2];
  for (int l = 0; l < lanes; ++l) {
    const double ax = t.corner[0][l] - qx, ay = t.corner[1][l] - qy, az = t.corner[2][l] - qz;
    const double bx = t.corner[3][l] - qx, by = t.corner[4][l] - qy, bz = t.corner[5][l] - qz;
    const double cx = t.corner[6][l] - qx, cy = t.corner[7][l] - qy, cz = t.corner[8][l] - qz;
    const double A = std::sqrt(ax * ax + ay * ay + az * az);
    const double B = std::sqrt(bx * bx + by * by + bz * bz);
    const double C = std::sqrt(cx * cx + cy * cy + cz * cz);
    const double num =
        ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
    const double den = A * B * C + (ax * bx + ay * by + az * bz) * C +
                       (bx * cx + by * cy + bz * cz) * A + (cx * ax + cy * ay + cz * az) * B;
    // Zero over a number that cannot be seen where both are: no side.
    const double size = std::abs(num) + std::abs(den) + 1e-300;
    out.num[l] = num / size;
    out.den[l] = den / size;
  }
}

[[gnu::always_inline]] inline double dipole_sum(const DipoleLanes& d, const double* q) {
  alignas(64) std::array<double, lanes> value;
  const double qx = q[0], qy = q[1], qz = q[2];
  for (int l = 0; l < lanes; ++l) {
    const double x = d.at[0][l] - qx, y = d.at[1][l] - qy, z = d.at[2][l] - qz;
    // At the point itself r is zero, and so is what follows.
    const double r2 = x * x + y * y + z * z + 1e-200;
    value[l] = (d.area[0][l] * x + d.area[1][l] * y + d.area[2][l] * z) / (r2 * std::sqrt(r2));
  }
  return ((value[0] + value[4]) + (value[2] + value[6])) +
         ((value[1] + value[5]) + (value[3] + value[7]));
}

float far_plain(const ClusterLanes& c, const float* q, float accuracy, unsigned& near) {
  return far_sum(c, q, accuracy, near);
}
void angles_plain(const TriangleLanes& t, const double* q, AngleLanes& out) {
  angle_lanes(t, q, out);
}
double dipoles_plain(const DipoleLanes& d, const double* q) { return dipole_sum(d, q); }

#if defined(__x86_64__)
// Without fused multiply-add, which rounds otherwise.
[[gnu::target("avx2")]] float far_avx2(const ClusterLanes& c, const float* q, float accuracy,
                                       unsigned& near) {
  return far_sum(c, q, accuracy, near);
}
[[gnu::target("avx2")]] void angles_avx2(const TriangleLanes& t, const double* q, AngleLanes& out) {
  angle_lanes(t, q, out);
}
[[gnu::target("avx2")]] double dipoles_avx2(const DipoleLanes& d, const double* q) {
  return dipole_sum(d, q);
}
#endif

}  // namespace

const WindingKernels& winding_kernels() {
  static const WindingKernels best =
      LITTORAL_FASTEST((WindingKernels{&far_plain, &angles_plain, &dipoles_plain}),
                       (WindingKernels{&far_avx2, &angles_avx2, &dipoles_avx2}));
  return best;
}

}  // namespace littoral
