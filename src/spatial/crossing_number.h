#pragma once
// Winding numbers without sums over faces: crossings of one ray and the boundary of the surface.

#include <array>
#include <vector>

#include "littoral/types.h"
#include "spatial/cluster_tree.h"
#include "spatial/crossing_kernels.h"

namespace littoral {

/// Exact winding numbers of triangles whose boundary has few edges.
///
/// Close the surface by a cone from its boundary to infinity, opposite to a ray from the query. The
/// ray does not meet the cone, so its signed crossings with the surface are the winding number of
/// the whole, and
///
///   w = crossings + 1/(2 pi) sum over boundary edges a -> b of the angle of
///         |a||b| + |b| m.a + |a| m.b + a.b + i m.(a x b),    a, b relative to the query,
///
/// with m the direction opposite to the ray; the angle is half the solid angle of (m, a, b) (van
/// Oosterom and Strackee 1983). Which side of an edge the ray passes is decided by one number in
/// both terms. Immutable, may be evaluated from several threads.
class CrossingNumber {
 public:
  using Triangle = std::array<Vec3, 3>;

  CrossingNumber() = default;
  /// Triangles in the order of the tree; the boundary as a chain, edges from the first corner to
  /// the second, none of them twice but where the chain has them twice.
  CrossingNumber(const ClusterTree& tree, const std::vector<Triangle>& triangles,
                 const std::vector<std::array<Vec3, 2>>& boundary);

  double operator()(const Vec3& query) const;

 private:
  using Point = std::array<double, 3>;  // rotated: the ray goes along the first axis

  Point rotated(const Vec3& p) const { return {p[axis_], p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]}; }
  void set_walk(const std::vector<std::array<Vec3, 2>>& boundary);
  int add_node(const ClusterTree& tree, const std::vector<Triangle>& triangles, int root);
  int crossings(const Point& q) const;
  double boundary_angle(const Point& q) const;

  int axis_ = 0;
  std::vector<ShadowNode> nodes_;  // child: another node, -1 - leaf, or none
  std::vector<TriangleLanes> leaves_;
  // Corners along a closed walk through all boundary edges; pairs of loops are joined by an edge
  // there and back.
  std::array<std::vector<double>, 3> walk_;
  int n_edges_ = 0;
  Point centre_{};  // of the walk's box
  double radius_ = 0;
};

}  // namespace littoral
