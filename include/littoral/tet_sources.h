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
  /// What distance is counted from, as for `Sources` [length]: nothing; one number; or one for each
  /// vertex and then the boundary, for each face of the surface or for each point of the cloud.
  std::vector<double> values{};
};

}  // namespace littoral
