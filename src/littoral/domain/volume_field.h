#pragma once
// Values at the nodes of a grid.

#include <string>

#include "littoral/base/types.h"
#include "littoral/domain/grid.h"

namespace littoral {

/// A function in a box, linear along each axis between nodes.
struct VolumeField {
  Grid grid;
  VecX values;  // nodes, x fastest
  std::string name = "distance";
};

}  // namespace littoral
