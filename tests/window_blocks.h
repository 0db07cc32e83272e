#pragma once
// Memory for windows that tests make.

#include "methods/geodesic/window_memory.h"

namespace littoral {

inline WindowMemory& test_memory() {
  static WindowMemory memory;
  return memory;
}

inline SpareBlocks& test_blocks() {
  static SpareBlocks blocks(test_memory());
  return blocks;
}

}  // namespace littoral
