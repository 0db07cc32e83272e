#pragma once
// Which connected part of a surface in space its samples belong to.

#include <vector>

#include "littoral/polygon_soup.h"
#include "sources/space/oriented_points.h"

namespace littoral {

/// The part of each face, counted from 0 in the order of their first faces. Faces that have a
/// corner at the same place are connected.
std::vector<int> parts_of_faces(const PolygonSoup& surface);

/// The part of each sample, counted from 0. Faces that have a corner at the same place are
/// connected; a cloud is one part.
std::vector<int> parts_of_samples(const PolygonSoup& surface, const OrientedPoints& samples);

}  // namespace littoral
