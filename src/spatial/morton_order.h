#pragma once
// Places in an order in which those near each other mostly stand near each other.

#include <vector>

#include "littoral/types.h"

namespace littoral {

/// The rows of points (n x 3) along a Z-shaped (Morton) curve through a lattice of 2^20 cells a
/// side around them; as they are if a number is not finite.
std::vector<int> morton_order(const MatX3& points);

}  // namespace littoral
