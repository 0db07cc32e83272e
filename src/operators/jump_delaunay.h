#pragma once
// Functions that jump across a curve, on better triangles of the same surface.

#include <memory>

#include "base/task.h"
#include "littoral/report.h"
#include "operators/jump_calculus.h"

namespace littoral {

/// The intrinsic Delaunay triangulation that keeps the edges of a curve, with where things of the
/// triangulation it was made from are on it. Between the edges of the curve a function has one
/// value at a vertex, whatever the triangles, so a corner stands for all corners between the same
/// two edges.
struct DelaunayJumps {
  struct Corner {
    int face = -1, k = 0;
  };
  std::shared_ptr<const JumpCalculus> J;
  std::vector<int> edge;             // edges before -> edge here, -1 where it may have been flipped
  std::vector<std::int8_t> along;    // edges before: +1 if what is on their left still is, or -1
  std::vector<Corner> before, here;  // nodes before: two corners between the same two edges there

  /// A jump across the curve, here. edges.
  VecX jump(const VecX& before) const;
};

/// Flips edges where `curve` (edges) is 0. No vertices are added; the report counts the flips.
DelaunayJumps delaunay_jumps(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                             const JumpCalculus& J, const VecX& curve, const Task& task,
                             Report& report);

}  // namespace littoral
