#pragma once
// Places in an order in which those near each other mostly stand near each other.

#include <vector>

#include "base/parallel.h"
#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// The rows of points (n x 3) along a Z-shaped (Morton) curve through a lattice of 2^20 cells a
/// side around them; as they are if a number is not finite.
std::vector<int> morton_order(const MatX3& points);

/// visit(i) for some of `all` points, in such an order, on all threads. Throws Cancelled.
template <class Visit>
void visit_in_order(const std::vector<int>& some, std::size_t all, const Task& task,
                    const Visit& visit) {
  parallel_for(some.size(), 1024, [&](std::size_t begin, std::size_t end) {
    task.checkpoint(double(begin) / double(all));
    for (std::size_t at = begin; at < end; ++at) visit(some[at]);
  });
}

}  // namespace littoral
