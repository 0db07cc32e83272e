#pragma once
// Chains of faces, as a person wrote them, as dual chains.

#include "littoral/sources.h"
#include "methods/winding/dual_winding.h"

namespace littoral {

/// Adds every step of the chains to the curve. triangle_of_face: faces of the mesh -> faces of J,
/// or -1. Throws InputError where consecutive faces are not neighbours, naming chain and faces.
void add_chains(const std::vector<FaceChain>& chains, const JumpCalculus& J,
                const std::vector<int>& triangle_of_face, DualCurve& curve);

}  // namespace littoral
