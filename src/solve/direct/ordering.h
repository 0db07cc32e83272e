#pragma once
// Orders of elimination that keep factors sparse.

#include <vector>

#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// order[k]: the unknown that is eliminated k-th.
using Ordering = std::vector<int>;

/// Nested dissection of the graph of a symmetric matrix given by its lower triangle. The same
/// pattern always gets the same order, on any number of threads and in every build.
/// Throws Cancelled within 0.1 s of a request.
template <class Scalar>
Ordering dissection(const Eigen::SparseMatrix<Scalar>& lower, const Task& task);

/// The order of unknowns that lie between nodes, from an order of the nodes: each goes when the
/// first of its nodes goes. A separator of the nodes makes one of the unknowns: those with both
/// nodes in it. nodes: unknowns x 2.
Ordering between_nodes(const Ordering& nodes_order, const Eigen::Ref<const Rows<int, 2>>& nodes);

/// Every unknown of `order` as `block` unknowns in a row.
Ordering in_blocks(const Ordering& order, int block);

extern template Ordering dissection(const SpMat&, const Task&);
extern template Ordering dissection(const SpMatC&, const Task&);

}  // namespace littoral
