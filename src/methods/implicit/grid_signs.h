#pragma once
// Inside and outside at the nodes of a grid.

#include <functional>

#include "base/task.h"
#include "littoral/types.h"
#include "littoral/volume.h"

namespace littoral {

/// Makes distances at the nodes of a grid negative where `inside`. It is asked at the first node of
/// each row and after nodes within `reach` of the surface; others are on the side of the one
/// before.
void set_signs(const Grid& grid, double reach, const std::function<bool(const Vec3&)>& inside,
               const Task& task, VecX& values);

}  // namespace littoral
