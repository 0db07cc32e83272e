#pragma once
// Exact distance to a level set, on the grid it was taken from: the second step of opening and
// closing.

#include "base/task.h"
#include "littoral/polygon_soup.h"
#include "littoral/types.h"
#include "littoral/volume.h"

namespace littoral {

/// Signed distance [length] at the nodes to `surface`, the triangles of the level set {values =
/// level}: negative where values are at most the level. Magnitudes are cut off at `reach` [length];
/// nodes farther away cost next to nothing. The surface need not be closed, and without triangles
/// every node is farther than `reach`. Throws InputError for a wrong number of values.
VecX redistance(const Grid& grid, const VecX& values, double level, const PolygonSoup& surface,
                double reach, const Task& task);

}  // namespace littoral
