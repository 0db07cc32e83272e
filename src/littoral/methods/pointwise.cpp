#include "littoral/methods/pointwise.h"

#include "littoral/base/parallel.h"
#include "littoral/spatial/z_order.h"

namespace littoral {

VecX evaluate(const PointwiseDistance& distance, const MatX3& queries, MatX3* gradients,
              const Task& task) {
  VecX values(queries.rows());
  if (gradients != nullptr) gradients->resize(queries.rows(), 3);
  // One after the other near each other: what one needs of trees is at hand for the next.
  const std::vector<int> order = z_order(queries);
  parallel_for(static_cast<std::size_t>(queries.rows()), 256,
               [&](std::size_t begin, std::size_t end) {
                 task.checkpoint(static_cast<double>(begin) / static_cast<double>(queries.rows()));
                 for (std::size_t place = begin; place < end; ++place) {
                   const int i = order[place];
                   if (gradients == nullptr) {
                     values[i] = distance.value(queries.row(i));
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
