#pragma once
// One vertex for vertices that are close together.

#include "littoral/polygon_soup.h"

namespace littoral {

/// A soup of fewer vertices, and what became of the others.
struct Welded {
  PolygonSoup soup;
  int n_merged = 0;         // vertices that became one with an earlier one
  int n_dropped_faces = 0;  // with fewer than three corners left
};

/// In their order, vertices no farther than `distance` from the nearest of those kept before become
/// that one, others are kept; 0 joins those at one place. Corners that follow each other and became
/// one count once; normals and scalars are those of the kept. Vertices that are not finite stay.
Welded weld(const PolygonSoup& soup, double distance);

}  // namespace littoral
