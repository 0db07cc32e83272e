#pragma once
// One triangle from its three side lengths: everything the operators need, no coordinates.

#include <algorithm>
#include <array>
#include <cmath>

#include "littoral/types.h"

namespace littoral {

/// Products of vectors in the plane.
namespace plane {
inline double cross(Complex a, Complex b) { return a.real() * b.imag() - a.imag() * b.real(); }
inline double dot(Complex a, Complex b) { return a.real() * b.real() + a.imag() * b.imag(); }
}  // namespace plane

/// Side k runs from corner k to corner k+1. Laid out in the plane with corner 0 at the origin and
/// corner 1 on the positive real axis; `mirrored` puts corner 2 below the axis instead of above.
struct TriangleShape {
  double area;                  // [length^2]
  std::array<double, 3> cot;    // cotangent at each corner (eq. 5)
  std::array<Complex, 3> p;     // corner positions
  std::array<Complex, 3> side;  // unit vector of side k

  Complex at(const std::array<double, 3>& b) const {  // barycentric
    return b[0] * p[0] + b[1] * p[1] + b[2] * p[2];
  }
};

/// Area by Kahan's ordering of Heron's formula, accurate for needles; lengths must satisfy the
/// triangle inequality strictly.
inline double area_of_lengths(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (a < c) std::swap(a, c);
  if (b < c) std::swap(b, c);
  const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return 0.25 * std::sqrt(std::max(0.0, product));
}

/// a^2 + b^2 - c^2, also where the shorter of a and b is less than the round-off of the others.
inline double law_of_cosines(double a, double b, double c) {
  const double least = std::min({a, b, c});
  if (least > 1e-6 * std::max({a, b, c})) return a * a + b * b - c * c;
  if (a < b) std::swap(a, b);
  return b * b + (a - c) * (a + c);
}

/// Cotangent of the angle between sides of lengths a and b, across from c; as in `triangle_shape`.
inline double cotangent_across(double a, double b, double c) {
  return law_of_cosines(a, b, c) / (4 * area_of_lengths(a, b, c));
}

inline TriangleShape triangle_shape(double l0, double l1, double l2, bool mirrored) {
  TriangleShape t;
  t.area = area_of_lengths(l0, l1, l2);
  const double four = 4 * t.area, along = law_of_cosines(l0, l2, l1);
  t.cot = {along / four, law_of_cosines(l0, l1, l2) / four, law_of_cosines(l1, l2, l0) / four};
  const double y = 2 * t.area / l0;
  t.p = {Complex(0, 0), Complex(l0, 0), Complex(along / (2 * l0), mirrored ? -y : y)};
  t.side = {Complex(1, 0), (t.p[2] - t.p[1]) / l1, -t.p[2] / l2};
  return t;
}

}  // namespace littoral
