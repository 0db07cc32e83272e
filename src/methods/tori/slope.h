#pragma once
// Numbers that carry their gradient in space, for loops over lanes: plain members, no branches.

#include <cmath>

#include "littoral/types.h"

namespace littoral {

/// f(x) in single or double precision S with its derivatives along the axes of space. What formulas
/// written for S give with it is exact but for rounding.
template <class S>
struct Slope {
  S value = 0, x = 0, y = 0, z = 0;

  Slope() = default;
  Slope(S constant) : value(constant) {}  // NOLINT: constants join formulas unasked
  Slope(S v, S dx, S dy, S dz) : value(v), x(dx), y(dy), z(dz) {}
  template <class Other>
  explicit Slope(const Slope<Other>& o)
      : value(static_cast<S>(o.value)),
        x(static_cast<S>(o.x)),
        y(static_cast<S>(o.y)),
        z(static_cast<S>(o.z)) {}

  Vec3 gradient() const { return {x, y, z}; }

  /// f of this, given f and its derivative.
  [[gnu::always_inline]] Slope chain(S f, S first) const {
    return {f, first * x, first * y, first * z};
  }

  [[gnu::always_inline]] friend Slope operator-(const Slope& a) {
    return {-a.value, -a.x, -a.y, -a.z};
  }
  [[gnu::always_inline]] friend Slope operator+(const Slope& a, const Slope& b) {
    return {a.value + b.value, a.x + b.x, a.y + b.y, a.z + b.z};
  }
  [[gnu::always_inline]] friend Slope operator-(const Slope& a, const Slope& b) {
    return {a.value - b.value, a.x - b.x, a.y - b.y, a.z - b.z};
  }
  [[gnu::always_inline]] friend Slope operator*(const Slope& a, const Slope& b) {
    return {a.value * b.value, a.value * b.x + b.value * a.x, a.value * b.y + b.value * a.y,
            a.value * b.z + b.value * a.z};
  }
  [[gnu::always_inline]] friend Slope operator*(S a, const Slope& b) {
    return {a * b.value, a * b.x, a * b.y, a * b.z};
  }
  [[gnu::always_inline]] friend Slope operator*(const Slope& a, S b) { return b * a; }
  [[gnu::always_inline]] friend Slope operator/(const Slope& a, const Slope& b) {
    const S f = a.value / b.value, i = S(1) / b.value;
    return {f, i * (a.x - f * b.x), i * (a.y - f * b.y), i * (a.z - f * b.z)};
  }

  [[gnu::always_inline]] friend Slope sqrt(const Slope& a) {
    const S s = std::sqrt(a.value);
    return a.chain(s, S(0.5) / s);
  }

  [[gnu::always_inline]] friend bool operator<(const Slope& a, const Slope& b) {
    return a.value < b.value;
  }
  [[gnu::always_inline]] friend bool operator>(const Slope& a, const Slope& b) {
    return a.value > b.value;
  }
};

inline float value_of(float a) { return a; }
inline double value_of(double a) { return a; }
template <class S>
[[gnu::always_inline]] inline S value_of(const Slope<S>& a) {
  return a.value;
}

}  // namespace littoral
