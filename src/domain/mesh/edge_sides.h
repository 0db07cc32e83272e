#pragma once
// Which triangle sides lie on an edge: how anything that crosses edges finds its way.

#include "base/groups.h"
#include "domain/intrinsic/intrinsic_triangulation.h"

namespace littoral {

/// Side k of a triangle.
struct TriangleSide {
  int face, k;
};

/// Triangle sides at each edge, by triangle; any number of them.
using EdgeSides = Groups<TriangleSide>;

EdgeSides edge_sides(const IntrinsicTriangulation& T);

}  // namespace littoral
