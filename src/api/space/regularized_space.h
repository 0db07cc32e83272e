#pragma once
// Regularized distance in space: through tets and on grids (Edelstein et al. 2023, section 7.4).

#include "api/space/space_method.h"
#include "base/report.h"
#include "base/task.h"
#include "methods/regularized/regularized.h"

namespace littoral {

/// Distance to the rows (rows x nodes) at which it vanishes, at the nodes, not negative; +inf where
/// no row is, and listed. With `sign` (1 or -1 at the nodes) the same with that sign, which passes
/// through zero between nodes. Dirichlet energy only: throws UnsupportedError for other options.
VecX regularized_in_space(const Calculus& C, const SpMat& rows, const RegularizedOptions& options,
                          const Task& task, Report& report, const VecX* sign = nullptr);

/// `regularized` and `belyaev-fayolle` as methods on grids, with the sign of the winding number.
std::vector<SpaceMethod> regularized_space_methods();

}  // namespace littoral
