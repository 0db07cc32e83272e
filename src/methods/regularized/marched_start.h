#pragma once
// Where alternating directions may start from: a distance and what is transported along it.

#include <optional>

#include "base/task.h"
#include "littoral/types.h"
#include "solve/direct/sparse_rows.h"
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

}  // namespace littoral
