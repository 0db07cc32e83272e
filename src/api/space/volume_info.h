#pragma once
// What is in a volume.

#include <vector>

#include "api/surface/mesh_info.h"
#include "littoral/volume.h"

namespace littoral {

/// Facts about a volume: nodes, box, spacing, range of the finite values, how many are not finite
/// or negative.
std::vector<InfoEntry> volume_info(const Volume& volume);

}  // namespace littoral
