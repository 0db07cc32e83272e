#pragma once
// Distances that are known beside the sources, before anything is solved for.

#include <map>
#include <span>
#include <vector>

#include "domain/mesh/nodal_surface.h"
#include "sources/surface/triangle_sources.h"

namespace littoral {

/// Node -> a distance that is not exceeded there, 0 at a source [units]. A function of gradient at
/// most 1 that is as large as these allow is the distance to the source on both of its sides, which
/// one that has to vanish along a curve through its cells cannot be.
using KnownDistances = std::map<int, double>;

/// The same with a place in a triangle for each node.
struct NodeDistance {
  int node, triangle;
  Vec3 b;
  double distance;
};

/// Corners, or corners and middles of sides: node n_vertices + e of edge e.
enum class TriangleNodes { corners, corners_and_middles };

/// The nodes of the triangles that hold segments, or an end of one on a side, ascending, with the
/// distance to the nearest segment in a triangle that they share with it: the distance itself for
/// straight curves.
std::vector<NodeDistance> distances_around(const IntrinsicTriangulation& T,
                                           std::span<const TriangleSources::Segment> segments,
                                           TriangleNodes nodes);

/// What is known around curves and points. At sources from node to node it is 0 there and nothing
/// else, as the gradients say the rest.
KnownDistances known_distances(const IntrinsicTriangulation& T, const TriangleSources& sources,
                               TriangleNodes nodes);

/// The same at the nodes of the polygons and triangles that hold a source, through space.
KnownDistances known_distances(const NodalSurface& S, const TriangleSources& sources);

}  // namespace littoral
