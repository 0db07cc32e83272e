#include "spatial/exact_signs.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>

namespace littoral {

namespace {

namespace mp = boost::multiprecision;
using AnyInteger = mp::number<mp::cpp_int_backend<>, mp::et_off>;
/// Holds the determinant of differences of numbers of `short_bits` bits; nothing is allocated.
using ShortInteger =
    mp::number<mp::cpp_int_backend<512, 512, mp::signed_magnitude, mp::unchecked, void>,
               mp::et_off>;
constexpr int short_bits = 160;

constexpr double half_ulp = std::numeric_limits<double>::epsilon() / 2;
constexpr double bound_3d = (7 + 56 * half_ulp) * half_ulp;
constexpr double bound_2d = (3 + 16 * half_ulp) * half_ulp;
constexpr double underflows = 1e-280;  // below it, products may have lost digits

/// Numbers as mantissas times powers of two, the least of which is `least`.
template <int n>
struct Split {
  std::array<int, n> exponent{};
  std::array<long long, n> mantissa{};
  int least = std::numeric_limits<int>::max(), largest = std::numeric_limits<int>::min();

  explicit Split(const std::array<double, n>& x) {
    constexpr int digits = std::numeric_limits<double>::digits;
    for (int i = 0; i < n; ++i) {
      mantissa[i] = static_cast<long long>(std::ldexp(std::frexp(x[i], &exponent[i]), digits));
      if (mantissa[i] == 0) continue;
      least = std::min(least, exponent[i]);
      largest = std::max(largest, exponent[i]);
    }
  }
  bool is_short() const {
    return largest < least || largest - least + std::numeric_limits<double>::digits <= short_bits;
  }
  /// All numbers times the same power of two.
  template <class Integer>
  std::array<Integer, n> integers() const {
    std::array<Integer, n> out;
    for (int i = 0; i < n; ++i)
      if (mantissa[i] != 0) out[i] = Integer(mantissa[i]) << (exponent[i] - least);
    return out;
  }
};

template <class Integer>
int sign_of(const std::array<Integer, 12>& x) {
  std::array<Integer, 9> m;
  for (int i = 0; i < 9; ++i) m[i] = x[i + 3] - x[i % 3];
  const Integer det = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                      m[2] * (m[3] * m[7] - m[4] * m[6]);
  return det.sign();
}

template <class Integer>
int sign_of(const std::array<Integer, 6>& x) {
  const Integer det = (x[2] - x[0]) * (x[5] - x[1]) - (x[3] - x[1]) * (x[4] - x[0]);
  return det.sign();
}

template <int n>
int exact_sign(const std::array<double, n>& x) {
  const Split<n> split(x);
  return split.is_short() ? sign_of(split.template integers<ShortInteger>())
                          : sign_of(split.template integers<AnyInteger>());
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
  if (certain && size > underflows) return sign;
  for (int k = 0; k < 3; ++k)  // most that are in one plane are so along an axis
    if (a[k] == b[k] && b[k] == c[k] && c[k] == d[k]) return 0;
  return exact_sign<12>({a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2], d[0], d[1], d[2]});
}

int orientation_sign(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (b[0] - a[0]) * (c[1] - a[1]), right = (b[1] - a[1]) * (c[0] - a[0]);
  const double size = std::abs(left) + std::abs(right);
  bool certain = false;
  const int sign = sign_beyond(left - right, bound_2d * size, &certain);
  if (certain && size > underflows) return sign;
  for (int k = 0; k < 2; ++k)
    if (a[k] == b[k] && b[k] == c[k]) return 0;
  return exact_sign<6>({a[0], a[1], b[0], b[1], c[0], c[1]});
}

}  // namespace littoral
