#pragma once
// Small random domains of the kinds that break things.

#include "choices.h"
#include "littoral/polygon_soup.h"
#include "littoral/sources.h"
#include "littoral/tet_mesh.h"
#include "littoral/tet_sources.h"

namespace littoral::fuzz {

/// Triangles: grids, books, soups, closed shapes, fans of needles; some with faces doubled, flipped
/// or degenerate, vertices in no face, or a second component smaller by up to 1e-5. 1 to 60 faces.
PolygonSoup random_triangles(Choices& choose);
/// Quads, pentagons and triangles that share vertices; not flat.
PolygonSoup random_polygons(Choices& choose);
/// Points on a sphere, a plane or anywhere, some repeated, with or without normals.
PolygonSoup random_cloud(Choices& choose);
/// A box of tets, moved about, some flat or inverted, some with a second component.
TetMesh random_tets(Choices& choose);

/// Points and curves on a surface: at vertices, on edges, in faces; closed, open, signed or not;
/// seldom none, out of range or not finite.
Sources random_sources(Choices& choose, const PolygonSoup& soup, int n_edges);
TetSources random_tet_sources(Choices& choose, const TetMesh& mesh);

}  // namespace littoral::fuzz
