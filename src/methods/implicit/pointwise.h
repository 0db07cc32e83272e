#pragma once
// Signed distance at single places in space, without solving anything.

#include <memory>

#include "base/task.h"
#include "littoral/types.h"
#include "littoral/volume.h"

namespace littoral {

/// Value and gradient at one place.
struct DistanceSample {
  double value = 0;              // [length], < 0 inside
  Vec3 gradient = Vec3::Zero();  // of the formula where it is smooth; zero where it has none
};

/// A function of space that can be asked anywhere. Immutable; may be asked from several threads.
class PointwiseDistance {
 public:
  virtual ~PointwiseDistance() = default;
  virtual DistanceSample at(const Vec3& x) const = 0;
  /// The value alone, for methods that have it for less.
  virtual double value(const Vec3& x) const { return at(x).value; }
  /// The same for points that follow one another: `last` is -1 for the first, and whatever the
  /// method found for the one before afterwards. It changes the time, not the value.
  virtual double value_after(const Vec3& x, [[maybe_unused]] int& last) const { return value(x); }
  /// The values at all nodes of a grid, for methods that have them for less together.
  virtual VecX on_grid(const Grid& grid, const Task& task) const;
};

/// Values (queries) and, unless null, gradients (queries x 3) at queries x 3 points.
VecX evaluate(const PointwiseDistance& distance, const MatX3& queries, MatX3* gradients,
              const Task& task);

}  // namespace littoral
