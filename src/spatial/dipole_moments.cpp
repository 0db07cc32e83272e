#include "spatial/dipole_moments.h"

#include <cstdlib>

namespace littoral {

namespace {

using Complex = std::complex<double>;

constexpr int place(int l, int m) { return l * (l + 1) / 2 + m; }

/// R_l^m of degrees 0 to dipole_degree - 1.
struct Harmonics {
  std::array<Complex, place(dipole_degree, 0)> values{};

  explicit Harmonics(const Vec3& d) {
    const Complex along(d[0], d[1]);
    const double squared = d.squaredNorm();
    values[0] = 1;
    for (int l = 1; l < dipole_degree; ++l) {
      values[place(l, l)] = along / (2.0 * l) * values[place(l - 1, l - 1)];
      for (int m = 0; m < l; ++m) {
        Complex sum = (2 * l - 1) * d[2] * values[place(l - 1, m)];
        if (m < l - 1) sum -= squared * values[place(l - 2, m)];
        values[place(l, m)] = sum / double((l + m) * (l - m));
      }
    }
  }

  /// Also of negative orders, and 0 where there is none.
  Complex operator()(int l, int m) const {
    if (std::abs(m) > l) return 0;
    if (m >= 0) return values[place(l, m)];
    return (m % 2 == 0 ? 1.0 : -1.0) * std::conj(values[place(l, -m)]);
  }
};

}  // namespace

void DipoleMoments::add(const Vec3& d, const Vec3& area) {
  // d/dz R_l^m = R_{l-1}^m, (d/dx - i d/dy) R_l^m = R_{l-1}^{m-1}, (d/dx + i d/dy) =
  // -R_{l-1}^{m+1}.
  const Harmonics R(d);
  const Complex half(area[0] / 2, area[1] / 2);
  for (int l = 1; l <= dipole_degree; ++l)
    for (int m = 0; m <= l; ++m)
      moments_[place(l, m) - 1] +=
          area[2] * R(l - 1, m) + half * R(l - 1, m - 1) - std::conj(half) * R(l - 1, m + 1);
}

void DipoleMoments::add(const DipoleMoments& other, const Vec3& shift) {
  // R_l^m(d + shift) = sum of R_j^k(d) R_{l-j}^{m-k}(shift).
  const Harmonics R(shift);
  for (int l = 1; l <= dipole_degree; ++l)
    for (int m = 0; m <= l; ++m) {
      Complex sum = 0;
      for (int j = 1; j <= l; ++j)
        for (int k = -j; k <= j; ++k) {
          Complex moment = other.moments_[place(j, std::abs(k)) - 1];
          if (k < 0) moment = (k % 2 == 0 ? 1.0 : -1.0) * std::conj(moment);
          sum += moment * R(l - j, m - k);
        }
      moments_[place(l, m) - 1] += sum;
    }
}

std::array<double, dipole_coefficients> DipoleMoments::coefficients(double unit) const {
  // 1 / |r + d| = sum of (-1)^l |r|^{-l-1} |d|^l P_l(cos of their angle), by the addition theorem;
  // the leading coefficient of d^m P_l / dz^m is (2l - 1)!! / (l - m)!.
  std::array<double, dipole_coefficients> out{};
  double scale = 1;  // (-1)^{l+1} (2l - 1)!! / unit^{l-1}
  std::size_t at = 0;
  for (int l = 1; l <= dipole_degree; ++l) {
    if (l > 1) scale = unit > 1e-30 ? -scale * (2 * l - 1) / unit : 0;
    for (int m = 0; m <= l; ++m) {
      const Complex moment = moments_[place(l, m) - 1];
      out[at++] = scale * (m == 0 ? 1 : 2) * moment.real();
      if (m > 0) out[at++] = scale * 2 * moment.imag();
    }
  }
  return out;
}

}  // namespace littoral
