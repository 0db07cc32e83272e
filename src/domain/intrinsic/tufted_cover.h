#pragma once
// Triangles in any arrangement as an edge-manifold surface: the tufted cover.

#include <array>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// The tufted cover of triangles (Sharp and Crane, "A Laplacian for nonmanifold triangle meshes",
/// 2020, section 3.1): a front and a back for each, glued at every edge in the order in which they
/// are met around it, so that every side of a face has exactly one neighbour. Half the cotan
/// Laplacian of the cover is that of the triangles; after `flip_to_delaunay` it has no negative
/// weight. Vertices are shared by all the sheets, so no function has to be carried over.
class TuftedCover {
 public:
  /// points: vertices x 3, of any unit; triangles: rows of three different vertices. Faces without
  /// area get their sides, and thereby all sides, lengthened by 1e-10 of their longest.
  TuftedCover(const MatX3& points, const MatX3i& triangles);

  /// Flips edges until the two angles opposite each sum to at most 180 degrees; at most 50 flips an
  /// edge, and none that would make an edge from a vertex to itself. Returns the number of flips.
  long long flip_to_delaunay(const Task& task);

  struct Face {
    std::array<int, 3> v;          // corners
    std::array<double, 3> length;  // of side k, from corner k to k + 1
    std::array<int, 3> twin;       // 3 times the face on the other side of side k, plus its side
  };
  const std::vector<Face>& faces() const { return faces_; }

  /// Sum of the cotangents opposite side 3 f + k.
  double delaunay_sum(int side) const;

 private:
  void glue(const MatX3& points, const MatX3i& triangles);
  bool flip(int side);
  std::vector<Face> faces_;
};

}  // namespace littoral
