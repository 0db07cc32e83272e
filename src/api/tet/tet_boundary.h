#pragma once
// Surfaces of tets with the fields there: the boundary, whole or cut open.

#include "io/tet/tets.h"
#include "littoral/polygon_soup.h"

namespace littoral {

/// Triangles over some of the points.
PolygonSoup triangles_of(const io::TetFile& file, const MatX3i& triangles);

PolygonSoup boundary_of(const io::TetFile& file);

/// What is left of the boundary on the far side of a plane across an axis, seen along that, and the
/// section of the tets there. Throws InputError if the plane misses the tets.
PolygonSoup cut_open(const io::TetFile& file, int axis, double position);

/// What pictures show: the boundary, cut open in the middle where its field has one value all over,
/// as distance from it has, or one sign where the tets inside have both.
PolygonSoup drawn_surface(const io::TetFile& file);

/// Writes tets with their only field by extension: all of it, a table of its values, or the
/// boundary with it. Throws UnsupportedError for other extensions, IoError.
void write_tet_values(const std::filesystem::path& path, const io::TetFile& file);

}  // namespace littoral
