#pragma once
// Level sets of distance on a surface, and what is made of them: offset, opened and closed curves.

#include <vector>

#include "api/space/isosurfaces.h"
#include "api/surface/surface_domain.h"
#include "contour/isolines.h"

namespace littoral {

/// The lines of one level.
struct LevelLines {
  double level = 0;
  std::vector<Polyline> lines;
};

/// Lines of a field on a surface at each level. Levels that no face meets are warnings; throws
/// InputError if none is met.
std::vector<LevelLines> level_lines(const SurfaceMesh& mesh, const VecX& values,
                                    const std::vector<double>& levels, Report& report, Task task);

/// Offsets of the region on the negative side of (broken) curves, at the given distances [length]:
/// lines of their signed distance by a solver prepared for the mesh. Opening and closing first
/// (signed-heat-method, section 9.3.1), each by measuring the distance anew from the line of the
/// first offset.
std::vector<LevelLines> offset_lines(const Solver<SurfaceDomain>& solver, const SurfaceMesh& mesh,
                                     const Sources& sources, const std::vector<double>& offsets,
                                     const Morphology& morphology, Report& report, Task task);

/// All lines as polylines over shared points, with the scalar "level".
PolygonSoup join_lines(const SurfaceMesh& mesh, const std::vector<LevelLines>& levels);

}  // namespace littoral
