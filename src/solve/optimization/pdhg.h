#pragma once
// The primal-dual hybrid gradient method (Chambolle, Pock 2011) for the problems of admm.h:
// products only, nothing is factored.

#include "solve/optimization/admm.h"

namespace littoral {

/// Minimises -b^T u + sum_c A_c phi(c, (G u)_c) from u0 on; `problem` needs no solve and has no
/// quadratic part. M (unknowns, positive where b or G is not zero): masses of the unknowns. Of the
/// options counts what names tolerances and iterations.
AdmmResult pdhg(const SplitProblem& problem, const VecX& M, const VecX& u0,
                const AdmmOptions& options, const Task& task);

}  // namespace littoral
