#pragma once
// What distance through tets is measured from.

#include <vector>

#include "littoral/polygon_soup.h"

namespace littoral {

/// What distance through tets is measured from: a surface or cloud in space (faces of tets, or
/// anything else within them), or vertices, or those of the boundary.
struct TetSources {
  PolygonSoup surface{};
  std::vector<int> vertices{};
  bool boundary = false;
  bool flip = false;              // reverse all normals: the other side is positive
  bool estimate_normals = false;  // of a cloud, instead of those it has
};

}  // namespace littoral
