#pragma once
// Which triangle sides lie on an edge: how anything that crosses edges finds its way.

#include "base/groups.h"
#include "domain/intrinsic/intrinsic_triangulation.h"

namespace littoral {

/// Side k of a triangle, in one number.
class TriangleSide {
 public:
  TriangleSide() = default;
  TriangleSide(int face, int k) : side_(3 * face + k) {}
  int face() const { return side_ / 3; }
  int k() const { return side_ % 3; }
  bool operator==(const TriangleSide&) const = default;

 private:
  int side_ = 0;
};

/// Triangle sides at each edge, by triangle; any number of them.
using EdgeSides = Groups<TriangleSide>;

EdgeSides edge_sides(const IntrinsicTriangulation& T);

}  // namespace littoral
