#pragma once
// Piecewise quadratic functions on a tet mesh.

#include "littoral/tet_mesh.h"
#include "operators/p2.h"
#include "operators/tet_operators.h"

namespace littoral {

/// The elements of a tet mesh, those of no volume left out, in its own coordinates (unit 1).
struct P2Tets {
  P2Elements<3> elements;
  std::vector<int> element_of_tet;  // -1 where it has no volume
};

/// `ops` are the operators of the same mesh, from which volumes, gradients and components come.
P2Tets p2_elements(const TetMesh& mesh, const TetOperators& ops);

}  // namespace littoral
