#pragma once
// An order of points in which neighbours in a row are neighbours in space.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "littoral/base/types.h"

namespace littoral {

/// The points' numbers along a Morton curve through their box, 2^16 steps along each axis; equal
/// places in ascending order. points: n x 3, finite. Time O(n log n).
inline std::vector<int> morton_order(const MatX3& points) {
  std::vector<std::pair<std::uint64_t, int>> keys;
  std::vector<int> order;
  if (points.rows() == 0) return order;
  const Vec3 low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const double size = (high - low).maxCoeff();
  const double scale = 65535 / size;
  keys.reserve(static_cast<std::size_t>(points.rows()));
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    std::uint64_t key = 0;
    for (int a = 0; a < 3; ++a) {
      const double step = (points(i, a) - low[a]) * scale;
      // Anything where the box has no size, or one beyond all numbers.
      std::uint64_t bits = step >= 0 && step < 65536 ? static_cast<std::uint64_t>(step) : 0;
      // Two blanks before each bit.
      bits = (bits | bits << 16) & 0x0000ff0000ff;
      bits = (bits | bits << 8) & 0x00f00f00f00f;
      bits = (bits | bits << 4) & 0x0c30c30c30c3;
      bits = (bits | bits << 2) & 0x249249249249;
      key |= bits << a;
    }
    keys.emplace_back(key, static_cast<int>(i));
  }
  std::sort(keys.begin(), keys.end());
  order.reserve(keys.size());
  for (const auto& [key, point] : keys) order.push_back(point);
  return order;
}

}  // namespace littoral
