#pragma once
// What signed heat does about curves without inside and outside (section 7.2; thesis 6.4.1).

#include "api/surface/surface_domain.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/heat/signed_heat.h"
#include "sources/surface/pieces.h"

namespace littoral {

/// Distance that jumps: the mean of the values that meet at each vertex, and the surface split
/// where they differ. Constraint zero-set holds the value at the sources by a large penalty, `soft`
/// gives another, both on absolute values. The report gets the length along which it is split and
/// the certified gap.
SurfaceAnswer discontinuous_distance(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                     const Operators& ops, const PlacedSources& placed,
                                     const SourceSystem& terms, const SignedHeatSolver& method,
                                     const SignedHeat& options, Task& task, Report& report);

/// The sources without the parts of signed curves that bound nothing. Throws InputError if nothing
/// remains.
Sources without_nonbounding(const SurfaceDomain& domain, const Sources& sources, const Task& task,
                            Report& report);

}  // namespace littoral
