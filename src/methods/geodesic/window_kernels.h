#pragma once
// What is asked of all windows of an edge, for several at once.

#include <cstddef>

#include "methods/geodesic/window_block.h"

namespace littoral {

struct WindowKernels {
  /// Whether all windows of a block, which is not empty, are open, came through one triangle, and
  /// the ends of the edge reach nothing of them sooner.
  bool (*all_whole)(const WindowBlock& windows, const EdgeEnds& ends);
  /// The least distance of windows first, ..., last - 1.
  double (*least)(const WindowBlock& windows, std::size_t first, std::size_t last);
};

/// For any processor.
extern const WindowKernels plain_window_kernels;
/// The fastest ones for the processor that runs the program: the same bits.
const WindowKernels& window_kernels();

}  // namespace littoral
