#pragma once
// Which part of a surface another one, made of it, leaves out.

#include "base/task.h"
#include "littoral/polygon_soup.h"
#include "littoral/volume.h"

namespace littoral {

/// Whether the distance, interpolated, is negative at x, or where the grid is nearest to it. Sheets
/// have a positive distance on both sides.
bool is_inside(const Volume& distance, const Vec3& x);

/// Those of the triangles that lie farther than `far` [length] from the surface and not inside,
/// wholly or in part. It is looked at the middles of parts of up to two spacings of the grid, 256
/// at most of a triangle.
PolygonSoup left_out(const PolygonSoup& triangles, const PolygonSoup& surface,
                     const Volume& distance, double far, Task task);

}  // namespace littoral
