#pragma once
// Slow, obvious answers that the fast searches are tested against.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "spatial/triangle_bvh.h"

namespace littoral {

/// Nearest point over all faces by looking at each, in extended precision; the lowest face among
/// equals. points: n x 3; faces: m x 3. Faces with a non-finite corner are left out; `face` is -1
/// where none remains. Time O(m).
inline NearestPoint closest_point_brute_force(const MatX3& points, const MatX3i& faces,
                                              const Vec3& query) {
  using Real = long double;
  using Triple = Eigen::Matrix<Real, 3, 1>;
  NearestPoint best;
  Real best_squared = 0;
  auto offer = [&](int face, const Triple* corner, const std::array<Real, 3>& b) {
    const Triple foot = b[0] * corner[0] + b[1] * corner[1] + b[2] * corner[2];
    const Real squared = foot.squaredNorm();
    if (best.face >= 0 && !(squared < best_squared)) return;
    best_squared = squared;
    best.face = face;
    for (int k = 0; k < 3; ++k) best.barycentric[k] = static_cast<double>(b[k]);
    best.point = (foot + query.cast<Real>()).template cast<double>();
    best.distance = static_cast<double>(std::sqrt(squared));
  };
  for (int f = 0; f < static_cast<int>(faces.rows()); ++f) {
    Triple c[3];
    for (int k = 0; k < 3; ++k)
      c[k] = points.row(faces(f, k)).transpose().cast<Real>() - query.cast<Real>();
    if (!(c[0] + c[1] + c[2]).allFinite()) continue;
    for (int k = 0; k < 3; ++k) {
      const Triple d = c[(k + 1) % 3] - c[k];
      const Real length2 = d.squaredNorm();
      const Real t = length2 > 0 ? std::clamp<Real>(-c[k].dot(d) / length2, 0, 1) : Real(0);
      std::array<Real, 3> b{};
      b[k] = 1 - t;
      b[(k + 1) % 3] = t;
      offer(f, c, b);
    }
    const Triple normal = (c[1] - c[0]).cross(c[2] - c[0]);
    const Real area2 = normal.squaredNorm();
    if (!(area2 > 0)) continue;
    std::array<Real, 3> b;
    for (int k = 0; k < 3; ++k) b[k] = normal.dot(c[(k + 1) % 3].cross(c[(k + 2) % 3])) / area2;
    if (b[0] >= 0 && b[1] >= 0 && b[2] >= 0) offer(f, c, b);
  }
  return best;
}

}  // namespace littoral
