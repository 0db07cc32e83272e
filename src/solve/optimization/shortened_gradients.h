#pragma once
// Gradients that are too long in a few cells, shortened by moving the unknowns around them.

#include <optional>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"
#include "solve/direct/sparse_rows.h"

namespace littoral {

/// Gradients G u, `dim` numbers a cell, of weight A; D = G^T A names the cells of each unknown.
struct CellGradients {
  const SpRows& G;
  const SpRows& D;
  const VecX& A;
  int dim;
};

/// u, moved a little near the cells whose gradient is longer than `longest`, so that none there is
/// or, where that cannot be, that the longest is shorter; unknowns marked as `fixed` stay. Nothing
/// where there is no such cell, where they are too many, and where nothing helps. g = G u.
std::optional<VecX> with_shortened_gradients(const CellGradients& cells, const VecX& u,
                                             const VecX& g, const std::vector<char>& fixed,
                                             double longest, const Task& task);

}  // namespace littoral
