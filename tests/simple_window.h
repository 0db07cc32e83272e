#pragma once
// Windows of the simple search (simple_exact.h): rays through one side of one triangle.

#include <algorithm>
#include <cmath>

#include "littoral/types.h"

namespace littoral::test {

/// Rays that enter a triangle through [b0, b1] of a side. Coordinates: the side on the real axis
/// from 0 to its length, the triangle above it. Rays come straight from the image of a point below
/// the axis, or are parallel (from a straight piece of a curve).
struct SimpleWindow {
  int side = 0;            // 3 triangle + k, the side the rays enter through
  bool parallel = false;   // rays of a segment
  bool at_vertex = false;  // rays of a vertex
  double b0 = 0, b1 = 0;
  Complex image;  // of the point; parallel: the rays' unit direction
  double d = 0;   // distance already behind: at the image; parallel: at 0

  /// Distance along the rays to a point of the plane.
  double at(Complex x) const {
    return parallel ? d + (std::conj(image) * x).real() : d + std::abs(x - image);
  }
  Complex direction(double b) const { return parallel ? image : b - image; }

  /// Least distance over the window, what the queue orders by.
  double least() const {
    if (parallel) return std::min(at(b0), at(b1));
    return at(std::clamp(image.real(), b0, b1));
  }

  /// Cuts off what is reached sooner along the side from its start, at distance d_start: at every x
  /// where d_start + x < at(x). at(x) - x never grows with x, so a stretch [b0, x*) goes.
  void trim_start(double d_start, double slack) {
    if (at(b0) <= d_start + b0 + slack) return;
    if (at(b1) > d_start + b1 + slack) {
      b0 = b1;
    } else {
      b0 = std::clamp(meeting(d_start, b0), b0, b1);
    }
  }
  /// The same from the end of the side (at `length`), at distance d_end.
  void trim_end(double d_end, double length, double slack) {
    if (at(b1) <= d_end + (length - b1) + slack) return;
    if (at(b0) > d_end + (length - b0) + slack) {
      b1 = b0;
    } else {
      SimpleWindow mirror = *this;
      mirror.image = parallel ? -std::conj(image) : length - std::conj(image);
      mirror.d = parallel ? at(length) : d;
      b1 = std::clamp(length - mirror.meeting(d_end, length - b1), b0, b1);
    }
  }

 private:
  /// x with at(x) = d_start + x; `otherwise` where rounding leaves none.
  double meeting(double d_start, double otherwise) const {
    const double c = d_start - d;
    const double x =
        parallel ? -c / (1 - image.real()) : (std::norm(image) - c * c) / (2 * (c + image.real()));
    return std::isfinite(x) ? x : otherwise;
  }
};

/// A window turned into the coordinates of another side: that side starts at `start` and runs along
/// the unit vector `along`; what lies left of it there lies above its axis.
inline SimpleWindow seen_from(const SimpleWindow& w, Complex start, Complex along) {
  SimpleWindow v = w;
  v.image = (w.parallel ? w.image : w.image - start) * std::conj(along);
  if (w.parallel) v.d = w.at(start);
  return v;
}

/// The same side as its other triangle sees it, which runs along it (`reversed`: against it).
inline SimpleWindow from_other_side(const SimpleWindow& w, double length, bool reversed) {
  SimpleWindow v = w;
  if (!reversed) {
    v.image = std::conj(w.image);
    return v;
  }
  v.b0 = length - w.b1;
  v.b1 = length - w.b0;
  v.image = w.parallel ? -w.image : length - w.image;
  if (w.parallel) v.d = w.at(length);
  return v;
}

}  // namespace littoral::test
