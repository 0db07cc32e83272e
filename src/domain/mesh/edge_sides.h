#pragma once
// Which triangle sides lie on an edge: how anything that crosses edges finds its way.

#include <span>
#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"

namespace littoral {

/// Side k of a triangle.
struct TriangleSide {
  int face, k;
};

/// Triangle sides at each edge, by triangle; any number of them.
struct EdgeSides {
  std::vector<int> offsets;         // edges + 1
  std::vector<TriangleSide> sides;  // 3 triangles
  std::span<const TriangleSide> at(int e) const {
    return {sides.data() + offsets[e], sides.data() + offsets[e + 1]};
  }
};

EdgeSides edge_sides(const IntrinsicTriangulation& T);

}  // namespace littoral
