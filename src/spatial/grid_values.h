#pragma once
// A function of space at the nodes of a grid.

#include <functional>

#include "base/task.h"
#include "littoral/volume.h"

namespace littoral {

/// value(x, last) at every node, along rows on all threads; `last` is -1 at the first node of a row
/// and then whatever the call before left in it.
VecX grid_values(const Grid& grid, const Task& task,
                 const std::function<double(const Vec3& x, int& last)>& value);

/// The nodes themselves, in their order (nodes x 3).
MatX3 grid_points(const Grid& grid);

}  // namespace littoral
