#pragma once
// Triangles that add nothing to the surface of others: copies, and those without area that lie
// within a side or at a corner of another one.

#include <array>
#include <vector>

#include "littoral/types.h"

namespace littoral {

/// Whether three corners are in one line or at one point, to the rounding of points in a box of
/// that size.
bool is_flat(const Vec3& a, const Vec3& b, const Vec3& c, double size);

/// For each triangle whether its points all are points of one before it or of one that is not
/// covered, to the rounding of the size of all (4e-16 of the longest side of their box). Of copies
/// the first is not covered; a triangle with area is covered by copies alone.
///
/// Many faces in one place are all equally near: a search that has to name the lowest must look at
/// each of them.
std::vector<bool> covered_triangles(const std::vector<std::array<Vec3, 3>>& corners);

}  // namespace littoral
