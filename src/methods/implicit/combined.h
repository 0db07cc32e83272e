#pragma once
// Fields made of fields: union, intersection, difference and offset of the shapes that they bound
// (thesis, section 5.2, figures 5.7 and 5.8).

#include <memory>
#include <span>
#include <vector>

#include "methods/implicit/pointwise.h"

namespace littoral {

/// What becomes of a shape beside the first.
enum class Boolean { unite, intersect, subtract };

/// ((first + all that are united) within all that are intersected) without all that are subtracted,
/// whatever their order.
struct Csg {
  std::vector<Boolean> operations;  // of each field after the first
  double blend = 0;   // [length] where surfaces meet, corners are rounded this far from them
  double offset = 0;  // [length] the surface is moved this far outward
};

/// The smaller of two, rounded where they differ by less than `blend` >= 0: at most blend / 4 less
/// than the smaller. Its gradient is a mean of the two gradients, so it is never steeper.
DistanceSample smooth_min(const DistanceSample& a, const DistanceSample& b, double blend);

/// The combined field at one place, from all fields there: smallest and largest values. It has the
/// right sign and zero set. Its magnitude is a distance only where the nearest point of one of the
/// surfaces remains on the result; elsewhere it is a bound: no farther than the nearest point of
/// the result, for exact fields. Not more than one field per entry of `csg.operations`, and one.
DistanceSample combine(const Csg& csg, std::span<const DistanceSample> fields);

/// Several fields as one. Throws InputError for no fields, a number of fields that does not fit, or
/// radii that are not finite or negative.
class Combined final : public PointwiseDistance {
 public:
  Combined(std::vector<std::shared_ptr<const PointwiseDistance>> fields, Csg csg);
  DistanceSample at(const Vec3& x) const override;
  double value(const Vec3& x) const override;

 private:
  std::vector<std::shared_ptr<const PointwiseDistance>> fields_;
  Csg csg_;
};

/// Throws InputError unless blend is finite and not negative and offset finite.
void check_combination(const Csg& csg, std::size_t fields);

}  // namespace littoral
