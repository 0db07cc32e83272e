#pragma once
// The closed surface of a broken input.

#include "api/space/sdf.h"
#include "base/task.h"
#include "littoral/repair.h"

namespace littoral {

constexpr int repair_nodes = 128;  // along the longest side, where none are asked for

/// As `repair` (littoral/repair.h), with the distance from the input at the vertices as scalar
/// "distance"; the report says what was changed.
PolygonSoup repair_surface(const PolygonSoup& input, const RepairOptions& options,
                           const SpaceRequest& request, Task task, Report& report);

}  // namespace littoral
