#include "api/space/space_domain.h"

#include <utility>

namespace littoral {

namespace {

/// In the units of the input, and without -0 for points on the surface that count as inside. From
/// `far` units away the input is a point, which keeps sums and squares of methods finite.
class Placed final : public PointwiseDistance {
 public:
  Placed(std::unique_ptr<const PointwiseDistance> distance, const Frame& frame)
      : distance_(std::move(distance)), frame_(frame) {}
  DistanceSample at(const Vec3& x) const override {
    if (is_far(x)) return from_far(x);
    const DistanceSample sample = distance_->at(frame_.local(x));
    return {length(sample.value), sample.gradient};
  }
  double value(const Vec3& x) const override {
    return is_far(x) ? from_far(x).value : length(distance_->value(frame_.local(x)));
  }
  double value_after(const Vec3& x, int& last) const override {
    return is_far(x) ? from_far(x).value : length(distance_->value_after(frame_.local(x), last));
  }
  VecX on_grid(const Grid& grid, const Task& task) const override {
    if (is_far(grid.origin) || is_far(grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1)))
      return PointwiseDistance::on_grid(grid, task);
    VecX values = distance_->on_grid(frame_.local(grid), task);
    values = values.array() * frame_.unit + 0.0;
    return values;
  }

 private:
  static constexpr double far = 1e13, less_far = 1e6;

  double length(double local) const { return local * frame_.unit + 0.0; }
  bool is_far(const Vec3& x) const {
    return (x - frame_.centre).cwiseAbs().maxCoeff() > far * frame_.unit;
  }
  /// With the side that the method sees on the way there.
  DistanceSample from_far(const Vec3& x) const {
    const Vec3 away = x - frame_.centre;
    const double distance = away.stableNorm();
    const Vec3 direction = away / distance;
    const double sign = distance_->value(less_far * direction) < 0 ? -1 : 1;
    return {sign * distance, sign * direction};
  }

  std::unique_ptr<const PointwiseDistance> distance_;
  Frame frame_;
};

}  // namespace

std::string SpaceDomain::kind() const {
  if (!grid) return "set of points";
  if (!tets) return "grid";
  return tets->by == TetFilling::By::lattice ? "tet lattice" : "tetgen mesh";
}

std::shared_ptr<const PointwiseDistance> placed(std::unique_ptr<const PointwiseDistance> distance,
                                                const Frame& frame) {
  return std::make_shared<const Placed>(std::move(distance), frame);
}

VecX evaluate(const PointwiseDistance& distance, const Grid& grid, const Task& task) {
  return distance.on_grid(grid, task);
}

}  // namespace littoral
