#pragma once
// The sum at the heart of convolve.h, over a block of samples at once.

#include "spatial/point_blocks.h"

namespace littoral {

/// Where the sum is taken, and its scale.
struct YukawaPlace {
  float x, y, z;  // relative to the blocks' origin
  float shift;    // d0 [length]
  float inverse;  // 1 / sqrt(t)
  float least;    // squared distances are at least this: the kernel is singular at a sample
};

/// sum w n and sum w for w = A exp((d0 - r) / sqrt(t)) / r, lane by lane.
struct YukawaSums {
  alignas(64) float x[16] = {}, y[16] = {}, z[16] = {}, total[16] = {};
};

/// Adds a block to the sums, to single precision. The same bits on every processor.
using YukawaSum = void(const PointBlocks<float>::Block&, const YukawaPlace&, YukawaSums&);

/// The fastest such function for the processor that runs the program.
YukawaSum* yukawa_sum();

}  // namespace littoral
