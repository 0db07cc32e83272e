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

// The expansion of dipole_moments.h, degree by degree: its polynomials in u_z stand beside their
// coefficients.
[[gnu::always_inline]] inline float far_sum(const ClusterLanes& c, const float* q, float accuracy,
                                            unsigned& near) {
  static_assert(dipole_degree == 4);
  alignas(32) std::array<float, winding_lanes> value;
  alignas(32) std::array<std::int32_t, winding_lanes> is_far;
  const float qx = q[0], qy = q[1], qz = q[2], squared = accuracy * accuracy;
  const auto& M = c.moments;
  for (int l = 0; l < winding_lanes; ++l) {
    const float rx = c.x[l] - qx, ry = c.y[l] - qy, rz = c.z[l] - qz;
    const float r2 = rx * rx + ry * ry + rz * rz, reach = squared * c.radius[l] * c.radius[l];
    is_far[l] = std::bit_cast<std::int32_t>(reach - r2) >> 31;  // the sign
    const float i2 = 1 / r2, i1 = std::sqrt(i2), t = c.radius[l] * i1;
    const float x = rx * i1, y = ry * i1, z = rz * i1, zz = z * z;
    const float c2 = x * x - y * y, s2 = 2 * x * y;
    const float c3 = x * c2 - y * s2, s3 = x * s2 + y * c2;
    const float c4 = c2 * c2 - s2 * s2, s4 = 2 * c2 * s2;
    const float first = M[0][l] * z + (M[1][l] * x + M[2][l] * y);
    const float second =
        M[3][l] * (zz - 1.f / 3) + z * (M[4][l] * x + M[5][l] * y) + (M[6][l] * c2 + M[7][l] * s2);
    const float third = M[8][l] * (z * (zz - 3.f / 5)) +
                        (zz - 1.f / 5) * (M[9][l] * x + M[10][l] * y) +
                        z * (M[11][l] * c2 + M[12][l] * s2) + (M[13][l] * c3 + M[14][l] * s3);
    const float fourth = M[15][l] * (zz * (zz - 6.f / 7) + 3.f / 35) +
                         (z * (zz - 3.f / 7)) * (M[16][l] * x + M[17][l] * y) +
                         (zz - 1.f / 7) * (M[18][l] * c2 + M[19][l] * s2) +
                         z * (M[20][l] * c3 + M[21][l] * s3) + (M[22][l] * c4 + M[23][l] * s4);
    const float v = i2 * (first + t * (second + t * (third + t * fourth)));
    value[l] = std::bit_cast<float>(std::bit_cast<std::int32_t>(v) & is_far[l]);
  }
  unsigned bits = 0;
  for (int l = 0; l < winding_lanes; ++l) bits |= (is_far[l] == 0 ? 1u : 0u) << l;
  near = bits;
  // A fixed order of additions, whatever the instructions.
  return ((value[0] + value[4]) + (value[2] + value[6])) +
         ((value[1] + value[5]) + (value[3] + value[7]));
}

[[gnu::always_inline]] inline void angle_lanes(const TriangleLanes& t, const double* q,
                                               AngleLanes& out) {
  const double qx = q[0], qy = q[1], qz = q[2];
  for (int l = 0; l < winding_lanes; ++l) {
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
  alignas(64) std::array<double, winding_lanes> value;
  const double qx = q[0], qy = q[1], qz = q[2];
  for (int l = 0; l < winding_lanes; ++l) {
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
