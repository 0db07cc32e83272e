#pragma once
// Laplacians whose cells have weights of their own.

#include <optional>

#include "base/task.h"
#include "littoral/types.h"
#include "solve/direct/sparse_rows.h"

namespace littoral {

/// Lower triangle of D diag(weight) G with the pattern of L = D G, D = G^T A. weight: cells, each
/// with `dim` rows of G; rows after these are left out. Nothing if L is not D G, as where it has a
/// stabilising term. Throws Cancelled.
std::optional<SpMat> weighted_laplacian(const SpMat& L, const SpRows& D, const SpRows& G,
                                        const VecX& weight, int dim, const Task& task);

}  // namespace littoral
