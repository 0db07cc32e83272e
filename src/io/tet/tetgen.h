#pragma once
// Tets made by the program tetgen, where it is installed (Si, "TetGen, a Delaunay-based quality
// tetrahedral mesh generator", 2015; AGPL, so never linked).

#include <string>

#include "base/task.h"
#include "littoral/polygon_soup.h"
#include "littoral/tet_mesh.h"

namespace littoral::io {

struct TetgenRequest {
  Vec3 low, high;                  // the box to fill [length]
  double fine = 0, coarse = 0;     // sides of tets next to the surface and at the box [length]
  std::string program = "tetgen";  // a path, or a name in PATH
  double timeout = 600;            // seconds by the clock
};

/// Tets that fill the box, with the triangles of the surface among their faces. The surface must
/// lie within the box, off its sides.
///
/// The program runs as a process of its own: whatever it does ends in an error here. Throws
/// UnsupportedError if it is not installed, SolveError if it fails, crashes, does not end in time
/// or answers nonsense (surfaces that cross themselves are beyond it), IoError if there is no room
/// for its files, Cancelled.
TetMesh run_tetgen(const PolygonSoup& surface, const TetgenRequest& request, const Task& task);

}  // namespace littoral::io
