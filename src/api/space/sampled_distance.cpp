#include "api/space/sampled_distance.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/index.h"
#include "base/stable_length.h"
#include "littoral/error.h"

namespace littoral {

SampledDistance::SampledDistance(Volume field) : field_(std::move(field)) {
  const Grid& grid = field_.grid;
  for (int n : grid.n)
    if (n < 2) throw InputError("a volume needs two nodes along each axis at least");
  if (std::size_t(field_.values.size()) != grid.n_nodes())
    throw InputError("the volume has " + std::to_string(field_.values.size()) + " values for " +
                         std::to_string(grid.n_nodes()) + " nodes",
                     "sizes-differ");
  if (!grid.origin.allFinite() || !grid.spacing.allFinite() || !(grid.spacing.minCoeff() > 0))
    throw InputError("the volume's box must be finite and its spacings positive", "option-value");
  for (Eigen::Index v = 0; v < field_.values.size(); ++v)
    if (!std::isfinite(field_.values[v]))
      throw InputError("the value of node " + std::to_string(v) + " is not finite", "not-finite");
}

DistanceSample SampledDistance::at(const Vec3& x) const {
  const Grid& grid = field_.grid;
  std::array<int, 3> cell;
  Vec3 inside, t;
  for (int a = 0; a < 3; ++a) {
    const double at = (x[a] - grid.origin[a]) / grid.spacing[a];
    const double kept = std::clamp(at, 0.0, grid.n[a] - 1.0);
    cell[a] = std::min(static_cast<int>(kept), grid.n[a] - 2);
    t[a] = kept - cell[a];
    inside[a] = at == kept ? x[a] : grid.origin[a] + grid.spacing[a] * kept;
  }
  DistanceSample sample;
  for (int c = 0; c < 8; ++c) {
    const int corner[3] = {c & 1, c >> 1 & 1, c >> 2};
    double w[3], sign[3];
    for (int a = 0; a < 3; ++a) {
      w[a] = corner[a] ? t[a] : 1 - t[a];
      sign[a] = (corner[a] ? 1 : -1) / grid.spacing[a];
    }
    const double value = field_.values[index(
        grid.node(cell[0] + corner[0], cell[1] + corner[1], cell[2] + corner[2]))];
    sample.value += w[0] * w[1] * w[2] * value;
    sample.gradient +=
        value * Vec3(sign[0] * w[1] * w[2], w[0] * sign[1] * w[2], w[0] * w[1] * sign[2]);
  }
  const Vec3 beyond = x - inside;
  const double distance = stable_length(beyond);
  if (!(distance > 0)) return sample;
  for (int a = 0; a < 3; ++a)
    if (beyond[a] != 0) sample.gradient[a] = 0;  // the nearest point of the box stays
  const Vec3 outward = beyond / distance;
  if (!(sample.value > 0)) return {sample.value + distance, sample.gradient + outward};
  const double value = std::hypot(sample.value, distance);
  return {value, (sample.value * sample.gradient + distance * outward) / value};
}

}  // namespace littoral
