#pragma once
// A contour moved onto the surface that it was taken around, with its creases.

#include <vector>

#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// A closed triangle mesh and how far its vertices may go.
struct FittedSurface {
  MatX3 points{0, 3};  // vertices x 3
  MatX3i faces{0, 3};  // triangles x 3
  int n_moved = 0;     // vertices that lie on the target
  int n_kept = 0;      // vertices that are not where they would fit best: it would cross itself
};

/// Moves vertices of faces that cross others towards the middle of their neighbours until none
/// crosses, or twenty times: contours cross themselves where two of their parts run through one
/// cell. points: n x 3, faces: m x 3; which vertices are joined does not change.
void untangle(MatX3& points, const MatX3i& faces, const Task& task);

/// The contour (closed, manifold) with its vertices on the nearest points of the target, where
/// these are within `reach` [length]. Sides between parts of the target whose planes differ by more
/// than 30 degrees are split where these planes meet, so that creases of the target are chains of
/// sides (the extended marching cubes of Kobbelt et al. 2001 with a point a side instead of one a
/// cell). Where that would make the mesh cross itself or fold over, vertices stay where they were:
/// the result is as free of crossings as the contour is. target: points n x 3, triangles m x 3.
FittedSurface fit_to_surface(const MatX3& points, const MatX3i& faces, const MatX3& target_points,
                             const MatX3i& target_faces, double reach, Task task);

}  // namespace littoral
