#pragma once
// Step I of the signed heat method in free space: normals convolved with the Yukawa kernel.

#include "littoral/types.h"
#include "methods/heat/yukawa_sum.h"
#include "operators/grid.h"
#include "sources/space/oriented_points.h"

namespace littoral {

/// X_t(x) = sum_i A_i N_i G_t(x, p_i), G_t(x, y) = exp(-|x - y| / sqrt(t)) / (4 pi t |x - y|), the
/// kernel of id - t Delta in space (section 8.2; it is positive, see the errata).
///
/// Only the direction is wanted, so exponents are shifted by the distance d0 to the nearest sample:
/// nothing ever underflows, however far away. Samples beyond d0 + 8 sqrt(t) are left out; they
/// turn the direction by 2e-4 on average (7e-4 at most was seen on a broken chair). Clusters of
/// samples are summed by their moments to the second order where those do, which turns it by as
/// much (2e-3 at most was seen around a knot). Single precision. Immutable, may be evaluated from
/// several threads.
class Convolution {
 public:
  /// root_t: sqrt(t) [length], > 0. tolerance: of each cluster that is summed by moments, relative
  /// to all; 0 sums sample by sample.
  Convolution(const OrientedPoints& source, double root_t, double tolerance = 2e-3);

  Flow operator()(const Vec3& x) const;
  /// At n places, quicker where they are near each other.
  void operator()(const Vec3* x, int n, Flow* out) const;

 private:
  YukawaTree tree_;
  YukawaScale scale_;
  YukawaSum* sum_;
};

}  // namespace littoral
