#pragma once
// Oriented points in blocks of sixteen, for sums over those near a query.

#include <algorithm>
#include <array>
#include <vector>

#include "littoral/types.h"
#include "spatial/cluster_tree.h"

namespace littoral {

/// Points with normals and areas, grouped by place, coordinates relative to `origin()`. Immutable,
/// may be visited from several threads.
class PointBlocks {
 public:
  static constexpr int lanes = 16;
  using Lanes = Eigen::Array<double, lanes, 1>;

  struct Block {
    Lanes x, y, z, nx, ny, nz, area;  // unused lanes repeat a point with area 0
  };

  /// points, normals: n x 3; areas: n; n >= 1, all finite.
  PointBlocks(const MatX3& points, const MatX3& normals, const VecX& areas)
      : tree_(cluster(points, lanes)), origin_(points.colwise().mean().transpose()) {
    for (const Cluster& c : tree_.clusters) {
      Box box;
      box.low = box.high = points.row(place(c.begin)).transpose() - origin_;
      for (int i = c.begin; i < c.end; ++i) {
        const Vec3 p = points.row(place(i)).transpose() - origin_;
        box.low = box.low.cwiseMin(p);
        box.high = box.high.cwiseMax(p);
      }
      if (c.child < 0) {
        box.block = blocks_.size();
        Block b;
        for (int l = 0; l < lanes; ++l) {
          const int item = place(std::min(c.begin + l, c.end - 1));
          const Vec3 p = points.row(item).transpose() - origin_;
          b.x[l] = p[0];
          b.y[l] = p[1];
          b.z[l] = p[2];
          b.nx[l] = normals(item, 0);
          b.ny[l] = normals(item, 1);
          b.nz[l] = normals(item, 2);
          b.area[l] = c.begin + l < c.end ? areas[item] : 0;
        }
        blocks_.push_back(b);
      }
      boxes_.push_back(box);
    }
  }

  const Vec3& origin() const { return origin_; }

  /// Calls visit(block) for every block that has a point within `radius` of q, and for some others.
  template <class Visit>
  void visit(const Vec3& q, double radius, const Visit& visit) const {
    const Vec3 local = q - origin_;
    std::array<int, 128> stack;  // medians: a path is at most 32 clusters deep
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const std::size_t at = stack[--top];
      const Box& box = boxes_[at];
      const Vec3 gap = (box.low - local).cwiseMax(local - box.high).cwiseMax(0.0);
      if (gap.squaredNorm() > radius * radius) continue;
      const int child = tree_.clusters[at].child;
      if (child < 0) {
        visit(blocks_[box.block]);
      } else {
        stack[top++] = child + 1;
        stack[top++] = child;
      }
    }
  }

 private:
  struct Box {
    Vec3 low, high;
    int block = -1;
  };
  int place(int i) const { return tree_.order[i]; }

  ClusterTree tree_;
  Vec3 origin_;
  std::vector<Box> boxes_;  // per cluster
  std::vector<Block> blocks_;
};

}  // namespace littoral
