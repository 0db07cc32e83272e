#include "littoral/methods/convolve.h"

#include <cmath>

namespace littoral {

namespace {
constexpr double reach = 12;        // in sqrt(t) beyond the nearest sample
constexpr double cancelled = 1e-5;  // of the sum of the kernels' sizes
}  // namespace

Convolution::Convolution(const OrientedPoints& source, double root_t)
    : nearest_(source.points),
      blocks_(source.points, source.normals, source.areas),
      root_t_(root_t) {}

Flow Convolution::operator()(const Vec3& x) const {
  using Lanes = PointBlocks<float>::Lanes;
  const double d0 = std::sqrt(nearest_.nearest(x).squared_distance);
  const Eigen::Vector3f q = (x - blocks_.origin()).cast<float>();
  const auto shift = static_cast<float>(d0), inverse = static_cast<float>(1 / root_t_);
  // At a sample itself the kernel is singular; there, its normal wins.
  const auto least = static_cast<float>(1e-4 * root_t_);
  Lanes sx = Lanes::Zero(), sy = Lanes::Zero(), sz = Lanes::Zero(), total = Lanes::Zero();
  blocks_.visit(x, d0 + reach * root_t_, [&](const PointBlocks<float>::Block& b) {
    const Lanes dx = b.x - q[0], dy = b.y - q[1], dz = b.z - q[2];
    const Lanes r = (dx * dx + dy * dy + dz * dz).sqrt().max(least);
    const Lanes w =
        b.area * ((shift - r) * inverse).exp() / r;  // A_i G_t, scaled by e^(d0/sqrt(t))
    total += w;
    sx += w * b.nx;
    sy += w * b.ny;
    sz += w * b.nz;
  });
  const Vec3 X(sx.sum(), sy.sum(), sz.sum());
  const double size = X.stableNorm();
  Flow flow;
  flow.distance = d0;
  // What is left of a sum that cancels is rounding.
  if (size > cancelled * total.sum()) flow.direction = X / size;
  return flow;
}

}  // namespace littoral
