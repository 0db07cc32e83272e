#pragma once
// What of a surface lies in tets.

#include <array>
#include <vector>

#include "domain/tet/tet_lattice.h"
#include "domain/tet/tet_sight.h"

namespace littoral {

/// What of a triangle lies in a tet: a polygon.
std::vector<Vec3> part_in_tet(const TetMesh& mesh, int t, const std::array<Vec3, 3>& triangle);

/// Triangles, each in one tet.
struct SurfaceInTets {
  MatX3 points{0, 3};
  MatX3i faces{0, 3};
  std::vector<int> tet{};  // of the faces
};

/// The surface cut by the tets, from those that hold its samples across faces as far as it goes.
SurfaceInTets surface_in_tets(const TetMesh& mesh, const TetSight& sight, const MatX3& points,
                              const MatX3i& faces, const MatX3& samples,
                              const std::vector<TetPoint>& places);

}  // namespace littoral
