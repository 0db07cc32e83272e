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
// moment(k) is the k-th number of an expansion, here or of a cell (LocalField).
template <class Moment>
[[gnu::always_inline]] inline float harmonic_sum(float X, float Y, float Z, float T,
                                                 const Moment& moment) {
  static_assert(dipole_degree == 5);
  const float c2 = X * X - Y * Y, s2 = 2 * X * Y;
  const float c3 = X * c2 - Y * s2, s3 = X * s2 + Y * c2;
  const float c4 = c2 * c2 - s2 * s2, s4 = 2 * c2 * s2;
  const float c5 = c2 * c3 - s2 * s3, s5 = c2 * s3 + s2 * c3;
  const float ZZ = Z * Z, TT = T * T;
  const float zero =
      (moment(3) * (ZZ - 1.f / 3 * T) + moment(15) * (ZZ * (ZZ - 6.f / 7 * T) + 3.f / 35 * TT)) +
      Z * (moment(0) + moment(8) * (ZZ - 3.f / 5 * T) +
           moment(24) * (ZZ * (ZZ - 10.f / 9 * T) + 5.f / 21 * TT));
  const float q31 = ZZ - 1.f / 5 * T, q41 = ZZ - 3.f / 7 * T;
  const float q51 = ZZ * (ZZ - 2.f / 3 * T) + 1.f / 21 * TT;
  const float A1 =
      (moment(1) + moment(9) * q31 + moment(25) * q51) + Z * (moment(4) + moment(16) * q41);
  const float B1 =
      (moment(2) + moment(10) * q31 + moment(26) * q51) + Z * (moment(5) + moment(17) * q41);
  const float q42 = ZZ - 1.f / 7 * T, q52 = ZZ - 1.f / 3 * T;
  const float A2 = (moment(6) + moment(18) * q42) + Z * (moment(11) + moment(27) * q52);
  const float B2 = (moment(7) + moment(19) * q42) + Z * (moment(12) + moment(28) * q52);
  const float q53 = ZZ - 1.f / 9 * T;
  const float A3 = (moment(13) + moment(29) * q53) + Z * moment(20);
  const float B3 = (moment(14) + moment(30) * q53) + Z * moment(21);
  const float A4 = moment(22) + Z * moment(31), B4 = moment(23) + Z * moment(32);
  return ((zero + ((A1 * X + B1 * Y) + (A2 * c2 + B2 * s2))) +
          ((A3 * c3 + B3 * s3) + (A4 * c4 + B4 * s4)) + (moment(33) * c5 + moment(34) * s5));
}

[[gnu::always_inline]] inline float far_sum(const ClusterLanes& c, const float* q, float share,
                                            unsigned& near) {
  alignas(32) std::array<float, winding_lanes> value;
  alignas(32) std::array<std::int32_t, winding_lanes> is_far;
  const float qx = q[0], qy = q[1], qz = q[2];
  for (int l = 0; l < winding_lanes; ++l) {
    const float rx = c.x[l] - qx, ry = c.y[l] - qy, rz = c.z[l] - qz;
    const float i2 = 1 / (rx * rx + ry * ry + rz * rz), scale = c.radius[l] * i2;
    const float T = c.radius[l] * scale;
    is_far[l] = std::bit_cast<std::int32_t>(T - share) >> 31;  // the sign
    const float v = std::sqrt(i2) * harmonic_sum(rx * scale, ry * scale, rz * scale, T,
                                                 [&](int k) { return c.moments[k][l]; });
    value[l] = std::bit_cast<float>(std::bit_cast<std::int32_t>(v) & is_far[l]);
  }
  unsigned bits = 0;
  for (int l = 0; l < winding_lanes; ++l) bits |= (is_far[l] == 0 ? 1u : 0u) << l;
  near = bits;
  return sum_of(value);
}

[[gnu::always_inline]] inline void field_at(const GroupCluster& c, const PointLanes& q,
                                            std::array<float, winding_lanes>& value) {
  const float x = c.x, y = c.y, z = c.z, radius = c.radius;
  for (int l = 0; l < winding_lanes; ++l) {
    const float rx = x - q.x[l], ry = y - q.y[l], rz = z - q.z[l];
    const float i2 = 1 / (rx * rx + ry * ry + rz * rz), scale = radius * i2;
    value[l] = std::sqrt(i2) * harmonic_sum(rx * scale, ry * scale, rz * scale, radius * scale,
                                            [&](int k) { return c.moments[k]; });
  }
}

[[gnu::always_inline]] inline void field_sum(const GroupCluster& c, PointLanes& q) {
  alignas(32) std::array<float, winding_lanes> value;
  field_at(c, q, value);
  for (int l = 0; l < winding_lanes; ++l) q.sum[l] += value[l];
}

[[gnu::always_inline]] inline unsigned far_field_sum(const GroupCluster& c, float share,
                                                     unsigned of, PointLanes& q) {
  alignas(32) std::array<std::int32_t, winding_lanes> is_far;
  const float x = c.x, y = c.y, z = c.z, reach = c.radius * c.radius;
  for (int l = 0; l < winding_lanes; ++l) {
    const float rx = x - q.x[l], ry = y - q.y[l], rz = z - q.z[l];
    is_far[l] = std::bit_cast<std::int32_t>(reach - share * (rx * rx + ry * ry + rz * rz)) >> 31;
  }
  unsigned far = 0;
  for (int l = 0; l < winding_lanes; ++l) far |= (is_far[l] != 0 ? 1u : 0u) << l;
  far &= of;
  if (far == 0) return of;
  alignas(32) std::array<float, winding_lanes> value;
  field_at(c, q, value);
  for (int l = 0; l < winding_lanes; ++l) {
    const std::int32_t counts = -static_cast<std::int32_t>(far >> l & 1u);
    q.sum[l] += std::bit_cast<float>(std::bit_cast<std::int32_t>(value[l]) & counts);
  }
  return of & ~far;
}

[[gnu::always_inline]] inline void local_sum(const LocalField& field, PointLanes& q) {
  alignas(32) std::array<float, winding_lanes> value;
  for (int l = 0; l < winding_lanes; ++l) {
    const float x = q.x[l], y = q.y[l], z = q.z[l];
    value[l] = field.constant + harmonic_sum(x, y, z, x * x + y * y + z * z,
                                             [&](int k) { return field.moments[k]; });
  }
  for (int l = 0; l < winding_lanes; ++l) q.sum[l] += value[l];
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
void field_plain(const GroupCluster& c, PointLanes& q) { field_sum(c, q); }
unsigned far_field_plain(const GroupCluster& c, float share, unsigned of, PointLanes& q) {
  return far_field_sum(c, share, of, q);
}
void local_plain(const LocalField& field, PointLanes& q) { local_sum(field, q); }
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
[[gnu::target("avx2")]] void field_avx2(const GroupCluster& c, PointLanes& q) { field_sum(c, q); }
[[gnu::target("avx2")]] unsigned far_field_avx2(const GroupCluster& c, float share, unsigned of,
                                                PointLanes& q) {
  return far_field_sum(c, share, of, q);
}
[[gnu::target("avx2")]] void local_avx2(const LocalField& field, PointLanes& q) {
  local_sum(field, q);
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
      LITTORAL_FASTEST((WindingKernels{&far_plain, &field_plain, &local_plain, &far_field_plain,
                                       &narrow_plain, &angles_plain, &dipoles_plain}),
                       (WindingKernels{&far_avx2, &field_avx2, &local_avx2, &far_field_avx2,
                                       &narrow_avx2, &angles_avx2, &dipoles_avx2}));
  return best;
}

}  // namespace littoral
