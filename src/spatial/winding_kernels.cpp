// Loops over lanes that compilers turn into vector instructions: no calls, no branches. CMakeLists
// lets the compiler assume for this file that square roots set no error number and comparisons do
// not trap.

#include "spatial/winding_kernels.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "base/kernel_choice.h"
#include "base/vector_lanes.h"

namespace littoral {

namespace {

/// In one order, whatever the instructions.
template <class Lanes>
[[gnu::always_inline]] inline auto sum_of(const Lanes& value) {
  return ((value[0] + value[4]) + (value[2] + value[6])) +
         ((value[1] + value[5]) + (value[3] + value[7]));
}

// The expansion of dipole_moments.h at (X, Y, Z) = radius r / |r|^2, where powers of the distance
// are those of its degrees: t^l q_lm(u_z) C_m is a polynomial of X, Y, Z and T = radius^2 / |r|^2.
// It is summed by orders m, whose polynomials in Z and T serve both of its coefficients.
[[gnu::always_inline]] inline float far_sum(const ClusterLanes& c, const float* q, float share,
                                            unsigned& near) {
  static_assert(dipole_degree == 5);
  alignas(32) std::array<float, winding_lanes> value;
  alignas(32) std::array<std::int32_t, winding_lanes> is_far;
  const float qx = q[0], qy = q[1], qz = q[2];
  const auto& M = c.moments;
  for (int l = 0; l < winding_lanes; ++l) {
    const float rx = c.x[l] - qx, ry = c.y[l] - qy, rz = c.z[l] - qz;
    const float i2 = 1 / (rx * rx + ry * ry + rz * rz), scale = c.radius[l] * i2;
    const float X = rx * scale, Y = ry * scale, Z = rz * scale, T = c.radius[l] * scale;
    is_far[l] = std::bit_cast<std::int32_t>(T - share) >> 31;  // the sign
    const float c2 = X * X - Y * Y, s2 = 2 * X * Y;
    const float c3 = X * c2 - Y * s2, s3 = X * s2 + Y * c2;
    const float c4 = c2 * c2 - s2 * s2, s4 = 2 * c2 * s2;
    const float c5 = c2 * c3 - s2 * s3, s5 = c2 * s3 + s2 * c3;
    const float ZZ = Z * Z, TT = T * T;
    const float zero =
        (M[3][l] * (ZZ - 1.f / 3 * T) + M[15][l] * (ZZ * (ZZ - 6.f / 7 * T) + 3.f / 35 * TT)) +
        Z * (M[0][l] + M[8][l] * (ZZ - 3.f / 5 * T) +
             M[24][l] * (ZZ * (ZZ - 10.f / 9 * T) + 5.f / 21 * TT));
    const float q31 = ZZ - 1.f / 5 * T, q41 = ZZ - 3.f / 7 * T;
    const float q51 = ZZ * (ZZ - 2.f / 3 * T) + 1.f / 21 * TT;
    const float A1 = (M[1][l] + M[9][l] * q31 + M[25][l] * q51) + Z * (M[4][l] + M[16][l] * q41);
    const float B1 = (M[2][l] + M[10][l] * q31 + M[26][l] * q51) + Z * (M[5][l] + M[17][l] * q41);
    const float q42 = ZZ - 1.f / 7 * T, q52 = ZZ - 1.f / 3 * T;
    const float A2 = (M[6][l] + M[18][l] * q42) + Z * (M[11][l] + M[27][l] * q52);
    const float B2 = (M[7][l] + M[19][l] * q42) + Z * (M[12][l] + M[28][l] * q52);
    const float q53 = ZZ - 1.f / 9 * T;
    const float A3 = (M[13][l] + M[29][l] * q53) + Z * M[20][l];
    const float B3 = (M[14][l] + M[30][l] * q53) + Z * M[21][l];
    const float A4 = M[22][l] + Z * M[31][l], B4 = M[23][l] + Z * M[32][l];
    const float v = std::sqrt(i2) *
                    ((zero + ((A1 * X + B1 * Y) + (A2 * c2 + B2 * s2))) +
                     ((A3 * c3 + B3 * s3) + (A4 * c4 + B4 * s4)) + (M[33][l] * c5 + M[34][l] * s5));
    value[l] = std::bit_cast<float>(std::bit_cast<std::int32_t>(v) & is_far[l]);
  }
  unsigned bits = 0;
  for (int l = 0; l < winding_lanes; ++l) bits |= (is_far[l] == 0 ? 1u : 0u) << l;
  near = bits;
  return sum_of(value);
}

/// arg(x + i y), off by 2e-8 and rounding (Abramowitz and Stegun 4.4.49).
[[gnu::always_inline]] inline float angle_of(float y, float x) {
  const float Y = std::abs(y), X = std::abs(x);
  const float s = smaller(X, Y) / larger(X, Y), z = s * s;
  const float p =
      s *
      (1 +
       z * (-.3333314528f +
            z * (.1999355085f +
                 z * (-.1420889944f +
                      z * (.1065626393f +
                           z * (-.0752896400f +
                                z * (.0429096138f + z * (-.0161657367f + z * .0028662257f))))))));
  const float upper = Y > X ? static_cast<float>(M_PI_2) - p : p;
  return std::copysign(x < 0 ? static_cast<float>(M_PI) - upper : upper, y);
}

[[gnu::always_inline]] inline bool narrow_sum(const NarrowTriangleLanes& t, const double* q,
                                              float& sum) {
  // Corners are off by some 2e-7 radii from the query's point of view, and num and den by four
  // times as much times AB + BC + CA. Where den is negative the sign of a small num decides.
  constexpr float least = 0.01f;
  alignas(32) std::array<float, winding_lanes> value;
  alignas(32) std::array<std::int32_t, winding_lanes> is_sure;
  const auto qx = static_cast<float>(q[0] - t.centre[0]);
  const auto qy = static_cast<float>(q[1] - t.centre[1]);
  const auto qz = static_cast<float>(q[2] - t.centre[2]);
  const float blur = least * t.radius;
  for (int l = 0; l < winding_lanes; ++l) {
    const float ax = t.corner[0][l] - qx, ay = t.corner[1][l] - qy, az = t.corner[2][l] - qz;
    const float bx = t.corner[3][l] - qx, by = t.corner[4][l] - qy, bz = t.corner[5][l] - qz;
    const float cx = t.corner[6][l] - qx, cy = t.corner[7][l] - qy, cz = t.corner[8][l] - qz;
    const float A = std::sqrt(ax * ax + ay * ay + az * az);
    const float B = std::sqrt(bx * bx + by * by + bz * bz);
    const float C = std::sqrt(cx * cx + cy * cy + cz * cz);
    const float num =
        ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
    const float BC = B * C;
    const float den = A * BC + (ax * bx + ay * by + az * bz) * C +
                      (bx * cx + by * cy + bz * cz) * A + (cx * ax + cy * ay + cz * az) * B;
    const float unsure = blur * (A * (B + C) + BC) - (std::abs(num) + larger(den, 0.f));
    is_sure[l] = std::bit_cast<std::int32_t>(unsure) >> 31;
    value[l] = angle_of(num, den);
  }
  std::int32_t all = -1;
  for (int l = 0; l < winding_lanes; ++l) all &= is_sure[l];
  sum = sum_of(value);
  return all != 0;
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
  return sum_of(value);
}

float far_plain(const ClusterLanes& c, const float* q, float share, unsigned& near) {
  return far_sum(c, q, share, near);
}
bool narrow_plain(const NarrowTriangleLanes& t, const double* q, float& sum) {
  return narrow_sum(t, q, sum);
}
void angles_plain(const TriangleLanes& t, const double* q, AngleLanes& out) {
  angle_lanes(t, q, out);
}
double dipoles_plain(const DipoleLanes& d, const double* q) { return dipole_sum(d, q); }

#if defined(__x86_64__)
// Without fused multiply-add, which rounds otherwise.
[[gnu::target("avx2")]] float far_avx2(const ClusterLanes& c, const float* q, float share,
                                       unsigned& near) {
  return far_sum(c, q, share, near);
}
[[gnu::target("avx2")]] bool narrow_avx2(const NarrowTriangleLanes& t, const double* q,
                                         float& sum) {
  return narrow_sum(t, q, sum);
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
      LITTORAL_FASTEST((WindingKernels{&far_plain, &narrow_plain, &angles_plain, &dipoles_plain}),
                       (WindingKernels{&far_avx2, &narrow_avx2, &angles_avx2, &dipoles_avx2}));
  return best;
}

}  // namespace littoral
