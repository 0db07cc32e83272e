#pragma once
// Loops over the nodes of trees on several threads.

#include <functional>
#include <vector>

namespace littoral {

/// Which end of a forest a `parallel_forest` starts from.
enum class Walk { from_leaves, from_roots };

/// Calls body(i) for every node of a forest given by parents (-1: a root; parent[i] > i), each node
/// after its children (from_leaves) or after its parent (from_roots); nodes that do not wait for
/// each other may run at the same time. An exception is rethrown here.
/// Nested calls run in the caller.
void parallel_forest(const std::vector<int>& parent, Walk walk,
                     const std::function<void(int node)>& body);

}  // namespace littoral
