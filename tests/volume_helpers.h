#pragma once
// Functions in space, sampled on grids.

#include <algorithm>
#include <cmath>

#include "littoral/domain/volume_field.h"

namespace littoral::test {

template <class F>
VolumeField sampled(const Grid& grid, const F& f) {
  VolumeField field{grid, VecX(static_cast<Eigen::Index>(grid.n_nodes())), "distance"};
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i)
        field.values[static_cast<Eigen::Index>(grid.node(i, j, k))] = f(grid.point(i, j, k));
  return field;
}

/// The trilinear interpolant at a point of the box.
inline double trilinear(const VolumeField& field, const Vec3& p) {
  int cell[3];
  double t[3];
  for (int a = 0; a < 3; ++a) {
    const double x = (p[a] - field.grid.origin[a]) / field.grid.spacing[a];
    cell[a] = std::clamp(static_cast<int>(std::floor(x)), 0, field.grid.n[a] - 2);
    t[a] = x - cell[a];
  }
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    double weight = 1;
    int at[3];
    for (int a = 0; a < 3; ++a) {
      at[a] = cell[a] + (c >> a & 1);
      weight *= (c >> a & 1) ? t[a] : 1 - t[a];
    }
    sum += weight * field.values[static_cast<Eigen::Index>(field.grid.node(at[0], at[1], at[2]))];
  }
  return sum;
}

}  // namespace littoral::test
