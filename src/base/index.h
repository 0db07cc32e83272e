#pragma once
// Sizes as signed integers, for arithmetic and comparisons with them. A subscript needs neither.

#include <Eigen/Core>

namespace littoral {

constexpr Eigen::Index index(auto n) { return static_cast<Eigen::Index>(n); }

int int_size(const auto& container) { return static_cast<int>(container.size()); }

}  // namespace littoral
