#pragma once
// Places on the parts of a surface.

#include <vector>

#include "littoral/types.h"
#include "methods/implicit/place_tree.h"

namespace littoral {

/// Places spread evenly over each part: 4096 in all by area, and four on the smallest. areas, part:
/// of the faces, whose parts are numbers; none on parts without area.
std::vector<Place> places_on_parts(const MatX3& points, const MatX3i& faces, const VecX& areas,
                                   const std::vector<int>& part);

}  // namespace littoral
