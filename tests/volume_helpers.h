#pragma once
// Functions in space, sampled on grids.

#include "littoral/volume.h"

namespace littoral::test {

/// n^3 nodes on the cube of half width `half` around the origin.
inline Grid box_grid(int n, double half = 1) {
  return {{n, n, n}, Vec3::Constant(-half), Vec3::Constant(2 * half / (n - 1))};
}

template <class F>
Volume sampled(const Grid& grid, const F& f) {
  Volume field{grid, VecX(static_cast<Eigen::Index>(grid.n_nodes())), "distance"};
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i)
        field.values[static_cast<Eigen::Index>(grid.node(i, j, k))] = f(grid.point(i, j, k));
  return field;
}

}  // namespace littoral::test
