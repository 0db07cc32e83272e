#include "spatial/point_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

#include "base/index.h"

namespace littoral {

namespace {

using Order = std::vector<int>;  // place in the tree -> point

/// Halves a range of places along its longest side, `levels` times or until it is a leaf; appends
/// where the parts end.
void split(const MatX3& points, Order& order, int begin, int end, int levels, int leaf,
           std::vector<int>& cuts) {
  if (levels == 0 || end - begin <= leaf) {
    cuts.push_back(end);
    return;
  }
  Vec3 low = Vec3::Constant(infinity), high = -low;
  for (int i = begin; i < end; ++i) {
    low = low.cwiseMin(points.row(order[i]).transpose());
    high = high.cwiseMax(points.row(order[i]).transpose());
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(
      order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int a, int b) {
        return points(a, axis) < points(b, axis) || (points(a, axis) == points(b, axis) && a < b);
      });
  split(points, order, begin, middle, levels - 1, leaf, cuts);
  split(points, order, middle, end, levels - 1, leaf, cuts);
}

}  // namespace

PointTree::PointTree(const MatX3& points) : size_(points.rows()) {
  Order order(size_);
  std::iota(order.begin(), order.end(), 0);
  if (size_ > 0) build(points, order, 0, size_);
}

int PointTree::build(const MatX3& points, Order& order, int begin, int end) {
  std::vector<int> cuts;
  split(points, order, begin, end, 3, leaf_size, cuts);
  const int at = nodes_.size();
  nodes_.emplace_back();
  for (int c = 0; c < width; ++c) {
    int child = -1;
    if (c >= int_size(cuts)) {
      set_empty(nodes_[at], c);
    } else {
      const int from = c == 0 ? begin : cuts[c - 1], to = cuts[c];
      set_bounds(points, order.data() + from, order.data() + to, nodes_[at], c);
      if (to - from <= leaf_size) {
        child = -1 - int_size(leaves_);
        Leaf& leaf = leaves_.emplace_back();
        leaf.size = to - from;
        for (int i = 0; i < leaf_size; ++i) {
          leaf.point[i] = i < leaf.size ? order[from + i] : -1;
          for (int d = 0; d < 3; ++d)
            leaf.x[d][i] = i < leaf.size ? points(leaf.point[i], d) : infinity;
        }
      } else {
        child = build(points, order, from, to);
      }
    }
    nodes_[at].child[c] = child;
  }
  return at;
}

std::vector<int> PointTree::order() const {
  std::vector<int> out;
  out.reserve(size_);
  for (const Leaf& leaf : leaves_) out.insert(out.end(), leaf.point, leaf.point + leaf.size);
  return out;
}

std::vector<int> PointTree::renumber() {
  std::vector<int> old = order();
  int next = 0;
  for (Leaf& leaf : leaves_)
    for (int i = 0; i < leaf.size; ++i) leaf.point[i] = next++;
  return old;
}

int PointTree::nearest(const Vec3& q, int k, Neighbour* found) const {
  return nearest(q, k, found, [](int) {});
}

std::vector<Neighbour> PointTree::within(const Vec3& q, double radius) const {
  std::vector<Neighbour> found;
  const double bound = radius * radius;
  search(q, bound, [&](const Leaf& leaf, const double* squared, unsigned near) {
    for (; near != 0; near &= near - 1) {
      const int i = std::countr_zero(near);
      found.push_back({squared[i], leaf.point[i]});
    }
    return bound;
  });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace littoral
