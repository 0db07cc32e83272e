#include "methods/implicit/pointwise.h"

#include <array>

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
  constexpr std::size_t at_once = 256;
  parallel_for(queries.rows(), at_once, [&](std::size_t begin, std::size_t end) {
    task.checkpoint(static_cast<double>(begin) / static_cast<double>(queries.rows()));
    // Fetched together: one by one each would be waited for.
    std::array<Vec3, at_once> points;
    for (std::size_t at = begin; at < end; ++at) points[at - begin] = queries.row(order[at]);
    int last = -1;
    for (std::size_t at = begin; at < end; ++at) {
      const int i = order[at];
      const Vec3& x = points[at - begin];
      if (gradients == nullptr) {
        values[i] = distance.value_after(x, last);
        continue;
      }
      const DistanceSample sample = distance.at(x);
      values[i] = sample.value;
      gradients->row(i) = sample.gradient;
    }
  });
  values.array() += 0.0;  // -0, of points on the surface that count as inside, becomes 0
  return values;
}

}  // namespace littoral
