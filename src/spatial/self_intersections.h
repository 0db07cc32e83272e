#pragma once
// Where a surface passes through itself.

#include <vector>

#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// For each triangle, 1 if it meets another one elsewhere than at the corners and sides that both
/// have, or lies on another one. Corners at one position are one corner. Exact (no tolerance):
/// touching counts as meeting. Triangles of no area and such with a corner that is not finite are
/// left out (0). points: n x 3; faces: m x 3, rows index points. `asked`: per triangle, whether it
/// is of interest (otherwise 0); empty: all are.
std::vector<char> self_intersecting_faces(const MatX3& points, const MatX3i& faces,
                                          const Task& task = {},
                                          const std::vector<char>& asked = {});

}  // namespace littoral
