#pragma once
// Triangles for the level set in one grid cell.

#include <array>
#include <vector>

#include "contour/cell_topology.h"
#include "littoral/types.h"

namespace littoral::cell {

/// A piece of surface: corners 0..11 are the crossings of the cell's edges, from 12 on `inner`.
struct Patch {
  std::vector<Vec3> inner;                    // points inside the cell, in cell coordinates 0..1
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from larger values
  void clear() {
    inner.clear();
    triangles.clear();
  }
};

/// What is known of a cell.
struct Cell {
  std::array<double, 8> value;    // minus the level
  unsigned positive = 0;          // bit c: corner c is above the level
  std::array<Vec3, 12> crossing;  // of the crossed edges, in cell coordinates
  Vec3 spacing = Vec3::Ones();    // [length]
  bool trilinear = true;          // false: points inside are not moved onto the level set
};

/// Spans each chain of crossings by a disc, or two of them by a tube, so that edges inside the cell
/// never lie on its faces, where a neighbour might draw the same one. Discs are triangulated with
/// the shortest diagonals; where none are allowed, around a point inside.
void span_cell(const Cell& cell, Patch& patch);

}  // namespace littoral::cell
