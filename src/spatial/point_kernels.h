#pragma once
// Distances to sixteen points at once, for point_tree.h, by the widest instructions the processor
// has. Which ones changes nothing in the results.

namespace littoral {

constexpr int leaf_lanes = 16;

/// Sixteen points by coordinate, infinite beyond `size`.
struct PointLeaf {
  alignas(64) double x[3][leaf_lanes];
  int point[leaf_lanes];
  int size;
};

/// Squared distances of the points; returns the bits of those that are at most `bound`.
using LeafKernel = unsigned(const PointLeaf&, const double* q, double bound, double* squared);

/// The fastest one for the processor that runs the program.
LeafKernel* leaf_kernel();

}  // namespace littoral
