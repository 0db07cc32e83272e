#pragma once
// Which way round the faces of a triangle mesh lie, so that neighbours agree wherever they can.

#include <cstdint>
#include <vector>

#include "domain/mesh/surface_mesh.h"

namespace littoral {

struct FaceOrientation {
  std::vector<std::int8_t> sign;  // faces: 1 as given, -1 the other way round
  int flipped = 0;                // faces of sign -1
  bool orientable = true;         // false: a patch cannot agree and is left as given
};

/// Within every patch of faces joined by edges of two, the majority of area keeps its own
/// orientation and the others follow. Faces that repeat a vertex join nothing and keep theirs.
/// Found by the first call for a mesh and kept as long as the mesh.
const FaceOrientation& face_orientation(const SurfaceMesh& mesh);

}  // namespace littoral
