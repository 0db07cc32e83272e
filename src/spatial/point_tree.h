#pragma once
// Nearest neighbours among points in space.

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "base/fetch_ahead.h"
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

  /// The same; `expect` is told of points that may be among them as they are met, so that what
  /// will be read of them can be on its way from memory.
  template <class Expect>
  int nearest(const Vec3& q, int k, Neighbour* found, const Expect& expect) const;

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
  static void fetch(const Leaf& leaf) {
    const char* const bytes = reinterpret_cast<const char*>(&leaf);
    for (std::size_t line = 0; line < sizeof leaf; line += 64) fetch_ahead(bytes + line);
  }
  template <class Visit>
  void search(const Vec3& q, double bound, Visit&& visit) const;
  // visit(leaf, squared distances, bits of those within the bound) -> bound

  int size_;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
};

template <class Visit>
void PointTree::search(const Vec3& q, double bound, Visit&& visit) const {
  // Depth first, nearest child first. A node adds at most eight entries and a path is at most
  // 11 nodes deep (each divides its points by eight).
  constexpr int ahead = 2;
  std::array<BoundEntry, 128> stack;
  BoundKernel* const bounds = bound_kernel();
  LeafKernel* const leaves = leaf_kernel();
  int top = 0;
  stack[top++] = {0, 0};
  while (top > 0) {
    const BoundEntry entry = stack[--top];
    if (entry.squared > bound) continue;
    if (entry.child < 0) {
      const Leaf& leaf = leaves_[-1 - entry.child];
      alignas(64) double squared[leaf_size];
      const unsigned near = leaves(leaf, q.data(), bound, squared);
      if (near != 0) bound = visit(leaf, squared, near);
      continue;
    }
    const Node& node = nodes_[entry.child];
    alignas(64) double distance[width];
    bounds(node, q.data(), distance);
    const int before = top;
    top = push_children(node, distance, bound, stack.data(), top);
    // Leaves that are next but for the first one come from memory meanwhile.
    for (int i = top - 2; i >= before && i > top - 2 - ahead; --i)
      if (const int child = stack[i].child; child < 0) fetch(leaves_[-1 - child]);
  }
}

template <class Expect>
int PointTree::nearest(const Vec3& q, int k, Neighbour* found, const Expect& expect) const {
  k = std::min(k, size());
  if (k <= 0) return 0;
  int n = 0;
  double bound = infinity;
  search(q, bound, [&](const Leaf& leaf, const double* squared, unsigned near) {
    for (; near != 0; near &= near - 1) {
      const int i = std::countr_zero(near);
      const Neighbour candidate{squared[i], leaf.point[i]};
      if (n == k && !(candidate < found[n - 1])) continue;
      expect(candidate.point);
      int place = n < k ? n++ : n - 1;
      for (; place > 0 && candidate < found[place - 1]; --place) found[place] = found[place - 1];
      found[place] = candidate;
      if (n == k) bound = found[n - 1].squared_distance;
    }
    return bound;
  });
  return n;
}

}  // namespace littoral
