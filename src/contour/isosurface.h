#pragma once
// Level sets of functions in space, as triangle meshes.

#include <functional>

#include "base/task.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/tet_mesh.h"
#include "littoral/types.h"
#include "littoral/volume.h"

namespace littoral {

struct IsosurfaceOptions {
  /// Where the level set meets the boundary of a grid, close it there: outside counts as above the
  /// level, so the part of the box below it is capped, flat on the box.
  bool close = false;
  /// The function whose samples the values are; may be asked from several threads. With it a
  /// crossing of a grid's edge is where the function takes the level, to 1/1000 of the edge, not
  /// where the line between the two samples does: that is off by cells beside creases.
  std::function<double(const Vec3&)> function = {};
};

/// Marching cubes with the topology of the trilinear interpolant (after Chernyaev 1995, Nielson
/// 2003): saddles on faces and inside cells decide how the crossings of a cell's edges are joined.
///
/// `values` holds a number a node, x fastest. Triangles are counter-clockwise seen from where
/// values are larger, so the part below the level (the inside of a signed distance) is enclosed.
/// The mesh is manifold, has no duplicate vertices or faces, and is closed unless it meets the box
/// and `close` is off; the report then warns and counts "boundary edges". Values equal to the level
/// count as just below it. Crossings closer than 1/20 of a spacing to the same node become one
/// vertex wherever that keeps the mesh manifold, so values at the level make no degenerate
/// triangles. Same bits for any number of threads; stops within 0.2 s.
///
/// Throws InputError for a grid of fewer than two nodes along an axis, spacings that are not
/// positive and finite, a wrong number of values, values that are not finite (naming the node) or a
/// level that is not finite.
PolygonSoup isosurface(const Grid& grid, const VecX& values, double level,
                       const IsosurfaceOptions& options, Report& report, Task task = {});

/// Marching tetrahedra: the level set of a function linear on each tet; `values` by vertex. As
/// above; closed and manifold where the tets fill a region conformingly. Tets may be of either
/// orientation; flat ones are treated as if they were not. Throws InputError for an index out of
/// range, a vertex of a tet that is not finite and for wrong values.
PolygonSoup isosurface(const TetMesh& mesh, const VecX& values, double level, Report& report,
                       Task task = {});

}  // namespace littoral
