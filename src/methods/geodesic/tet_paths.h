#pragma once
// Shortest ways through tets: straight where these allow, bent at their boundary otherwise.

#include <functional>
#include <vector>

#include "base/task.h"
#include "domain/tet/tet_sight.h"

namespace littoral {

/// What distance is measured from: triangles, each in a connected component of the mesh. A point is
/// a triangle whose corners are one.
struct TetPathSources {
  MatX3 points{0, 3};
  MatX3i faces{0, 3};
  std::vector<int> component{};  // of the faces
  bool of_mesh = false;          // the corners of faces are vertices of the tets
};

struct TetPathResult {
  VecX distance;  // vertices, +inf where no source reaches
  VecX side;      // vertices: what `side` said of the source's end of the way
  int bent = 0;   // vertices whose way is not straight
};

/// The side of a source's face on which x lies, straight from its point q: 1, -1, or 0 for unknown.
using SideOf = std::function<double(int face, const Vec3& q, const Vec3& x)>;

/// Exact at vertices that see the nearest point of the sources of their component; elsewhere the
/// length of a way that stays in the tets, never shorter than the shortest (within the slack of
/// TetSight). Such ways turn at edges where the boundary is reentrant. Those of neighbours are led
/// on in the order of their lengths and pulled taut, so that a way is the shortest among those
/// near it; one that goes round something on the other side may be shorter. Each boundary point
/// sees the nearest one of the boundary, so that `all_seen` spares the test. component: vertices,
/// -1 in no tet.
TetPathResult tet_paths(const TetMesh& mesh, const TetSight& sight,
                        const std::vector<int>& component, const TetPathSources& sources,
                        bool all_seen, const SideOf& side, Task task);

}  // namespace littoral
