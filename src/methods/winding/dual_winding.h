#pragma once
// Winding numbers with one value per face (thesis 6.4): curves are chains of dual edges, which say
// across which pairs of faces the function jumps. So they have sides where edges have none: on
// surfaces that cannot be oriented, and where three or more faces meet.

#include <vector>

#include "methods/winding/surface_winding.h"

namespace littoral {

/// A dual 1-chain.
struct DualCurve {
  VecX edge;                    // edges of two faces, left minus right
  std::vector<FacePair> pairs;  // all pairs at edges of three or more faces
};

/// The five steps on dual elements: u solves d * d u = d * c and has one value per face. What
/// bounds nothing is found from the harmonic part of du - c; where there are `pairs` it is kept,
/// with a warning. Jumps between pairs are not in the edge vectors of the result. Throws
/// SolveError, Cancelled.
WindingNumbers dual_winding(const JumpCalculus& J, const DualCurve& curve,
                            const SurfaceWinding& options, Task task, Report& report);

}  // namespace littoral
