#pragma once
// Whole numbers as the key of an unordered map.

#include <array>
#include <cstddef>
#include <cstdint>

namespace littoral {

struct NumbersHash {
  template <class Integer, std::size_t n>
  std::size_t operator()(const std::array<Integer, n>& numbers) const {
    std::uint64_t h = 0;
    for (const Integer k : numbers) {
      h = (h ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    return std::size_t(h);
  }
};

}  // namespace littoral
