#include "api/space/volume_info.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace littoral {

std::vector<InfoEntry> volume_info(const Volume& volume) {
  const Grid& grid = volume.grid;
  const Vec3 far = grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  double not_finite = 0, negative = 0;
  for (const double value : volume.values) {
    if (value < 0) ++negative;
    if (!std::isfinite(value)) {
      ++not_finite;
      continue;
    }
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const auto triple = [](const Vec3& v) { return std::vector<double>{v[0], v[1], v[2]}; };
  return {{"field", volume.name},
          {"nodes", static_cast<double>(grid.n_nodes())},
          {"nodes_along_axes",
           std::vector<double>{double(grid.n[0]), double(grid.n[1]), double(grid.n[2])}},
          {"spacing", triple(grid.spacing)},
          {"bounding_box", std::vector<double>{grid.origin[0], grid.origin[1], grid.origin[2],
                                               far[0], far[1], far[2]}},
          {"values", std::vector<double>{low, high}},
          {"values_negative", negative},
          {"values_not_finite", not_finite}};
}

}  // namespace littoral
