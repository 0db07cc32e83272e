#pragma once
// Numbers that many tests name.

#include <numbers>

#include "base/index.h"

namespace littoral::test {

inline constexpr double pi = std::numbers::pi;
using littoral::infinity;

}  // namespace littoral::test
