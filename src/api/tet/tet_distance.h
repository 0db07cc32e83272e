#pragma once
// Distance through tets that somebody else made.

#include <vector>

#include "api/space/sdf.h"

namespace littoral {

/// What distance through tets is measured from: a surface or cloud in space (faces of tets, or
/// anything else within them), or vertices, or those of the boundary.
struct TetSources {
  PolygonSoup surface;
  std::vector<int> vertices;
  bool boundary = false;
};

/// Distance at the vertices of the mesh [length]; +inf on components that no source reaches, and at
/// vertices of no tet. Methods: signed-heat, signed from a surface and unsigned from vertices, with
/// the options of `sdf` but constraint zero-set where none is given; regularized and
/// belyaev-fayolle, unsigned from either; quadratic, unsigned from vertices or a surface with
/// faces.
///
/// Flat and inverted tets are harmless; parts of the surface outside the tets are left out, with a
/// warning. Throws InputError for bad input, and if no source lies in a tet, UnsupportedError for
/// other methods and for both kinds of sources together, IoError where memory will not do,
/// Cancelled.
VecX tet_mesh_distance(const TetMesh& mesh, const TetSources& sources, const SpaceRequest& request,
                       Task task, Report& report);

}  // namespace littoral
