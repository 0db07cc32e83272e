#pragma once
// The reduced-size integration of thesis 6.3: curves are completed by shortest paths first, and the
// residual function may jump across these and nowhere else.

#include <vector>

#include "methods/winding/residual.h"

namespace littoral {

/// Shortest paths along edges from ends of a chain (edges) to its starts, nearest pairs first; ends
/// on the boundary of the surface are left alone. 1 for every edge of a path. edges.
std::vector<char> completing_paths(const JumpCalculus& J, const VecX& curve, const Task& task);

/// A residual function whose jumps minimise sum_e weight_e |jump_e| among those that differ by one
/// constant per part of the surface between the completed curves. In each part gamma is integrated
/// from face to face outward from the curves, so that where it cannot be the jumps are far from
/// them.
ResidualFunction integrate_between_paths(const JumpCalculus& J, const VecX& gamma,
                                         const VecX& curve, const VecX& weight,
                                         const std::vector<char>& take, const Task& task,
                                         Report& report);

}  // namespace littoral
