#pragma once
// The sum at the heart of convolve.h, at several places at once.

#include <array>
#include <cstdint>
#include <vector>

#include "methods/heat/yukawa_tree.h"

namespace littoral {

/// What a sum needs beside the samples.
struct YukawaScale {
  float inverse;    // 1 / sqrt(t) [1 / length]
  float decay;      // that for powers of two instead of e
  float reach;      // samples that far beyond the nearest one count [length]
  float least;      // added to squared distances: the kernel is singular at a sample
  float tolerance;  // of what a cluster gives, by its moments instead of its samples; 0: never so
};

/// Places near one another, and what is found there. d: to the nearest sample.
struct YukawaGroup {
  static constexpr int lanes = 8;
  alignas(32) float x[lanes], y[lanes], z[lanes];  // relative to the tree's origin
  alignas(32) float distance[lanes];               // d [length]
  // sum w n and sum w for w = A exp((d - r) / sqrt(t)) / r
  alignas(32) float nx[lanes], ny[lanes], nz[lanes], total[lanes];
};

/// A cluster that matters to some of a block of groups.
struct YukawaPart {
  int cluster;
  // By group: -1 beyond reach, else whether its moments do; without them sample by sample.
  std::array<std::int32_t, YukawaGroup::lanes> moments;
};

/// Fills the second half of n groups, `most_groups` at most, to single precision and the tolerance.
/// The nearer the groups are to one another, the quicker and the better moments do. The same bits
/// on every processor.
using YukawaSum = void(const YukawaTree&, const YukawaScale&, YukawaGroup* groups, int n,
                       std::vector<YukawaPart>& room);
inline constexpr int most_groups = YukawaGroup::lanes;

/// The fastest such function for the processor that runs the program.
YukawaSum* yukawa_sum();

}  // namespace littoral
