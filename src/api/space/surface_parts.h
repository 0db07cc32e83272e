#pragma once
// The connected parts of a closed surface.

#include <vector>

#include "api/space/frame.h"
#include "littoral/polygon_soup.h"
#include "littoral/types.h"

namespace littoral {

/// Parts of a surface of triangles, joined by shared vertices; vertices without a face are in none.
struct SurfaceParts {
  std::vector<int> of_face;
  std::vector<Box> boxes;
  std::vector<double> volumes;  // where they are closed; negative: turned inward
};

SurfaceParts parts_of(const PolygonSoup& surface);

/// The faces of the parts that stay, with their vertices alone, in the same order.
PolygonSoup with_parts(const PolygonSoup& surface, const SurfaceParts& parts,
                       const std::vector<char>& stays);

}  // namespace littoral
