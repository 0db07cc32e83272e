#pragma once
// A sampled level set before its short edges are removed; what marching cubes and tetrahedra make.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/task.h"
#include "littoral/error.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/types.h"

namespace littoral {

struct RoughSurface {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::int64_t> node;  // the node (or vertex) that a point is close to, or -1
  std::vector<Vec3>
      separated_points;  // the same points, no closer than 1/1000 of an edge to a node
};

inline constexpr double close_to_node = 0.05, apart_from_node = 1e-3;  // of an edge

inline void check_count(std::size_t count) {
  if (count > std::numeric_limits<int>::max() / 3)
    throw InputError("isosurface: the level set has too many triangles", "too-large");
}

/// A point that belongs to no edge.
inline void add_point(RoughSurface& rough, const Vec3& p) {
  rough.points.push_back(p);
  rough.separated_points.push_back(p);
  rough.node.push_back(-1);
}

/// Crossing number c, at fraction t of an edge whose nearer end is `node`; `at` gives positions.
template <class At>
void place_crossing(RoughSurface& rough, std::size_t c, double t, std::int64_t node, const At& at) {
  rough.points[c] = at(t);
  rough.separated_points[c] = at(std::min(1 - apart_from_node, std::max(apart_from_node, t)));
  rough.node[c] = std::min(t, 1 - t) <= close_to_node ? node : -1;
}

/// Merges points close to the same node along edges of the mesh, where the mesh stays manifold;
/// points that remain together at one node are moved apart. Components that have collapsed to a
/// point are dropped.
PolygonSoup merge_close_points(RoughSurface rough, const Task& task);

/// Counts the edges with one face and warns of them: the level set has met the boundary.
void report_boundary(const PolygonSoup& surface, double level, Report& report);

}  // namespace littoral
