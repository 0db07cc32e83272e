#pragma once
// Which side of a curve is its left where faces do not agree which way round they lie.

#include "littoral/report.h"
#include "sources/surface/pieces.h"

namespace littoral {

/// Sets `left` of the pieces of signed curves. A curve's left is what its first face says, or what
/// the one curve says that ends where it alone begins; from there it is carried along the curve, so
/// that it stays on one side also across edges of three or more faces and round surfaces that are
/// not orientable. Warns of faces that disagree, and of closed curves whose sides come back
/// exchanged.
void carry_sides(const SurfaceMesh& mesh, PlacedSources& sources, Report& report);

}  // namespace littoral
