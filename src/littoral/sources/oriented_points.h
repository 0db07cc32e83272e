#pragma once
// What distance in space is measured from: meshes, soups and clouds become the same thing.

#include "littoral/base/types.h"

namespace littoral {

/// Samples of an oriented surface.
struct OrientedPoints {
  MatX3 points{0, 3};   // samples x 3
  MatX3 normals{0, 3};  // samples x 3, unit, outward: distance is positive where they point
  VecX areas;           // samples [length^2], > 0

  Eigen::Index size() const { return points.rows(); }
};

}  // namespace littoral
