#pragma once
// Regularized winding number: convolved with a Gaussian.

#include "littoral/types.h"
#include "spatial/point_tree.h"
#include "spatial/winding_number.h"

namespace littoral {

/// The generalized winding number of oriented points, convolved with a Gaussian of deviation
/// `sigma`: smooth where the winding number jumps or is singular, the same to 1e-5 five deviations
/// away from all points (thesis, sections 3.3 and 7.2; Chen et al., "3D reconstruction with fast
/// dipole sums", 2024). The field of one point with vector area a is
///
///     <a, p - q> / (4 pi r^3) (erf(s) - 2 s exp(-s^2) / sqrt(pi)),  s = r / (sqrt(2) sigma).
///
/// Points should be no farther apart than sigma / 2. Immutable, may be evaluated from several
/// threads.
class SmoothedWindingNumber {
 public:
  /// points, normals: n x 3, n > 0, normals of unit length; areas: n; sigma > 0. All finite.
  SmoothedWindingNumber(const MatX3& points, const MatX3& normals, const VecX& areas, double sigma);

  double operator()(const Vec3& query) const;

 private:
  MatX3 points_, vector_areas_;
  double sigma_;
  PointTree near_;
  WindingNumber sharp_;
};

}  // namespace littoral
