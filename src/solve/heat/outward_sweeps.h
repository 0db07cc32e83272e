#pragma once
// (M + t L) X = B for small t without a factor: relaxation outward from B.

#include <optional>

#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// Solves A X = B, A positive definite and given by its lower triangle, row by row in the order in
/// which heat comes to them, over and over, until every row is met to round-off of its own terms:
/// entries far from B, however small, are as exact as those next to it. Few sweeps do where A^-1
/// decays within a few rows, as each carries what goes outward all the way. Nothing where that is
/// not so. The same bits for any number of threads.
std::optional<MatX3> solve_by_outward_sweeps(const SpMat& lower, const MatX3& B, const Task& task);

}  // namespace littoral
