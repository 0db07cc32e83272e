#include "api/space/space_domain.h"

#include <utility>

namespace littoral {

namespace {

/// In the units of the input, and without -0 for points on the surface that count as inside.
class Placed final : public PointwiseDistance {
 public:
  Placed(std::unique_ptr<const PointwiseDistance> distance, const Frame& frame)
      : distance_(std::move(distance)), frame_(frame) {}
  DistanceSample at(const Vec3& x) const override {
    const DistanceSample sample = distance_->at(frame_.local(x));
    return {length(sample.value), sample.gradient};
  }
  double value(const Vec3& x) const override { return length(distance_->value(frame_.local(x))); }
  double value_after(const Vec3& x, int& last) const override {
    return length(distance_->value_after(frame_.local(x), last));
  }
  VecX on_grid(const Grid& grid, const Task& task) const override {
    VecX values = distance_->on_grid(frame_.local(grid), task);
    values = values.array() * frame_.unit + 0.0;
    return values;
  }

 private:
  double length(double local) const { return local * frame_.unit + 0.0; }

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
