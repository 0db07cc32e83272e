#pragma once
// Sources as points of quadratic elements.

#include <vector>

#include "operators/p2.h"
#include "sources/surface/pieces.h"

namespace littoral {

/// A point whose distance is known not to be larger than a number, 0 at a source itself, with every
/// element that contains it.
template <int D>
struct P2Source {
  std::vector<P2Point<D>> where;
  bool on_curve = false;
  double distance = 0;  // units of the elements
};

/// Points of a triangle mesh as they are; curves by the distances around them, or as samples.
///
/// With `spacing` 0, the nodes of every triangle that holds a piece of a curve know their distance
/// to the nearest piece in it: exact for straight curves, and no quadratic is forced to vanish on a
/// bent one. `spacing` > 0 samples every curve at that distance (in mean edge lengths of its
/// component), ends included, independent of the triangulation (quadratic-order geodesics, section
/// 6.4). Points of a triangle that agree to 1e-9 of its size count once. Throws InputError for a
/// spacing between 0 and 0.001, and if no source lies on a face with three different vertices.
std::vector<P2Source<2>> p2_sources(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                    const PlacedSources& sources, double spacing);

}  // namespace littoral
