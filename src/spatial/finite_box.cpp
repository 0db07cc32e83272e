#include "spatial/finite_box.h"

#include <algorithm>

namespace littoral {

Eigen::AlignedBox3d finite_box(const MatX3& points) {
  Eigen::AlignedBox3d box;
  for (const auto& p : points.rowwise())
    if (p.allFinite()) box.extend(Vec3(p.transpose()));
  return box;
}

double points_size(const MatX3& points) {
  const Eigen::AlignedBox3d box = finite_box(points);
  return box.isEmpty() ? 0 : box.sizes().maxCoeff();
}

}  // namespace littoral
