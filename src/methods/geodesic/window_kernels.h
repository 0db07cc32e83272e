#pragma once
// What is asked of all windows of an edge, for several at once.

#include <cstddef>
#include <cstdint>

#include "methods/geodesic/window_block.h"

namespace littoral {

/// When neighbours on an edge become one.
struct Joining {
  double widest_gap;  // between them
  double tolerance;   // share of the least distance that a distance may change by,
  double error;       // less this
};

struct WindowKernels {
  /// Whether all windows of a block, which is not empty, are open, came through one triangle, and
  /// the ends of the edge reach nothing of them sooner.
  bool (*all_whole)(const WindowBlock& windows, const EdgeEnds& ends);
  /// The least distance of windows first, ..., last - 1.
  double (*least)(const WindowBlock& windows, std::size_t first, std::size_t last);
  /// Bit k, of up to 64: whether window first + k and the next one can become one
  /// (`one_of` in merge_windows.h).
  std::uint64_t (*pairs)(const WindowBlock& windows, std::size_t first, const Joining& how);
};

/// For any processor.
extern const WindowKernels plain_window_kernels;
/// The fastest ones for the processor that runs the program: the same bits.
const WindowKernels& window_kernels();

}  // namespace littoral
