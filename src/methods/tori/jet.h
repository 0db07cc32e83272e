#pragma once
// Numbers that carry their gradient and Laplacian in space: formulas written for plain numbers give
// derivatives, exact but for rounding, when they are asked with these.

#include <cmath>

#include "littoral/types.h"

namespace littoral {

/// f(x) with its gradient and Laplacian at one place of space.
struct Jet {
  double value = 0;
  Vec3 gradient = Vec3::Zero();
  double laplacian = 0;

  Jet() = default;
  Jet(double constant) : value(constant) {}  // NOLINT: constants join formulas unasked
  Jet(double v, Vec3 g, double l) : value(v), gradient(std::move(g)), laplacian(l) {}

  /// The coordinate of that number, at a place.
  static Jet coordinate(const Vec3& x, int axis) { return {x[axis], Vec3::Unit(axis), 0}; }

  friend Jet operator-(const Jet& a) { return {-a.value, -a.gradient, -a.laplacian}; }
  friend Jet operator+(const Jet& a, const Jet& b) {
    return {a.value + b.value, a.gradient + b.gradient, a.laplacian + b.laplacian};
  }
  friend Jet operator-(const Jet& a, const Jet& b) {
    return {a.value - b.value, a.gradient - b.gradient, a.laplacian - b.laplacian};
  }
  /// The Laplacian of a product is a lap b + 2 grad a . grad b + b lap a.
  friend Jet operator*(const Jet& a, const Jet& b) {
    return {a.value * b.value, a.value * b.gradient + b.value * a.gradient,
            a.value * b.laplacian + 2 * a.gradient.dot(b.gradient) + b.value * a.laplacian};
  }
  friend Jet operator*(double a, const Jet& b) {
    return {a * b.value, a * b.gradient, a * b.laplacian};
  }
  friend Jet operator*(const Jet& a, double b) { return b * a; }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const double i = 1 / b.value;
    return a * b.chain(i, -i * i, 2 * i * i * i);
  }
  Jet& operator+=(const Jet& b) { return *this = *this + b; }

  friend Jet sqrt(const Jet& a) {
    const double s = std::sqrt(a.value);
    return a.chain(s, 0.5 / s, -0.25 / (s * a.value));
  }
  friend Jet exp(const Jet& a) {
    const double e = std::exp(a.value);
    return a.chain(e, e, e);
  }

  friend bool operator<(const Jet& a, const Jet& b) { return a.value < b.value; }
  friend bool operator>(const Jet& a, const Jet& b) { return a.value > b.value; }

 private:
  /// f of this, given f and its first two derivatives.
  Jet chain(double f, double first, double second) const {
    return {f, first * gradient, first * laplacian + second * gradient.squaredNorm()};
  }
};

}  // namespace littoral
