#pragma once
// On which side a point lies, without rounding.

#include "littoral/types.h"

namespace littoral {

/// The sign, -1, 0 or 1, of det(b - a, c - a, d - a): 1 where a, b, c are counter-clockwise seen
/// from d. Exact for all finite coordinates: in floating point where the error
/// bound of Shewchuk ("Adaptive precision floating-point arithmetic and fast robust geometric
/// predicates", 1997, stage A) allows, otherwise in integers.
int orientation_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The sign of the area of a, b, c, 1 where they are counter-clockwise. Likewise.
int orientation_sign(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace littoral
