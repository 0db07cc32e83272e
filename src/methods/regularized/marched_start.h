#pragma once
// Where alternating directions may start from: a distance and what is transported along it.

#include <optional>

#include "base/task.h"
#include "littoral/types.h"
#include "solve/direct/sparse_rows.h"
#include "solve/optimization/admm.h"
#include "sources/surface/known_distances.h"

namespace littoral {

/// What a first-order march over triangles finds.
struct MarchedStart {
  VecX u;     // nodes; +inf where nothing is reached
  VecX flux;  // 2 cells; along the gradient of u, about as much as meets D flux = b
};

/// Marches from what is known over the cells (Kimmel and Sethian 1998, without unfolding), each
/// node from the cell or the side by which the front comes first. Then what each node gives, b, is
/// sent back through those, down to where distances are known, and spread over the cells around.
/// G: 2 cells x nodes, gradients of linear functions; A: cells. Nothing if cells are no triangles.
/// Throws Cancelled.
std::optional<MarchedStart> marched_start(const SpRows& G, const VecX& A, const VecX& b,
                                          const KnownDistances& known, const Task& task);

/// Lets a problem start from what is transported in its first cells (2 numbers each): up to alpha
/// it is alpha times the gradient, whose length is 1 beyond. The multiplier is all of it, or where
/// the quadratic part stands apart what that leaves. The gradients of the cells after those are
/// their bounds.
void start_from(const VecX& flux, double alpha, bool quadratic_apart, const VecX& bound,
                SplitProblem& problem);

}  // namespace littoral
