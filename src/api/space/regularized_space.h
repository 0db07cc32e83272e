#pragma once
// Regularized distance in space: through tets and on grids (Edelstein et al. 2023, section 7.4).

#include "api/space/space_domain.h"
#include "base/task.h"
#include "littoral/report.h"
#include "methods/regularized/regularized.h"

namespace littoral {

/// Distance to the rows (rows x nodes) at which it vanishes, at the nodes, not negative; +inf where
/// no row is, and listed. With `sign` (1 or -1 at the nodes) the same with that sign, which passes
/// through zero between nodes. Dirichlet energy of linear
/// functions, whatever else the options say.
VecX regularized_in_space(const Calculus& C, const SpMat& rows, const Regularized& options,
                          const Task& task, Report& report, const VecX* sign = nullptr);

}  // namespace littoral
