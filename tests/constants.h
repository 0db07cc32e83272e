#pragma once
// Numbers that many tests name.

#include <limits>
#include <numbers>

namespace littoral::test {

inline constexpr double pi = std::numbers::pi;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace littoral::test
