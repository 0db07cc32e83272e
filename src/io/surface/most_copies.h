#pragma once
// Scenes that place one mesh many times.

#include <algorithm>
#include <cstddef>
#include <limits>

namespace littoral::io {

/// As many vertices, or corners, are made of a file by placing its meshes at most: a thousand for
/// each byte, so that a small file cannot fill the memory.
inline std::size_t most_copied(std::size_t bytes) {
  constexpr std::size_t each = 1000, always = 1000000, indexed = std::numeric_limits<int>::max();
  return std::min(indexed, std::max(always, bytes < indexed ? each * bytes : indexed));
}

}  // namespace littoral::io
