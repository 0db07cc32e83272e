#pragma once
// A signed torus given by how it touches a surface, not by centre and radii: planes, cylinders and
// spheres are ordinary cases (thesis, section 5.1.1).

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "littoral/types.h"

namespace littoral {

/// The torus that touches the plane through q with normal n, with curvature k1 along e1 and k2
/// across it, |k1| <= |k2|, positive where the surface bends towards n.
struct Torus {
  Vec3 q = Vec3::Zero(), n = Vec3::UnitZ(), e1 = Vec3::UnitX();  // n, e1 unit and orthogonal
  double k1 = 0, k2 = 0;                                         // [1 / length]
  double rho = 0;         // spacing of points around it [length]; the torus is trusted to 1.5 rho
  double log_weight = 0;  // c of the blend, <= 0; less where the fit is poor
};

/// Keeps square roots and quotients of numbers that may be zero from being infinite.
template <class S>
inline constexpr S torus_tiny = sizeof(S) == 8 ? S(1e-300) : S(1e-30);

/// Signed distance to the circle of curvature k that touches the line w = 0 at the origin, at a
/// point (u, w): (1 - sqrt((k u)^2 + (1 - k w)^2)) / k, written so that k = 0 gives w exactly.
template <class S, class T>
[[gnu::always_inline]] inline T circle_distance(S k, const T& u2, const T& w) {
  using std::sqrt;
  const T a = w - S(0.5) * k * (u2 + w * w);
  const T s = S(1) - S(2) * k * a;
  return S(2) * a / (S(1) + (s > S(0) ? T(sqrt(s > S(0) ? s : T(S(1)))) : T(S(0))));
}

/// Distance to a torus and its derivatives along e1, across it and along n.
template <class T>
struct TorusDistance {
  T g, along, across, normal;
};

/// Eq. 5.3 and 5.4 without centre and radii, at a point with coordinates u along e1, v across it
/// and w along n, seen from q: the circle of curvature k1 first, then the tube.
template <class S, class T>
[[gnu::always_inline]] inline TorusDistance<T> torus_distance(S k1, S k2, const T& u, const T& v,
                                                              const T& w) {
  const T c = circle_distance<S, T>(k1, u * u, w);
  const T g = circle_distance<S, T>(k2, v * v, c);
  // Derivatives of the circle's distance c(u, w): (-k u, 1 - k w) / (1 - k c). The denominators
  // vanish on the axes of circle and tube only, where every direction is as good as another.
  constexpr S least = S(1e-9);
  T a = S(1) - k1 * c, b = S(1) - k2 * g;
  a = a < least ? (a > -least ? T(least) : a) : a;
  b = b < least ? (b > -least ? T(least) : b) : b;
  const T through = (S(1) - k2 * c) / b;
  return {g, through * (-k1 * u) / a, -k2 * v / b, through * (S(1) - k1 * w) / a};
}

/// The same distance, but beyond 1.5 rho from q that to the torus' patch of that size rather than
/// to the whole torus, with the torus' sign: a fit says nothing about places far from its points.
/// S is the type of the torus' numbers, T that of places. No branches, no calls: compilers make
/// loops over it into vector instructions.
template <class S, class T>
[[gnu::always_inline]] inline T patch_distance(S k1, S k2, S rho, const T& u, const T& v,
                                               const T& w) {
  using std::sqrt;
  const TorusDistance<T> d = torus_distance<S, T>(k1, k2, u, v, w);
  T fu = u - d.g * d.along, fv = v - d.g * d.across;  // the foot of x on the torus
  const T fw = w - d.g * d.normal;
  const S limit = S(1.5) * rho;
  const T inside = fu * fu + fv * fv;
  const bool beyond = inside + fw * fw > T(limit * limit);
  const T shrink = limit / T(sqrt(T(inside + torus_tiny<S>)));
  fu = fu * shrink;
  fv = fv * shrink;
  const T lift = S(0.5) * (k1 * (fu * fu) + k2 * (fv * fv));
  const T du = u - fu, dv = v - fv, dw = w - lift;
  const T distance = sqrt(T(du * du + dv * dv + dw * dw + torus_tiny<S>));
  const T size = d.g < S(0) ? T(-distance) : distance;
  return beyond ? size : d.g;
}

/// At a place: three numbers T, double or Jet.
template <class T, class Place>
T patch_distance(const Torus& torus, const Place& x) {
  const Vec3 &q = torus.q, &n = torus.n, &e1 = torus.e1, e2 = n.cross(e1);
  const T a = x[0] - T(q[0]), b = x[1] - T(q[1]), c = x[2] - T(q[2]);
  const T u = e1[0] * a + e1[1] * b + e1[2] * c, v = e2[0] * a + e2[1] * b + e2[2] * c;
  return patch_distance<double, T>(torus.k1, torus.k2, torus.rho, u, v,
                                   n[0] * a + n[1] * b + n[2] * c);
}

}  // namespace littoral
