#pragma once
// What kernels of windows do with lanes.

#include <cmath>
#include <cstdint>

#include "base/vector_lanes.h"

namespace littoral {

#define LITTORAL_INLINE [[gnu::always_inline]] inline

template <class V>
LITTORAL_INLINE void take_root(V& v) {
  for (int l = 0; l < int(sizeof v / sizeof(double)); ++l) v[l] = std::sqrt(v[l]);
}

/// Lane by lane: by words, as in vector_lanes.h, exact search takes some 3 % longer.
template <int width, class B>
LITTORAL_INLINE bool any(const B& b) {
  std::int64_t bits = 0;
  for (int l = 0; l < width; ++l) bits |= b[l];
  return bits != 0;
}

/// Leaves out lanes beyond the windows that are left.
template <class B>
LITTORAL_INLINE void keep_first(B& b, std::int64_t left) {
  for (int l = 0; l < int(sizeof b / sizeof(std::int64_t)); ++l)
    if (l >= left) b[l] = 0;
}

}  // namespace littoral
