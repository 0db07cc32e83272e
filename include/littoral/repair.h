#pragma once
// A closed surface made of a broken one.

#include "littoral/context.h"
#include "littoral/mesh.h"
#include "littoral/methods.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/space.h"

namespace littoral {

/// What `repair` makes of an input.
struct RepairOptions {
  GridOptions grid{{}, {}, {}, 0.1};  // that the surface is taken from: 128 nodes along the longest
                                      // side, or up to 256 where parts are thinner than a spacing
  double error = 0;          // > 0: grids from 64 to 512 nodes until no point of the result is
                             // farther than that from the input or what closes it [length]
  double thicken = 0;        // > 0: sheets and thin parts that the surface of the inside leaves
                             // out or tears become walls that thick [length]
  double smallest_part = 0;  // parts whose boxes have shorter diagonals go [length]
  bool cavities = true;      // keep parts that are holes in others
  bool remesh = false;       // also where the input's own triangles will do
  bool fit = true;           // move vertices onto the input, and cut along its creases
};

/// A closed, manifold, consistently oriented triangle mesh, and what was changed.
struct Repaired {
  Mesh surface;
  Report report;  // counts before and after, distances both ways, what was dropped
};

/// The boundary of the inside of a surface, soup or oriented cloud, by any method for distance in
/// space (none: SpaceAutomatic).
///
/// Where orientation, doubled faces and parts within others are all that is wrong, the input's
/// triangles are kept where they are; not with a method, `flip` or `remesh`, nor where `thicken`
/// makes walls. Otherwise the surface is contoured on a grid and fitted to the input, walls to
/// half their thickness from it, where that does not make it cross itself. The result is checked
/// without rounding; where it is not closed, manifold and free of crossings, or misses more than a
/// hundredth of the input's area, the report's status is "uncertain" and says why. A surface
/// without an inside becomes walls, three spacings thick unless `thicken` is given, with a warning.
/// Throws InputError for bad input, for options out of range and for a cloud without an inside;
/// UnsupportedError for `thicken` and `error` of a cloud.
Repaired repair(const PolygonSoup& input, const RepairOptions& options = {},
                const AnyMethod& method = {}, const Orientation& orientation = {},
                const Context& context = {});

}  // namespace littoral
