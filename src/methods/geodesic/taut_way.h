#pragma once
// The shortest way over given edges.

#include <functional>
#include <vector>

#include "littoral/types.h"

namespace littoral {

/// A point of the edge from vertex a to vertex b; a = b: the vertex.
struct EdgeTurn {
  int a, b;
  double t = 0;  // 0 to 1

  bool at_end() const { return a == b || t <= 0 || t >= 1; }
  int end() const { return t < 1 ? a : b; }
};

Vec3 place_of(const MatX3& points, const EdgeTurn& turn);

/// Moves the turns of a way along their edges to where it is shortest. The way leads from
/// start(first turn), the nearest point of a convex set, over the turns to `end`; its length is a
/// convex function of their places.
void make_taut(const MatX3& points, const std::function<Vec3(const Vec3&)>& start, const Vec3& end,
               std::vector<EdgeTurn>& turns);

}  // namespace littoral
