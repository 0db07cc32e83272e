#pragma once
// Chains of faces, as a person wrote them, as dual chains.

#include "littoral/sources.h"
#include "methods/winding/dual_winding.h"

namespace littoral {

/// Adds every step of the chains to the curve. triangle_of_face: faces of the mesh -> faces of J,
/// or -1. Throws InputError naming chain and faces: for fewer than two, for one that is not there,
/// and where consecutive ones are not neighbours.
void add_chains(const std::vector<FaceChain>& chains, const JumpCalculus& J,
                const FaceTriangles& triangle_of_face, DualCurve& curve);

}  // namespace littoral
