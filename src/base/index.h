#pragma once
// Sizes as signed integers, for arithmetic and comparisons with them (a subscript needs neither),
// and infinity.

#include <Eigen/Core>
#include <limits>

namespace littoral {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr Eigen::Index index(auto n) { return static_cast<Eigen::Index>(n); }

int int_size(const auto& container) { return static_cast<int>(container.size()); }

}  // namespace littoral
