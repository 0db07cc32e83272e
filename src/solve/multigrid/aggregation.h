#pragma once
// How smoothed aggregation multigrid goes from unknowns to fewer.

#include "solve/direct/sparse_rows.h"

namespace littoral {

/// Piecewise constant functions on groups of strongly coupled unknowns (-A_ij > strength
/// sqrt(A_ii A_jj)), smoothed by a step of damped Jacobi on the strong couplings: unknowns x
/// groups. Rows of unknowns that are coupled to nothing are empty.
SpRows smoothed_aggregation(const SpRows& A, double strength, const Task& task);

}  // namespace littoral
