#pragma once
// A signed torus given by how it touches a surface, not by centre and radii: planes, cylinders and
// spheres are ordinary cases (thesis, section 5.1.1).

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "littoral/base/types.h"

namespace littoral {

/// The torus that touches the plane through q with normal n, with curvature k1 along e1 and k2
/// across it, |k1| <= |k2|, positive where the surface bends towards n.
struct Torus {
  Vec3 q = Vec3::Zero(), n = Vec3::UnitZ(), e1 = Vec3::UnitX();  // n, e1 unit and orthogonal
  double k1 = 0, k2 = 0;                                         // [1 / length]
  double rho = 0;         // spacing of points around it [length]; the torus is trusted to 1.5 rho
  double log_weight = 0;  // c of the blend, <= 0; less where the fit is poor
};

/// Signed distance to the circle of curvature k that touches the line w = 0 at the origin, at a
/// point (u, w): (1 - sqrt((k u)^2 + (1 - k w)^2)) / k, written so that k = 0 gives w exactly.
template <class T>
T circle_distance(double k, const T& u2, const T& w) {
  using std::sqrt;
  const T a = w - 0.5 * k * (u2 + w * w);
  const T s = 1.0 - 2.0 * k * a;
  return 2.0 * a / (1.0 + (s > 0.0 ? T(sqrt(s)) : T(0.0 * s)));
}

/// Distance to a torus and its derivatives along e1, across it and along n.
template <class T>
struct TorusDistance {
  T g, along, across, normal;
};

/// Eq. 5.3 and 5.4 without centre and radii, at a point with coordinates u along e1, v across it
/// and w along n, seen from q: the circle of curvature k1 first, then the tube.
template <class T>
TorusDistance<T> torus_distance(const Torus& torus, const T& u, const T& v, const T& w) {
  const double k1 = torus.k1, k2 = torus.k2;
  const T c = circle_distance<T>(k1, u * u, w);
  const T g = circle_distance<T>(k2, v * v, c);
  // Derivatives of the circle's distance c(u, w): (-k u, 1 - k w) / (1 - k c). The denominators
  // vanish on the axes of circle and tube only, where every direction is as good as another.
  auto safe = [](const T& x) { return x < 1e-9 && x > -1e-9 ? T(0.0 * x + 1e-9) : x; };
  const T a = safe(1.0 - k1 * c), b = safe(1.0 - k2 * g);
  const T through = (1.0 - k2 * c) / b;
  return {g, through * (-k1 * u) / a, -k2 * v / b, through * (1.0 - k1 * w) / a};
}

/// The same, but beyond 1.5 rho from q the distance to the torus' patch of that size rather than to
/// the whole torus, with the torus' sign: a fit says nothing about places far from its points.
template <class T>
T patch_distance(const Torus& torus, const Eigen::Matrix<T, 3, 1>& x) {
  using std::sqrt;
  const Eigen::Matrix<T, 3, 1> y = x - torus.q.cast<T>();
  const Vec3 e2 = torus.n.cross(torus.e1);
  const T u = y.dot(torus.e1.cast<T>()), v = y.dot(e2.cast<T>()), w = y.dot(torus.n.cast<T>());
  const TorusDistance<T> d = torus_distance<T>(torus, u, v, w);
  T fu = u - d.g * d.along, fv = v - d.g * d.across;  // the foot of x on the torus
  const T fw = w - d.g * d.normal;
  const double limit = 1.5 * torus.rho;
  if (!(fu * fu + fv * fv + fw * fw > limit * limit)) return d.g;
  const T flat = sqrt(fu * fu + fv * fv + 1e-300);
  fu = fu * (limit / flat);
  fv = fv * (limit / flat);
  const T lift = 0.5 * (torus.k1 * fu * fu + torus.k2 * fv * fv);
  const T du = u - fu, dv = v - fv, dw = w - lift;
  const T distance = sqrt(du * du + dv * dv + dw * dw + 1e-300);
  return d.g < 0.0 ? T(-distance) : distance;
}

}  // namespace littoral
