#include "littoral/methods/pointwise.h"

#include "littoral/base/parallel.h"

namespace littoral {

VecX evaluate(const PointwiseDistance& distance, const MatX3& queries, MatX3* gradients,
              const Task& task) {
  VecX values(queries.rows());
  if (gradients != nullptr) gradients->resize(queries.rows(), 3);
  parallel_for(
      static_cast<std::size_t>(queries.rows()), 256, [&](std::size_t begin, std::size_t end) {
        task.checkpoint(static_cast<double>(begin) / static_cast<double>(queries.rows()));
        for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i) {
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
