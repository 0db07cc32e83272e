#pragma once
// What signed heat does about curves without inside and outside (section 7.2; thesis 6.4.1).

#include "api/surface/surface_method.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/heat/signed_heat.h"

namespace littoral {

/// Distance that jumps: the mean of the values that meet at each vertex, and the surface torn where
/// they differ. The report gets the length along which it is torn and the certified gap.
SurfaceResult discontinuous_distance(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                     const Operators& ops, const SourceTerms& terms,
                                     const SignedHeat& method, const SignedHeatOptions& options,
                                     Task& task, Report& report);

/// The sources without the parts of signed curves that bound nothing. Throws InputError if nothing
/// remains.
SurfaceSources without_nonbounding(const SurfaceProblem& problem, const Task& task, Report& report);

}  // namespace littoral
