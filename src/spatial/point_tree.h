#pragma once
// Nearest neighbours among points in space.

#include <vector>

#include "littoral/types.h"
#include "spatial/bound_node.h"
#include "spatial/point_kernels.h"

namespace littoral {

/// One neighbour found.
struct Neighbour {
  double squared_distance = 0;  // [length^2]
  int point = 0;                // row of the points given

  /// The order of results: by distance, ties by number.
  friend bool operator<(const Neighbour& a, const Neighbour& b) {
    return a.squared_distance < b.squared_distance ||
           (a.squared_distance == b.squared_distance && a.point < b.point);
  }
};

/// A tree of boxes and disks, eight to a node, tight around their points; queries may run at the
/// same time. Coordinates must be finite.
class PointTree {
 public:
  explicit PointTree(const MatX3& points);  // points x 3, at least one

  int size() const { return size_; }

  /// The k nearest points in ascending order (fewer where there are fewer points), written to
  /// `found`, which must hold k; returns how many. Exact, and the same for any order of the tree.
  int nearest(const Vec3& q, int k, Neighbour* found) const;

  /// The nearest point.
  Neighbour nearest(const Vec3& q) const {
    Neighbour found;
    nearest(q, 1, &found);
    return found;
  }

  /// All points within `radius` of q, ascending.
  std::vector<Neighbour> within(const Vec3& q, double radius) const;

  /// The points as they lie in the leaves: neighbours are near each other.
  std::vector<int> order() const;

  /// Numbers the points anew, as they lie in the leaves; returns the old numbers by new. Results
  /// then name new ones.
  std::vector<int> renumber();

 private:
  using Node = BoundNode;
  using Leaf = PointLeaf;
  static constexpr int width = bound_lanes, leaf_size = leaf_lanes;

  int build(const MatX3& points, std::vector<int>& order, int begin, int end);
  template <class Visit>
  void search(const Vec3& q, double bound, Visit&& visit) const;
  // visit(leaf, squared distances, bits of those within the bound) -> bound

  int size_;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
};

}  // namespace littoral
