#pragma once
// Nodes of trees with eight children: lower bounds of the distances to what is in each of them.

#include <bit>

#include "base/index.h"
#include "littoral/types.h"

namespace littoral {

constexpr int bound_lanes = 8;

/// What holds the points of eight children: tight boxes, and disks (short cylinders) along the
/// planes that their points lie near. From far away boxes that stand askew seem nearer than any
/// point in them, disks do not. Empty lanes have infinite boxes.
struct BoundNode {
  alignas(64) double low[3][bound_lanes], high[3][bound_lanes];
  double centre[3][bound_lanes], axis[3][bound_lanes];  // axis of unit length
  double radius[bound_lanes], half[bound_lanes];        // across the axis, along it
  double slack[bound_lanes];                            // for rounding, see BoundKernel
  int child[bound_lanes];
};

/// Box and disk of the points listed: rows [from, to) of points, at least one, finite. The disk's
/// axis is the direction in which they vary least; many points are seldom flat and get none.
void set_bounds(const MatX3& points, const int* from, const int* to, BoundNode& node, int lane);

/// Nothing is in this lane.
void set_empty(BoundNode& node, int lane);

/// Squared distances that no point of a child is nearer to q than, infinite for empty lanes; less
/// by about 1e-14 of the way to the farthest corner of the box, so that they also hold for points
/// computed with rounding from offsets of that size.
using BoundKernel = void(const BoundNode&, const double* q, double* squared);

/// The fastest one for the processor that runs the program. Which one changes nothing in results.
BoundKernel* bound_kernel();

/// The same in half the memory, for coordinates of at most 1 from the origin.
struct SmallBoundNode {
  alignas(64) float low[3][bound_lanes], high[3][bound_lanes];
  float centre[3][bound_lanes], axis[3][bound_lanes];
  float radius[bound_lanes], half[bound_lanes];
  int child[bound_lanes];
};

/// Rounds to the nearest; the kernels allow for it.
void set_small(const BoundNode& from, SmallBoundNode& to);

/// As BoundKernel, less by about 1e-6 of the distances and of the size of the coordinates, or by
/// 1e-14 of the distances where the query is far away. Returns a bit for each child within `bound`.
using SmallBoundKernel = unsigned(const SmallBoundNode&, const double* q, double bound,
                                  double* squared);

struct SmallBoundKernels {
  SmallBoundKernel *near, *far;  // up to `near_bound_kernel` from the origin, farther
};
constexpr double near_bound_kernel = 32;
const SmallBoundKernels& small_bound_kernels();

/// A child that a search still has to look at.
struct BoundEntry {
  double squared;
  int child;
};

/// Puts the children of a node that are `near`, a bit for each, onto a stack of `top` entries, the
/// nearest on top; returns how many there are then.
inline int push_children(const int* child, const double* squared, unsigned near, BoundEntry* stack,
                         int top) {
  const int first = top;
  for (; near != 0; near &= near - 1) {
    const int c = std::countr_zero(near);
    int place = top++;
    for (; place > first && stack[place - 1].squared < squared[c]; --place)
      stack[place] = stack[place - 1];
    stack[place] = {squared[c], child[c]};
  }
  return top;
}

/// The same for those within `bound`.
inline int push_children(const BoundNode& node, const double* squared, double bound,
                         BoundEntry* stack, int top) {
  unsigned near = 0;
  for (int c = 0; c < bound_lanes; ++c)
    near |= (squared[c] <= bound && squared[c] < infinity ? 1u : 0u) << c;
  return push_children(node.child, squared, near, stack, top);
}

}  // namespace littoral
