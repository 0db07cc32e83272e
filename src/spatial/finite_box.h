#pragma once
// The box of points, without those that are not finite.

#include <Eigen/Geometry>

#include "littoral/types.h"

namespace littoral {

/// Empty without finite points. points: n x 3.
Eigen::AlignedBox3d finite_box(const MatX3& points);

/// Its longest side; 0 without finite points.
double points_size(const MatX3& points);

}  // namespace littoral
