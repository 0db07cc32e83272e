#pragma once
// Distances to eight boxes and sixteen points at once, for point_tree.h, by the widest instructions
// the processor has. Which ones changes nothing in the results.

namespace littoral {

constexpr int point_lanes = 8, leaf_lanes = 16;

/// What holds the points of eight children: tight boxes, and disks (short cylinders) along the
/// planes that their points lie near. From far away boxes that stand askew seem nearer than any
/// point in them, disks do not. Empty lanes have infinite boxes.
struct PointNode {
  alignas(64) double low[3][point_lanes], high[3][point_lanes];
  double centre[3][point_lanes], axis[3][point_lanes];  // axis of unit length
  double radius[point_lanes], half[point_lanes];        // across the axis, along it
  int child[point_lanes];  // another node, or -1 - (number of the leaf)
};

/// Sixteen points by coordinate, infinite beyond `size`.
struct PointLeaf {
  alignas(64) double x[3][leaf_lanes];
  int point[leaf_lanes];
  int size;
};

struct PointKernels {
  /// Squared distances that no point of a child is nearer than.
  void (*node)(const PointNode&, const double* q, double* squared);
  /// Squared distances of the points; bits of those that are at most `bound`.
  unsigned (*leaf)(const PointLeaf&, const double* q, double bound, double* squared);
};

/// The fastest ones for the processor that runs the program.
const PointKernels& point_kernels();

}  // namespace littoral
