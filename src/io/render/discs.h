#pragma once
// Point clouds as discs.

#include "io/render/scene.h"

namespace littoral::io {

/// Lets pages and pictures show the vertices of a scene as discs instead of its triangles, which
/// join the points of a cloud to their neighbours: normals are those of the triangles about a
/// point, radii those with which discs cover these triangles, up to twice the middle distance to
/// the points it is joined to. Points of no triangle have the middle radius, and face the way of
/// the first view.
void show_as_discs(Scene& scene);

inline constexpr int disc_corners = 12;

/// The discs of a scene as triangles: corners one disc after the other, on which the field goes on
/// as steeply as it is about the point.
Scene discs_as_triangles(const Scene& scene);

}  // namespace littoral::io
