#include "spatial/exact_signs.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>

namespace littoral {

namespace {

using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>,
                                              boost::multiprecision::et_off>;

constexpr double half_ulp = std::numeric_limits<double>::epsilon() / 2;
constexpr double bound_3d = (7 + 56 * half_ulp) * half_ulp;
constexpr double bound_2d = (3 + 16 * half_ulp) * half_ulp;
constexpr double underflows = 1e-280;  // below it, products may have lost digits

/// The numbers times a common power of two that makes them integers.
template <int n>
std::array<Integer, n> integers(const std::array<double, n>& x) {
  constexpr int digits = std::numeric_limits<double>::digits;
  std::array<int, n> exponent{};
  std::array<long long, n> mantissa{};
  int least = std::numeric_limits<int>::max();
  for (int i = 0; i < n; ++i) {
    mantissa[i] = static_cast<long long>(std::ldexp(std::frexp(x[i], &exponent[i]), digits));
    if (mantissa[i] != 0) least = std::min(least, exponent[i]);
  }
  std::array<Integer, n> out;
  for (int i = 0; i < n; ++i)
    if (mantissa[i] != 0) out[i] = Integer(mantissa[i]) << (exponent[i] - least);
  return out;
}

int exact_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto x =
      integers<12>({a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2], d[0], d[1], d[2]});
  std::array<Integer, 9> m;
  for (int i = 0; i < 9; ++i) m[i] = x[i + 3] - x[i % 3];
  const Integer det = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                      m[2] * (m[3] * m[7] - m[4] * m[6]);
  return det.sign();
}

int exact_sign(const Vec2& a, const Vec2& b, const Vec2& c) {
  const auto x = integers<6>({a[0], a[1], b[0], b[1], c[0], c[1]});
  const Integer det = (x[2] - x[0]) * (x[5] - x[1]) - (x[3] - x[1]) * (x[4] - x[0]);
  return det.sign();
}

int sign_beyond(double value, double error, bool* certain) {
  *certain = value > error || value < -error;
  return value > 0 ? 1 : -1;
}

}  // namespace

int orientation_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double xy[2] = {v[0] * w[1], v[1] * w[0]}, yz[2] = {v[1] * w[2], v[2] * w[1]},
               zx[2] = {v[2] * w[0], v[0] * w[2]};
  const double det = u[2] * (xy[0] - xy[1]) + u[0] * (yz[0] - yz[1]) + u[1] * (zx[0] - zx[1]);
  const double size = std::abs(u[2]) * (std::abs(xy[0]) + std::abs(xy[1])) +
                      std::abs(u[0]) * (std::abs(yz[0]) + std::abs(yz[1])) +
                      std::abs(u[1]) * (std::abs(zx[0]) + std::abs(zx[1]));
  bool certain = false;
  const int sign = sign_beyond(det, bound_3d * size, &certain);
  return certain && size > underflows ? sign : exact_sign(a, b, c, d);
}

int orientation_sign(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (b[0] - a[0]) * (c[1] - a[1]), right = (b[1] - a[1]) * (c[0] - a[0]);
  const double size = std::abs(left) + std::abs(right);
  bool certain = false;
  const int sign = sign_beyond(left - right, bound_2d * size, &certain);
  return certain && size > underflows ? sign : exact_sign(a, b, c);
}

}  // namespace littoral
