#pragma once
// Walls about what a surface, made of an input, leaves out of it: sheets and thin parts.

#include <vector>

#include "base/task.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/volume.h"

namespace littoral {

/// Whether the distance, interpolated, is negative at x, or where the grid is nearest to it. Sheets
/// have a positive distance on both sides.
bool is_inside(const Volume& distance, const Vec3& x);

/// All points nearer to a piece than its radius.
struct Walls {
  PolygonSoup pieces;        // triangles, no side longer than a spacing of the grid
  VecX radii;                // pieces: [length], at most half the thickness asked for
  std::vector<char> wholly;  // triangles of the input: nothing of them is no wall
  int triangles = 0;         // of the input that became walls, in part at least
  double share = 0;          // of the input's area
};

/// Walls of the triangles' sheets and thin parts: pieces with the outside less than about a spacing
/// away on both sides, going by `distance`. Those that are neighbours become walls together or not
/// at all. They do where they are wider than two walls are thick -- less would be no wall but a
/// lump in a dent -- and the surface is torn there: it misses one of them by nearly a spacing; next
/// to holes of the input, where it has dents, by two, or a seventh of their area by more than `far`
/// [length]. And they do where one sticks out of the surface by more than the thickness and two
/// spacings. The two sides of a part, or of a gap, as thin as that make one wall of the thickness
/// asked for [length]; where that is less than two spacings, of two where the sides add up to it.
Walls walls_of(const PolygonSoup& triangles, const PolygonSoup& surface, const Volume& distance,
               double far, double thickness, Task task);

/// The same of all the triangles.
Walls walls_of_all(const PolygonSoup& triangles, const Grid& grid, double thickness, Task task);

/// Distance to the walls' surface at the nodes, negative within them, and that surface, whose
/// vertices lie on it exactly: what a contour of the distance is fitted to.
struct WallDistance {
  VecX at_nodes;
  PolygonSoup surface;
};
WallDistance wall_distance(const Walls& walls, const Grid& grid, Task task);

}  // namespace littoral
