#include "contour/redistance.h"

#include <algorithm>
#include <atomic>

#include "base/index.h"
#include "base/parallel.h"
#include "littoral/error.h"
#include "spatial/triangle_bvh.h"
#include "spatial/triangulate.h"

namespace littoral {

VecX redistance(const Grid& grid, const VecX& values, double level, const PolygonSoup& surface,
                double reach, const Task& task) {
  if (values.size() != index(grid.n_nodes()))
    throw InputError("redistance: " + std::to_string(values.size()) + " values for " +
                         std::to_string(grid.n_nodes()) + " nodes",
                     "sizes-differ");
  VecX distance = (values.array() > level).select(VecX::Constant(values.size(), reach), -reach);
  if (surface.n_faces() == 0) return distance;
  task.checkpoint();
  const TriangleBvh bvh(surface.points, triangles_of(surface));
  task.checkpoint();

  // Blocks of nodes; one query says whether a whole block is out of reach.
  constexpr int side = 8;
  std::array<int, 3> blocks;
  for (int a = 0; a < 3; ++a) blocks[a] = (grid.n[a] + side - 1) / side;
  const auto count = std::size_t(blocks[0]) * blocks[1] * blocks[2];
  std::atomic<std::size_t> done{0};
  parallel_for(count, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      task.checkpoint(static_cast<double>(done++) / static_cast<double>(count));
      std::array<int, 3> low, high;
      std::size_t rest = b;
      for (int a = 0; a < 3; ++a) {
        low[a] = side * static_cast<int>(rest % blocks[a]);
        rest /= blocks[a];
        high[a] = std::min(grid.n[a], low[a] + side);
      }
      const Vec3 first = grid.point(low[0], low[1], low[2]);
      const Vec3 last = grid.point(high[0] - 1, high[1] - 1, high[2] - 1);
      const Vec3 middle = 0.5 * first + 0.5 * last;
      const NearestPoint found = bvh.closest_point(middle);
      if (found.distance > reach + (last - middle).norm()) continue;
      int before = found.face;
      for (int k = low[2]; k < high[2]; ++k) {
        for (int j = low[1]; j < high[1]; ++j) {
          for (int i = low[0]; i < high[0]; ++i) {
            double& d = distance[grid.node(i, j, k)];
            const NearestPoint foot = bvh.closest_point(grid.point(i, j, k), before);
            before = foot.face;
            const double near = std::min(reach, foot.distance);
            d = d > 0 ? near : -near;
          }
        }
      }
    }
  });
  return distance;
}

}  // namespace littoral
