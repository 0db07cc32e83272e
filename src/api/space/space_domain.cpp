#include "api/space/space_domain.h"

#include <utility>

#include "spatial/grid_values.h"

namespace littoral {

namespace {

class Placed final : public PointwiseDistance {
 public:
  Placed(std::unique_ptr<const PointwiseDistance> distance, const Frame& frame)
      : distance_(std::move(distance)), frame_(frame) {}
  DistanceSample at(const Vec3& x) const override {
    const DistanceSample sample = distance_->at(frame_.local(x));
    return {sample.value * frame_.unit, sample.gradient};
  }
  double value(const Vec3& x) const override {
    return distance_->value(frame_.local(x)) * frame_.unit;
  }

 private:
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
  return grid_values(grid, task,
                     [&](const Vec3& x, int& last) { return distance.value_after(x, last); });
}

}  // namespace littoral
