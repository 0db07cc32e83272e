#include "littoral/spatial/point_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace littoral {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int leaf_size = 8;

}  // namespace

PointTree::PointTree(const MatX3& points) : order_(static_cast<std::size_t>(points.rows())) {
  std::iota(order_.begin(), order_.end(), 0);
  if (order_.empty()) return;
  build(points, 0, size());
  for (int d = 0; d < 3; ++d) {
    x_[d].reserve(order_.size());
    for (int p : order_) x_[d].push_back(points(p, d));
  }
}

void PointTree::split(const MatX3& points, int begin, int end, int levels, std::vector<int>& cuts) {
  if (levels == 0 || end - begin <= leaf_size) {
    cuts.push_back(end);
    return;
  }
  Vec3 low = Vec3::Constant(infinity), high = -low;
  for (int i = begin; i < end; ++i) {
    low = low.cwiseMin(points.row(order_[i]).transpose());
    high = high.cwiseMax(points.row(order_[i]).transpose());
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(
      order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
        return points(a, axis) < points(b, axis) || (points(a, axis) == points(b, axis) && a < b);
      });
  split(points, begin, middle, levels - 1, cuts);
  split(points, middle, end, levels - 1, cuts);
}

int PointTree::build(const MatX3& points, int begin, int end) {
  std::vector<int> cuts;
  split(points, begin, end, 3, cuts);
  const int at = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  for (int c = 0; c < width; ++c) {
    Vec3 low = Vec3::Constant(infinity), high = Vec3::Constant(infinity);
    int child = -1;
    if (c < static_cast<int>(cuts.size())) {
      const int from = c == 0 ? begin : cuts[c - 1], to = cuts[c];
      high = -low;
      for (int i = from; i < to; ++i) {
        low = low.cwiseMin(points.row(order_[i]).transpose());
        high = high.cwiseMax(points.row(order_[i]).transpose());
      }
      if (to - from <= leaf_size) {
        child = -1 - static_cast<int>(leaves_.size());
        leaves_.push_back({from, to});
      } else {
        child = build(points, from, to);
      }
    }
    for (int d = 0; d < 3; ++d) {
      nodes_[at].low[d][c] = low[d];
      nodes_[at].high[d][c] = high[d];
    }
    nodes_[at].child[c] = child;
  }
  return at;
}

template <class Visit>
void PointTree::search(const Vec3& q, Visit&& visit) const {
  // Depth first, nearest child first. A node adds at most eight entries and a path is at most
  // 11 nodes deep (each divides its points by eight).
  struct Entry {
    double distance;
    int child;
  };
  std::array<Entry, 128> stack;
  int top = 0;
  stack[top++] = {0, 0};
  double bound = infinity;
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.distance > bound) continue;
    if (entry.child < 0) {
      const Leaf& leaf = leaves_[-1 - entry.child];
      bound = visit(leaf.begin, leaf.end);
      continue;
    }
    const Node& node = nodes_[entry.child];
    double distance[width] = {};
    for (int d = 0; d < 3; ++d)
      for (int c = 0; c < width; ++c) {
        const double gap = std::max(std::max(node.low[d][c] - q[d], q[d] - node.high[d][c]), 0.0);
        distance[c] += gap * gap;
      }
    const int first = top;
    for (int c = 0; c < width; ++c) {
      if (!(distance[c] <= bound) || distance[c] == infinity) continue;
      int place = top++;
      for (; place > first && stack[place - 1].distance < distance[c]; --place)
        stack[place] = stack[place - 1];
      stack[place] = {distance[c], node.child[c]};
    }
  }
}

int PointTree::nearest(const Vec3& q, int k, Neighbour* found) const {
  k = std::min(k, size());
  if (k <= 0) return 0;
  int n = 0;
  search(q, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const double dx = x_[0][i] - q[0], dy = x_[1][i] - q[1], dz = x_[2][i] - q[2];
      const Neighbour candidate{dx * dx + dy * dy + dz * dz, order_[i]};
      if (n == k && !(candidate < found[n - 1])) continue;
      int place = n < k ? n++ : n - 1;
      for (; place > 0 && candidate < found[place - 1]; --place) found[place] = found[place - 1];
      found[place] = candidate;
    }
    return n == k ? found[n - 1].squared_distance : infinity;
  });
  return n;
}

std::vector<Neighbour> PointTree::within(const Vec3& q, double radius) const {
  std::vector<Neighbour> found;
  const double bound = radius * radius;
  search(q, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const double dx = x_[0][i] - q[0], dy = x_[1][i] - q[1], dz = x_[2][i] - q[2];
      const double squared = dx * dx + dy * dy + dz * dz;
      if (squared <= bound) found.push_back({squared, order_[i]});
    }
    return bound;
  });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace littoral
