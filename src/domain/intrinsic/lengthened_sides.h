#pragma once
// Triangles made less thin by longer sides.

#include "domain/intrinsic/intrinsic_triangulation.h"

namespace littoral {

/// Where two sides of a triangle are less than `margin` times the longest longer than the third,
/// all its sides are lengthened equally until they are, its own alone: by less than that share.
/// Returns how many triangles were.
int lengthen_sides(IntrinsicTriangulation& T, double margin);

/// The same by up to a millionth, with a warning: for methods that iterate with the factor of a
/// matrix, whose entries range over the square of what sides do.
IntrinsicTriangulation without_needles(IntrinsicTriangulation T, Report& report);

}  // namespace littoral
