#pragma once
// Clouds as methods want them: every point once, with a normal.

#include "littoral/report.h"
#include "sources/oriented_points.h"

namespace littoral {

/// Distinct points with unit normals, in the order given; no areas. Coincident points become one
/// with their mean normal; where normals cancel the point is left out; both with a warning. Throws
/// InputError if a number is not finite (naming the point), a normal is zero, or nothing remains.
OrientedPoints distinct_points(const OrientedPoints& cloud, Report& report);

}  // namespace littoral
