#pragma once
// Quadratic-order distance through tets.

#include <vector>

#include "littoral/api/surface_method.h"
#include "littoral/domain/tet_mesh.h"
#include "littoral/methods/quadratic.h"
#include "littoral/operators/tet_operators.h"

namespace littoral {

/// The options, checked for what tets have.
QuadraticOptions tet_quadratic_options(const OptionTexts& texts);

/// Unsigned distance at the vertices of the mesh, in its coordinates; +inf where no source reaches.
/// Sources are vertices, or a surface: the nodes of the tets that hold it (`held`) know their
/// distance to it. Throws UnsupportedError for surfaces without faces.
VecX quadratic_through_tets(const TetMesh& mesh, const TetOperators& ops,
                            const std::vector<int>& vertices, const PolygonSoup& surface,
                            const std::vector<int>& held, const QuadraticOptions& options,
                            const Task& task, Report& report);

}  // namespace littoral
