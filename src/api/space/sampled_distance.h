#pragma once
// A volume of signed distance as a field that can be asked anywhere.

#include "littoral/volume.h"
#include "methods/implicit/pointwise.h"

namespace littoral {

/// Trilinear between nodes. Outside the box, with c the nearest point of the box and v the value
/// there: sqrt(v^2 + |x - c|^2) for v > 0, which is no more than the distance to a shape that lies
/// within the box, otherwise v + |x - c|, so that a shape that reaches the box ends near it.
class SampledDistance final : public PointwiseDistance {
 public:
  /// Throws InputError for a grid of fewer than two nodes along an axis, a wrong number of values
  /// or a value that is not finite, naming the node.
  explicit SampledDistance(Volume field);
  DistanceSample at(const Vec3& x) const override;

 private:
  Volume field_;
};

}  // namespace littoral
