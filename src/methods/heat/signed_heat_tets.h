#pragma once
// The signed heat method on tet meshes (section 8.1, Appendix B).

#include "base/report.h"
#include "base/task.h"
#include "methods/heat/signed_heat_grid.h"
#include "operators/tet_operators.h"
#include "sources/tet_source_terms.h"

namespace littoral {

/// Generalized signed distance at the vertices [length], +inf on components that no source reaches.
/// h [length] sets the diffusion time t = time_scale h^2 and the scale of `soft`; `tolerance`
/// [length] is how far from zero the rows of a held zero set may be in the mean.
VecX signed_heat_tets(const TetOperators& ops, const TetSourceTerms& terms, double h,
                      double tolerance, const SpaceHeatOptions& options, Task task, Report& report);

/// Distance without sign, from vertices (the rows of terms.A), by the diffusion of a scalar (Crane
/// et al. 2013): t = 4 time_scale h^2. Otherwise as above.
VecX unsigned_heat_tets(const TetOperators& ops, const TetSourceTerms& terms, double h,
                        double tolerance, const SpaceHeatOptions& options, Task task,
                        Report& report);

}  // namespace littoral
