#pragma once
// Nested dissection of graphs.

#include <vector>

#include "base/task.h"
#include "solve/direct/graph.h"

namespace littoral {

/// An order of elimination, order[k] the vertex that goes k-th: a separator goes last and the parts
/// on its sides before it, both in the same way (George 1973); small parts by minimum degree. Parts
/// are cut side by side; the order is the same for any number of threads. graph: without weights of
/// edges, all vertices of weight 1. Throws Cancelled.
std::vector<int> nested_dissection(const Graph& graph, const Task& task);

}  // namespace littoral
