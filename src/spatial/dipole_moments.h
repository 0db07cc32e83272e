#pragma once
// Multipole expansion of the field of vector areas: what a cluster of a winding number's sum is far
// away.

#include <array>
#include <complex>

#include "littoral/types.h"

namespace littoral {

/// The expansion keeps solid harmonics of degree 1 (the vector area) to this one.
constexpr int dipole_degree = 5;
/// Real numbers of an expansion: 3 of degree 1, 5 of degree 2, ...
constexpr int dipole_coefficients = (dipole_degree + 1) * (dipole_degree + 1) - 1;

/// Moments of vector areas a at d about a centre,
///   M_l^m = sum of a . grad R_l^m(d),  R_l^m(d) = |d|^l P_l^m(cos theta) e^{i m phi} / (l + m)!,
/// with P_l^m = (1 - z^2)^{m/2} d^m P_l / dz^m. In this scale derivatives and shifts of R are sums
/// of products of R without further factors.
class DipoleMoments {
 public:
  /// Adds a vector area at d from the centre.
  void add(const Vec3& d, const Vec3& area);

  /// Adds moments about a centre that lies at `shift` from this one.
  void add(const DipoleMoments& other, const Vec3& shift);

  /// The numbers of an expansion in u = r / |r| and t = unit / |r|, r from the place q of the
  /// field to the centre:
  ///   sum of a . g = |r|^{-2} sum_l t^{l-1} sum_m q_lm(u_z) (A_lm C_m + B_lm S_m),
  /// g = x / |x|^3 from q, C_m + i S_m = (u_x + i u_y)^m, q_lm the multiple of d^m P_l / dz^m with
  /// leading coefficient 1. Degree by degree: A_l0, A_l1, B_l1, A_l2, ... Below a `unit` of 1e-30
  /// all items count as being at the centre.
  std::array<double, dipole_coefficients> coefficients(double unit) const;

 private:
  // (l, m) for m = 0 to l, l = 1 to dipole_degree, one after the other.
  std::array<std::complex<double>, (dipole_degree + 1) * (dipole_degree + 2) / 2 - 1> moments_{};
};

}  // namespace littoral
