#include "spatial/grid_values.h"

#include "base/index.h"
#include "base/parallel.h"

namespace littoral {

VecX grid_values(const Grid& grid, const Task& task,
                 const std::function<double(const Vec3& x, int& last)>& value) {
  VecX out(grid.n_nodes());
  const int rows = grid.n[1] * grid.n[2];
  parallel_for(rows, 1, [&](std::size_t row, std::size_t) {
    task.checkpoint(static_cast<double>(row) / rows);
    const int j = static_cast<int>(row) % grid.n[1], k = static_cast<int>(row) / grid.n[1];
    int last = -1;
    for (int i = 0; i < grid.n[0]; ++i) out[grid.node(i, j, k)] = value(grid.point(i, j, k), last);
  });
  return out;
}

MatX3 grid_points(const Grid& grid) {
  MatX3 points(index(grid.n_nodes()), 3);
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i)
        points.row(index(grid.node(i, j, k))) = grid.point(i, j, k);
  return points;
}

}  // namespace littoral
