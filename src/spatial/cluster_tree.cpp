#include "spatial/cluster_tree.h"

#include <algorithm>
#include <numeric>

#include "base/index.h"

namespace littoral {

std::vector<int> ClusterTree::opened(int root, int width) const {
  const auto size = [&](int c) {
    return clusters[c].child < 0 ? 0 : clusters[c].end - clusters[c].begin;
  };
  std::vector<int> members{root};
  while (int_size(members) < width) {
    const auto largest = std::max_element(members.begin(), members.end(),
                                          [&](int a, int b) { return size(a) < size(b); });
    const int child = clusters[*largest].child;
    if (child < 0) break;
    *largest = child;
    members.push_back(child + 1);
  }
  return members;
}

ClusterTree cluster(const MatX3& centres, int leaf_size) {
  ClusterTree tree;
  tree.order.resize(centres.rows());
  std::iota(tree.order.begin(), tree.order.end(), 0);
  tree.clusters.push_back({0, static_cast<int>(centres.rows()), -1});
  for (std::size_t at = 0; at < tree.clusters.size(); ++at) {
    const auto [begin, end, none] = tree.clusters[at];
    if (end - begin <= leaf_size) continue;
    Vec3 low = Vec3::Constant(infinity), high = -low;
    for (int i = begin; i < end; ++i) {
      const Vec3 c = centres.row(tree.order[i]);
      low = low.cwiseMin(c);
      high = high.cwiseMax(c);
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    // A multiple of the leaf size keeps leaves full.
    const int middle = begin + std::max(1, (end - begin) / 2 / leaf_size) * leaf_size;
    std::nth_element(tree.order.begin() + begin, tree.order.begin() + middle,
                     tree.order.begin() + end, [&](int a, int b) {
                       return centres(a, axis) < centres(b, axis) ||
                              (centres(a, axis) == centres(b, axis) && a < b);
                     });
    tree.clusters[at].child = tree.clusters.size();
    tree.clusters.push_back({begin, middle, -1});
    tree.clusters.push_back({middle, end, -1});
  }
  return tree;
}

}  // namespace littoral
