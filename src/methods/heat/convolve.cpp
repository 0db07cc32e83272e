#include "methods/heat/convolve.h"

#include <cmath>

#include "base/stable_length.h"

namespace littoral {

namespace {
constexpr double reach = 8;         // in sqrt(t) beyond the nearest sample
constexpr double cancelled = 1e-5;  // of the sum of the kernels' sizes
}  // namespace

Convolution::Convolution(const OrientedPoints& source, double root_t)
    : nearest_(source.points),
      blocks_(source.points, source.normals, source.areas),
      root_t_(root_t),
      sum_(yukawa_sum()) {}

Flow Convolution::operator()(const Vec3& x) const {
  using Lanes = Eigen::Map<const PointBlocks<float>::Lanes>;
  const double d0 = std::sqrt(nearest_.nearest(x).squared_distance);
  const Eigen::Vector3f q = (x - blocks_.origin()).cast<float>();
  // At a sample itself the kernel is singular; there, its normal wins.
  const auto least = static_cast<float>(1e-4 * root_t_);
  const YukawaPlace place{
      q[0], q[1], q[2], static_cast<float>(d0), static_cast<float>(1 / root_t_), least * least};
  YukawaSums sums;
  // A_i G_t, scaled by e^(d0/sqrt(t))
  blocks_.visit(x, d0 + reach * root_t_,
                [&](const PointBlocks<float>::Block& b) { sum_(b, place, sums); });
  const Vec3 X(Lanes(sums.x).sum(), Lanes(sums.y).sum(), Lanes(sums.z).sum());
  const double size = stable_length(X);
  Flow flow;
  flow.distance = d0;
  // What is left of a sum that cancels is rounding.
  if (size > cancelled * Lanes(sums.total).sum()) flow.direction = X / size;
  return flow;
}

}  // namespace littoral
