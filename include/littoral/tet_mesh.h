#pragma once
// Tetrahedra over points, as a file or a lattice gives them.

#include "littoral/types.h"

namespace littoral {

/// Corners in right-handed order, (b - a) x (c - a) . (d - a) > 0, where somebody has seen to it:
/// readers keep the order of the file.
struct TetMesh {
  MatX3 points{0, 3};       // vertices x 3
  Rows<int, 4> tets{0, 4};  // tets x 4, by vertex

  int n_vertices() const { return static_cast<int>(points.rows()); }
  int n_tets() const { return static_cast<int>(tets.rows()); }
};

}  // namespace littoral
