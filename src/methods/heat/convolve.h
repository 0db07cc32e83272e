#pragma once
// Step I of the signed heat method in free space: normals convolved with the Yukawa kernel.

#include <memory>

#include "littoral/types.h"
#include "methods/heat/yukawa_sum.h"
#include "sources/space/oriented_points.h"
#include "spatial/point_blocks.h"
#include "spatial/point_tree.h"

namespace littoral {

/// What the diffused normals say at one place.
struct Flow {
  Vec3 direction = Vec3::Zero();  // unit; zero where the sum cancels
  double distance = 0;            // to the nearest sample [length]
};

/// X_t(x) = sum_i A_i N_i G_t(x, p_i), G_t(x, y) = exp(-|x - y| / sqrt(t)) / (4 pi t |x - y|), the
/// kernel of id - t Delta in space (section 8.2; it is positive, see the errata).
///
/// Only the direction is wanted, so exponents are shifted by the distance d0 to the nearest sample:
/// nothing ever underflows, however far away. Samples beyond d0 + 8 sqrt(t) are left out; they
/// turn the direction by 2e-4 on average (7e-4 at most was seen on a broken chair). Immutable, may
/// be evaluated from several threads.
class Convolution {
 public:
  /// root_t: sqrt(t) [length], > 0.
  Convolution(const OrientedPoints& source, double root_t);

  Flow operator()(const Vec3& x) const;

 private:
  PointTree nearest_;
  PointBlocks<float> blocks_;
  double root_t_;
  YukawaSum* sum_;
};

}  // namespace littoral
