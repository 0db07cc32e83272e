#pragma once
// Signed heat where it settles how broken curves close: near them.

#include <optional>

#include "base/task.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "domain/mesh/surface_mesh.h"
#include "sources/surface/pieces.h"

namespace littoral {

/// A function whose zero set completes the signed curves (`sided`: nothing else) as that of signed
/// heat on the whole triangle mesh T does, solved on the faces around them: beside curves as far as
/// heat carries directions, around their ends a multiple of the gaps. Beyond it has the sign that
/// the band has at its border; +inf on components without curves (vertices).
///
/// None where the band would not be much smaller than the mesh or diffusion would need another
/// time: where a zero set goes far from the curves, as where most of them is missing or one closes
/// nowhere, the band is widened until then.
std::optional<VecX> signed_heat_near(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                     const PlacedSources& sided, Task task);

}  // namespace littoral
