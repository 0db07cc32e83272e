#pragma once
// Items grouped by place: the skeleton that sums over far and near items walk.

#include <vector>

#include "littoral/types.h"

namespace littoral {

/// One group of items.
struct Cluster {
  int begin = 0, end = 0;  // into ClusterTree::order
  int child = -1;          // two children stand at child and child + 1; -1: a leaf
};

/// Binary tree by medians along the longest side. The root is cluster 0; parents stand before their
/// children.
struct ClusterTree {
  std::vector<Cluster> clusters;
  std::vector<int> order;  // place -> item

  /// Up to `width` clusters that make up another one: the largest are opened as long as there is
  /// room.
  std::vector<int> opened(int root, int width) const;
};

/// Groups items by their centres (items x 3, finite) until at most `leaf_size` are together.
ClusterTree cluster(const MatX3& centres, int leaf_size);

}  // namespace littoral
