#pragma once
// One vertex for corners at one place, where a format gives every corner its own.

#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/index.h"
#include "base/numbers_hash.h"
#include "littoral/types.h"

namespace littoral::io {

/// Numbers points by position; the first corner at a position decides its vertex number.
class PointMerger {
 public:
  /// Points of different `tag` stay apart.
  int vertex(double x, double y, double z, std::uint64_t tag = 0) {
    // -0 and 0 are the same place.
    const std::array<std::uint64_t, 4> key{bits(x), bits(y), bits(z), tag};
    const auto [entry, is_new] = numbers_.try_emplace(key, static_cast<int>(numbers_.size()));
    if (is_new) coordinates_.insert(coordinates_.end(), {x, y, z});
    return entry->second;
  }
  MatX3 points() const {
    return Eigen::Map<const MatX3>(coordinates_.data(), index(coordinates_.size() / 3), 3);
  }

 private:
  static std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x); }
  std::unordered_map<std::array<std::uint64_t, 4>, int, NumbersHash> numbers_;
  std::vector<double> coordinates_;
};

}  // namespace littoral::io
