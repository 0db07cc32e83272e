#pragma once
// What closes the holes of a surface in space: the set where its winding number is halfway.

#include <array>
#include <functional>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// Triangles over holes, their corners on the level set. They are not joined to one another.
struct LevelPatch {
  MatX3 points{0, 3};
  MatX3i faces{0, 3};  // counter-clockwise seen from outside
  double area = 0;
  double finest = 0;     // side of the cells along the boundary, where the patch ends
  bool complete = true;  // false: the boundary is too long for cells as small as wished for
};

/// The set {inside = 0} where it is not the surface itself.
///
/// `inside` is a winding number of the surface, or minus one, less a level: half an odd number, > 0
/// inside. It jumps by integers across the surface and is harmonic modulo 1 away from the boundary,
/// edges from vertex to vertex. So cells whose centre is far from the level, measured by the
/// distance to the boundary (harmonic functions are no steeper), need not be looked at; the others
/// are halved down to `spacing`, and beside the boundary to an eighth of that, where values are
/// taken modulo 1. Cells of which the surface's cracks alone are near the level are left out.
LevelPatch level_patch(const std::function<double(const Vec3&)>& inside, const MatX3& points,
                       const std::vector<std::array<int, 2>>& boundary, double spacing,
                       const Task& task);

}  // namespace littoral
