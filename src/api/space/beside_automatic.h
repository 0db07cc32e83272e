#pragma once
// How far a named method is from the automatic one: what it says about itself without a known
// truth.

#include <vector>

#include "api/space/sdf.h"

namespace littoral {

/// Where to compare: at most 512 nodes of a grid, spread whatever its size along the axes.
std::vector<Eigen::Index> compared_nodes(const Grid& grid);

/// Their places.
MatX3 positions(const Grid& grid, const std::vector<Eigen::Index>& nodes);

/// Compares values at nodes of a grid [length] with method auto, and warns where sides or distances
/// differ more than they do where a method is right. Of meshes of at most 200,000 faces; not of
/// clouds, of method auto itself, and where that method has no answer.
void check_beside_automatic(const PolygonSoup& input, const Grid& grid,
                            const std::vector<Eigen::Index>& nodes, const VecX& values,
                            const SpaceRequest& request, Task task, Report& report);

/// Whether there is something to compare with.
bool has_automatic(const PolygonSoup& input, const SpaceRequest& request);

}  // namespace littoral
