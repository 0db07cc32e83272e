#pragma once
// Points that lie at one place.

#include "base/groups.h"
#include "littoral/types.h"

namespace littoral {

/// Points by place, ascending; places in the order of their first points. Coordinates must be
/// numbers.
Groups<int> points_by_place(const MatX3& points);

}  // namespace littoral
