#pragma once
// Values at the nodes of a grid.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/types.h"
#include "domain/volume/grid.h"

namespace littoral {

/// A function in a box, linear along each axis between nodes.
struct VolumeField {
  Grid grid;
  VecX values;  // nodes, x fastest
  std::string name = "distance";
};

/// The value at a point of the box, in node units (0 <= at <= n - 1); each axis needs two nodes.
/// Nodes of weight zero do not count, so infinite values reach no farther than their cells.
inline double interpolate(const VolumeField& field, const Vec3& at) {
  std::array<int, 3> cell;
  Vec3 t;
  for (int a = 0; a < 3; ++a) {
    cell[a] = std::clamp(static_cast<int>(std::floor(at[a])), 0, field.grid.n[a] - 2);
    t[a] = at[a] - cell[a];
  }
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int i = c & 1, j = c >> 1 & 1, k = c >> 2;
    const double weight = (i ? t[0] : 1 - t[0]) * (j ? t[1] : 1 - t[1]) * (k ? t[2] : 1 - t[2]);
    if (weight == 0) continue;
    sum += weight * field.values[static_cast<Eigen::Index>(
                        field.grid.node(cell[0] + i, cell[1] + j, cell[2] + k))];
  }
  return sum;
}

}  // namespace littoral
