#pragma once
// The Lorentz cone x0 >= |(x1, ..., x_{N-1})| and what an interior-point method needs of it.

#include <Eigen/Core>
#include <cmath>

namespace littoral::lorentz {

template <int N>
using Vec = Eigen::Matrix<double, N, 1>;

/// x0^2 - |x1..|^2, without cancellation.
template <int N>
double det(const Vec<N>& x) {
  const double tail = x.template tail<N - 1>().norm();
  return (x[0] - tail) * (x[0] + tail);
}

/// Jordan product x o y.
template <int N>
Vec<N> product(const Vec<N>& x, const Vec<N>& y) {
  Vec<N> r = x[0] * y + y[0] * x;
  r[0] = x.dot(y);
  return r;
}

/// x^{-1}: x o x^{-1} = (1, 0, ...).
template <int N>
Vec<N> inverse(const Vec<N>& x) {
  Vec<N> y = -x;
  y[0] = x[0];
  return y / det<N>(x);
}

/// f(eigenvalue) in place of both eigenvalues x0 +- |x1..| of x.
template <int N, class F>
Vec<N> spectral(const Vec<N>& x, F f) {
  const double tail = x.template tail<N - 1>().norm();
  const double a = f(x[0] + tail), b = f(x[0] - tail);
  Vec<N> y = tail > 0 ? Vec<N>(x * (0.5 * (a - b) / tail)) : Vec<N>(Vec<N>::Zero());
  y[0] = 0.5 * (a + b);
  return y;
}

/// A point inside the cone with what is asked of it again and again.
template <int N>
struct Interior {
  Vec<N> x;
  Vec<N> unit;          // x / sqrt(det x)
  double inverse_root;  // 1 / sqrt(det x)

  Interior() = default;
  Interior(const Vec<N>& point, double root)
      : x(point), unit(point / root), inverse_root(1 / root) {}

  /// The y with x o y = r.
  Vec<N> divide(const Vec<N>& r) const {
    const double y0 = (2 * unit[0] * r[0] - unit.dot(r)) * inverse_root;
    Vec<N> y = (r - y0 * x) / x[0];
    y[0] = y0;
    return y;
  }
  /// 1 / a for the largest a with x + a d in the cone; 0 or less if there is none.
  double inverse_step(const Vec<N>& d) const {
    // In the frame that takes x to a multiple of (1, 0, ...): the step ends where 1 + a r0 = a |r|.
    const double r0 = 2 * unit[0] * d[0] - unit.dot(d);
    const double k = (r0 + d[0]) / (unit[0] + 1);
    const double r = (d.template tail<N - 1>() - k * unit.template tail<N - 1>()).norm();
    return (r - r0) * inverse_root;
  }
};

/// Nesterov-Todd scaling of a pair s, z inside the cone: the symmetric W with W z = W^{-1} s.
template <int N>
struct Scaling {
  double eta = 1;
  Vec<N> w = Vec<N>::Unit(0);  // det w = 1; W = eta P, P the boost that squares to 2 w w^T - J

  /// Sets W and lambda = W z. False if s or z is not inside the cone.
  bool set(const Vec<N>& s, const Vec<N>& z, Interior<N>& lambda) {
    const double ds = det<N>(s), dz = det<N>(z);
    if (!(ds > 0 && dz > 0 && s[0] > 0 && z[0] > 0)) return false;
    const double a = std::sqrt(ds), b = std::sqrt(dz);
    const double gamma = std::sqrt(0.5 * (1 + s.dot(z) / (a * b)));
    w = (s / a - z / b) / (2 * gamma);
    w[0] = std::sqrt(1 + w.template tail<N - 1>().squaredNorm());
    eta = std::sqrt(a / b);
    lambda = Interior<N>(apply(z), std::sqrt(a * b));
    return std::isfinite(eta) && std::isfinite(w[0]);
  }
  Vec<N> apply(const Vec<N>& x) const { return boosted(x, w.template tail<N - 1>()) * eta; }
  Vec<N> apply_inverse(const Vec<N>& x) const {
    return boosted(x, -w.template tail<N - 1>()) / eta;
  }

 private:
  template <class Tail>
  Vec<N> boosted(const Vec<N>& x, const Tail& v) const {
    const double d = v.dot(x.template tail<N - 1>());
    Vec<N> r;
    r[0] = w[0] * x[0] + d;
    r.template tail<N - 1>() = x.template tail<N - 1>() + (x[0] + d / (1 + w[0])) * v;
    return r;
  }
};

}  // namespace littoral::lorentz
