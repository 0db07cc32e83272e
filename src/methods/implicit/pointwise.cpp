#include "methods/implicit/pointwise.h"

#include "base/parallel.h"
#include "spatial/grid_values.h"
#include "spatial/morton_order.h"

namespace littoral {

VecX PointwiseDistance::on_grid(const Grid& grid, const Task& task) const {
  return grid_values(grid, task, [&](const Vec3& x, int& last) { return value_after(x, last); });
}

VecX evaluate(const PointwiseDistance& distance, const MatX3& queries, MatX3* gradients,
              const Task& task) {
  VecX values(queries.rows());
  if (gradients != nullptr) gradients->resize(queries.rows(), 3);
  // Neighbours in a row find the same things in the processor's caches.
  const std::vector<int> order = morton_order(queries);
  parallel_for(queries.rows(), 256, [&](std::size_t begin, std::size_t end) {
    task.checkpoint(static_cast<double>(begin) / static_cast<double>(queries.rows()));
    int last = -1;
    for (std::size_t at = begin; at < end; ++at) {
      const int i = order[at];
      if (gradients == nullptr) {
        values[i] = distance.value_after(queries.row(i), last);
        continue;
      }
      const DistanceSample sample = distance.at(queries.row(i));
      values[i] = sample.value;
      gradients->row(i) = sample.gradient;
    }
  });
  return values;
}

}  // namespace littoral
