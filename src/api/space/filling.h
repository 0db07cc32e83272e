#pragma once
// Tets that fill the box of a grid.

#include "api/space/space_domain.h"
#include "littoral/tet_mesh.h"

namespace littoral {

/// Tets in the frame of the input and the grid; the box of a lattice is the cube on the grid's
/// longest side. Reports their number. Throws as `heat_filling_method`.
TetMesh filled(const SpaceInput& input, const Grid& grid, const TetFilling& filling, Task task,
               Report& report);

}  // namespace littoral
