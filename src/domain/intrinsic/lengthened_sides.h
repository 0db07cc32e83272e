#pragma once
// Triangles made less thin by longer sides.

#include <memory>

#include "domain/intrinsic/intrinsic_triangulation.h"

namespace littoral {

/// Where two sides of a triangle are less than `margin` times the longest longer than the third,
/// all its sides are lengthened equally until they are, its own alone: by less than that share.
/// Sides that are all zero become `margin` times the mean edge. Returns how many triangles were.
int lengthen_sides(IntrinsicTriangulation& T, double margin);

/// The same by up to a millionth, with a warning: for methods that iterate with the factor of a
/// matrix, whose entries range over the square of what sides do. T itself where none is that thin.
std::shared_ptr<const IntrinsicTriangulation> without_needles(
    std::shared_ptr<const IntrinsicTriangulation> T, Report& report);

}  // namespace littoral
