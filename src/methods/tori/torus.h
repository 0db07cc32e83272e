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

/// Distance g to a torus and its derivatives along e1, across it and along n; of what these are
/// made: a = 1 - k1 c and b = 1 - k2 g of the distance c to the circle, dg / dc, and the
/// derivatives of c.
template <class T>
struct TorusDistance {
  T g, along, across, normal;
  T a, b, through, circle_along, circle_normal;
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
  return {g,       through * (-k1 * u) / a, -k2 * v / b,        through * (S(1) - k1 * w) / a, a, b,
          through, (-k1 * u) / a,           (S(1) - k1 * w) / a};
}

/// A place beside a torus' patch, the part of the torus within 1.5 rho of q: the place's foot on
/// the torus, where that is drawn to if it lies beyond the patch, and the way from there.
template <class T>
struct PatchFoot {
  TorusDistance<T> torus;
  bool beyond;
  T u, v, length;  // the foot along e1 and across, and its distance from the normal through q
  T shrink;        // what draws it in
  T drawn_u, drawn_v, du, dv, dw, distance;

  /// With the torus' sign.
  [[gnu::always_inline]] T signed_distance() const {
    const T size = torus.g < T(0) ? T(-distance) : distance;
    return beyond ? size : torus.g;
  }
};

template <class S, class T>
[[gnu::always_inline]] inline PatchFoot<T> patch_foot(S k1, S k2, S rho, const T& u, const T& v,
                                                      const T& w) {
  using std::sqrt;
  PatchFoot<T> f;
  f.torus = torus_distance<S, T>(k1, k2, u, v, w);
  const TorusDistance<T>& d = f.torus;
  f.u = u - d.g * d.along;
  f.v = v - d.g * d.across;
  const T fw = w - d.g * d.normal;
  const S limit = S(1.5) * rho;
  const T inside = f.u * f.u + f.v * f.v;
  f.beyond = inside + fw * fw > T(limit * limit);
  f.length = T(sqrt(T(inside + torus_tiny<S>)));
  f.shrink = limit / f.length;
  f.drawn_u = f.u * f.shrink;
  f.drawn_v = f.v * f.shrink;
  const T lift = S(0.5) * (k1 * (f.drawn_u * f.drawn_u) + k2 * (f.drawn_v * f.drawn_v));
  f.du = u - f.drawn_u;
  f.dv = v - f.drawn_v;
  f.dw = w - lift;
  f.distance = sqrt(T(f.du * f.du + f.dv * f.dv + f.dw * f.dw + torus_tiny<S>));
  return f;
}

/// The same distance, but beyond 1.5 rho from q that to the torus' patch of that size rather than
/// to the whole torus, with the torus' sign: a fit says nothing about places far from its points.
/// S is the type of the torus' numbers, T that of places. No branches, no calls: compilers make
/// loops over it into vector instructions.
template <class S, class T>
[[gnu::always_inline]] inline T patch_distance(S k1, S k2, S rho, const T& u, const T& v,
                                               const T& w) {
  return patch_foot<S, T>(k1, k2, rho, u, v, w).signed_distance();
}

template <class S>
struct PatchSlope {
  S g, along, across, normal;
};

/// That distance with its derivatives along e1, across it and along n.
template <class S>
[[gnu::always_inline]] inline PatchSlope<S> patch_slope(S k1, S k2, S rho, S u, S v, S w) {
  const PatchFoot<S> f = patch_foot<S, S>(k1, k2, rho, u, v, w);
  const TorusDistance<S>& d = f.torus;
  // Beyond the patch D = |(u, v, w) - drawn foot|. The foot turns about the normal through q and
  // comes no nearer, so that of its motion only the part along (-v, u) / length counts: A and B are
  // the derivatives of D by the foot's coordinates.
  const S over = 1 / f.distance, tu = -f.v / f.length, tv = f.u / f.length;
  const S by_u = -over * (f.du + f.dw * k1 * f.drawn_u);
  const S by_v = -over * (f.dv + f.dw * k2 * f.drawn_v);
  const S turn = f.shrink * (tu * by_u + tv * by_v);
  const S A = turn * tu, B = turn * tv;
  // The foot is (u - g g_u, v - g g_v), g_v = -k2 v / b and g_u = c_u (1 - k2 c) / b of the
  // circle's distance c, c_u = -k1 u / a, a = 1 - k1 c, b = 1 - k2 g. Hence
  //   grad(v - g g_v) = (e_v - g_v grad g) / b,
  //   grad(u - g g_u) = (1 + m) e_u - g_u grad g / b - c_u (m - g k2 / b) grad c,
  // m = (g k1 / a) (1 - k2 c) / b.
  const S over_b = 1 / d.b, m = d.g * d.through * k1 / d.a;
  const S by_g = (A * d.along + B * d.across) * over_b;
  const S by_c = A * d.circle_along * (m - d.g * k2 * over_b);
  const S sign = d.g < S(0) ? S(-1) : S(1);
  const S along = over * f.du + A * (1 + m) - by_g * d.along - by_c * d.circle_along;
  const S across = over * f.dv + B * over_b - by_g * d.across;
  const S normal = over * f.dw - by_g * d.normal - by_c * d.circle_normal;
  return {f.signed_distance(), f.beyond ? sign * along : d.along,
          f.beyond ? sign * across : d.across, f.beyond ? sign * normal : d.normal};
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
