#pragma once
// Sources as points of quadratic elements.

#include <vector>

#include "littoral/operators/p2.h"
#include "littoral/sources/pieces.h"

namespace littoral {

/// A point at which the distance is 0, with every element that contains it.
template <int D>
struct P2Source {
  std::vector<P2Point<D>> where;
  bool on_curve = false;
};

/// Points of a triangle mesh as they are; curves as samples.
///
/// `spacing` > 0 samples every curve at that distance (in mean edge lengths), ends included,
/// independent of the triangulation (quadratic-order geodesics, section 6.4); 0 puts three points
/// on every straight piece, which holds a quadratic at 0 all along it. Throws InputError if no
/// source lies on a face with three different vertices.
std::vector<P2Source<2>> p2_sources(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                    const PreparedSources& sources, double spacing);

}  // namespace littoral
