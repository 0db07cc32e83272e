#include "spatial/morton_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace littoral {

namespace {

/// The lowest 20 bits with two zeros between each and the next.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

using Key = std::pair<std::uint64_t, int>;

/// By key, ties as they are: digit by digit, the last first.
void sort_keys(std::vector<Key>& keys) {
  constexpr int bits = 12, digits = 5, values = 1 << bits;
  if (keys.size() < values) {
    std::sort(keys.begin(), keys.end());
    return;
  }
  std::vector<Key> sorted(keys.size());
  for (int d = 0; d < digits; ++d) {
    const auto digit = [d](const Key& k) { return k.first >> (d * bits) & (values - 1); };
    std::array<std::size_t, values> place{};
    for (const Key& k : keys) ++place[digit(k)];
    std::size_t before = 0;
    for (std::size_t& p : place) before += std::exchange(p, before);
    for (const Key& k : keys) sorted[place[digit(k)]++] = k;
    keys.swap(sorted);
  }
}

}  // namespace

std::vector<int> morton_order(const MatX3& points) {
  const std::size_t n = points.rows();
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  if (n == 0 || !points.allFinite()) return order;
  const Eigen::RowVector3d low = points.colwise().minCoeff();
  const double side = (points.colwise().maxCoeff() - low).maxCoeff();
  const double cells = ((1 << 20) - 1) / side;
  if (!(side < 1e300) || !std::isfinite(cells)) return order;
  std::vector<Key> keys(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::uint64_t key = 0;
    for (int d = 0; d < 3; ++d) {
      const double cell = (points(i, d) - low[d]) * cells;
      key |= spread_bits(static_cast<std::uint64_t>(std::clamp(cell, 0.0, 1048575.0))) << d;
    }
    keys[i] = {key, static_cast<int>(i)};
  }
  sort_keys(keys);
  std::transform(keys.begin(), keys.end(), order.begin(), [](const auto& k) { return k.second; });
  return order;
}

}  // namespace littoral
