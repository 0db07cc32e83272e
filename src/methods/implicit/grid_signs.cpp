#include "methods/implicit/grid_signs.h"

#include <cmath>

#include "base/index.h"
#include "base/parallel.h"

namespace littoral {

void set_signs(const Grid& grid, double reach, const std::function<bool(const Vec3&)>& inside,
               const Task& task, VecX& values) {
  const std::size_t rows = std::size_t(grid.n[1]) * grid.n[2];
  parallel_for(rows, 1, [&](std::size_t row, std::size_t) {
    task.checkpoint(static_cast<double>(row) / static_cast<double>(rows));
    const int j = static_cast<int>(row % grid.n[1]), k = static_cast<int>(row / grid.n[1]);
    double before = 0;  // the value at the node before
    for (int i = 0; i < grid.n[0]; ++i) {
      double& value = values[index(grid.node(i, j, k))];
      const bool same = std::abs(before) > reach;
      before = value = (same ? before < 0 : inside(grid.point(i, j, k))) ? -value : value;
    }
  });
}

}  // namespace littoral
