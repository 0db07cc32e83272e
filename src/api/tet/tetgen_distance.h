#pragma once
// Signed heat on tets whose faces follow the input, made by another program.

#include "api/space/sdf.h"

namespace littoral {

struct TetgenOptions {
  std::string program = "tetgen";  // a path, or a name in PATH
  double timeout = 600;            // seconds by the clock
};

/// Like `tet_distance`, on tets that the program tetgen fills the grid's box with: the triangles of
/// the input are faces of tets, whose sides grow from one grid spacing next to the input to eight
/// at the box. Constraint zero-set where none is given.
///
/// Throws UnsupportedError for clouds, other methods, and where the program is not installed;
/// InputError if the box does not hold the whole input; SolveError if the program fails, crashes,
/// hangs or answers nonsense, which it does for surfaces that cross themselves; otherwise as
/// tet_distance.
TetField tetgen_distance(const PolygonSoup& input, const Grid& grid, const SpaceRequest& request,
                         const TetgenOptions& options, VecX* on_grid, Task task, Report& report);

}  // namespace littoral
