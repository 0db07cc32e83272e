#pragma once
// Polygons cut into triangles.

#include "littoral/polygon_soup.h"

namespace littoral {

/// The soup with every polygon cut into triangles on its own corners, with its orientation; n
/// corners give n - 2 triangles. Points, lines, normals and scalars stay as they are.
///
/// Ears are clipped in the plane of the polygon's vector area; where none is left (the polygon
/// crosses itself or has no area), or clipping would take seconds, the rest becomes a fan. Faces of
/// fewer than three corners are dropped. Never fails.
PolygonSoup triangulate(const PolygonSoup& soup);

/// The corners of a soup of triangles alone: faces x 3.
MatX3i triangles_of(const PolygonSoup& soup);

/// The soup of triangles.
PolygonSoup soup_of(const MatX3& points, const MatX3i& triangles);

/// Two surfaces as one mesh of triangles: those of `first`, whose polygons are cut, stand before
/// those of `second`, which has triangles only.
struct JoinedTriangles {
  MatX3 points;
  MatX3i triangles;
  Eigen::Index n_first;  // triangles of the first
};
JoinedTriangles join_triangles(const PolygonSoup& first, const PolygonSoup& second);

}  // namespace littoral
