#include "spatial/crossing_number.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "base/index.h"

namespace littoral {

namespace {

constexpr int no_child = std::numeric_limits<int>::min();
constexpr float beyond_floats = std::numeric_limits<float>::infinity();

/// The axis along which rays meet the fewest triangles.
int clearest_axis(const std::vector<CrossingNumber::Triangle>& triangles) {
  Vec3 shadow = Vec3::Zero(), low = Vec3::Constant(infinity), high = -low;
  for (const auto& [a, b, c] : triangles) {
    shadow += (b - a).cross(c - a).cwiseAbs();
    low = low.cwiseMin(a).cwiseMin(b).cwiseMin(c);
    high = high.cwiseMax(a).cwiseMax(b).cwiseMax(c);
  }
  const Vec3 size = (high - low).cwiseMax(1e-3 * (high - low).maxCoeff());
  int axis = 0;
  shadow.cwiseProduct(size).minCoeff(&axis);  // shadow / (area of the box across)
  return axis;
}

/// The edges of a closed chain, each once, as loops of corners.
std::vector<std::vector<Vec3>> loops_of(const std::vector<std::array<Vec3, 2>>& edges) {
  std::map<std::array<double, 3>, std::vector<int>> leaving;
  const auto key = [](const Vec3& p) { return std::array{p[0], p[1], p[2]}; };
  for (int e = int_size(edges) - 1; e >= 0; --e) leaving[key(edges[e][0])].push_back(e);
  std::vector<std::vector<Vec3>> loops;
  for (const auto& start : edges) {
    auto at = leaving.find(key(start[0]));
    if (at->second.empty()) continue;
    std::vector<Vec3> loop;
    while (!at->second.empty()) {  // a chain without ends: a walk stops where it began
      const int e = at->second.back();
      at->second.pop_back();
      loop.push_back(edges[e][0]);
      at = leaving.find(key(edges[e][1]));
      if (at == leaving.end()) break;
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace

CrossingNumber::CrossingNumber(const ClusterTree& tree, const std::vector<Triangle>& triangles,
                               const std::vector<std::array<Vec3, 2>>& boundary) {
  if (triangles.empty()) return;
  axis_ = clearest_axis(triangles);
  add_node(tree, triangles, 0);
  set_walk(boundary);
}

void CrossingNumber::set_walk(const std::vector<std::array<Vec3, 2>>& boundary) {
  if (boundary.empty()) return;
  const auto add = [&](const Vec3& p) {
    const Point at = rotated(p);
    for (std::size_t k = 0; k < 3; ++k) walk_[k].push_back(at[k]);
  };
  const auto loops = loops_of(boundary);
  const Vec3 home = loops.front().front();
  for (const auto& loop : loops) {
    for (const Vec3& p : loop) add(p);
    add(loop.front());
    if (&loop != &loops.front()) add(home);
  }
  n_edges_ = (int_size(walk_[0]) - 1 + walk_lanes - 1) / walk_lanes * walk_lanes;
  for (auto& column : walk_) {
    column.resize(n_edges_ + winding_lanes, column.back());
    const auto [low, high] = std::minmax_element(column.begin(), column.end());
    centre_[&column - walk_.data()] = (*low + *high) / 2;
    radius_ = std::hypot(radius_, (*high - *low) / 2);
  }
}

int CrossingNumber::crossings(const Point& q) const {
  if (nodes_.empty()) return 0;
  const CrossingKernels& kernels = crossing_kernels();
  const std::array<float, 3> coarse{static_cast<float>(q[0]), static_cast<float>(q[1]),
                                    static_cast<float>(q[2])};
  std::array<int, 32 * winding_lanes> stack;  // a path is at most 32 nodes deep
  std::size_t top = 0;
  stack[top++] = 0;
  int sum = 0;
  while (top > 0) {
    const ShadowNode& node = nodes_[stack[--top]];
    for (unsigned met = kernels.pierced(node, coarse.data()); met != 0; met &= met - 1) {
      const int child = node.child[std::countr_zero(met)];
      if (child >= 0)
        stack[top++] = child;
      else
        sum += kernels.crossings(leaves_[-1 - child], q.data());
    }
  }
  return sum;
}

double CrossingNumber::boundary_angle(const Point& q) const {
  if (n_edges_ == 0) return 0;
  WalkAngle angle;
  const double reach =
      radius_ + std::hypot(q[0] - centre_[0], q[1] - centre_[1], q[2] - centre_[2]);
  if (crossing_kernels().walk_angle(
          {walk_[0].data(), walk_[1].data(), walk_[2].data(), n_edges_, reach}, q.data(), angle))
    return std::atan2(angle.im, angle.re) + 2 * M_PI * angle.turns;
  double sum = 0;
  Point a{walk_[0][0] - q[0], walk_[1][0] - q[1], walk_[2][0] - q[2]};
  for (int e = 1; e <= n_edges_; ++e) {
    const Point b{walk_[0][e] - q[0], walk_[1][e] - q[1], walk_[2][e] - q[2]};
    sum += careful_angle(a.data(), b.data());
    a = b;
  }
  return sum;
}

double CrossingNumber::operator()(const Vec3& query) const {
  const Point q = rotated(query);
  return crossings(q) + boundary_angle(q) / (2 * M_PI);
}

int CrossingNumber::add_node(const ClusterTree& tree, const std::vector<Triangle>& triangles,
                             int root) {
  const auto members = tree.opened(root, winding_lanes);
  const int at = int_size(nodes_);
  nodes_.emplace_back();
  ShadowNode node;
  node.child.fill(no_child);
  for (auto* low : {&node.low_y, &node.low_z}) low->fill(beyond_floats);
  for (auto* high : {&node.high_x, &node.high_y, &node.high_z}) high->fill(-beyond_floats);
  for (std::size_t l = 0; l < members.size(); ++l) {
    const Cluster& c = tree.clusters[members[l]];
    Point low, high;
    low.fill(infinity);
    high.fill(-low[0]);
    for (int i = c.begin; i < c.end; ++i)
      for (const Vec3& corner : triangles[i]) {
        const Point p = rotated(corner);
        for (std::size_t k = 0; k < 3; ++k) {
          low[k] = std::min(low[k], p[k]);
          high[k] = std::max(high[k], p[k]);
        }
      }
    node.high_x[l] = static_cast<float>(high[0]);
    node.low_y[l] = static_cast<float>(low[1]);
    node.high_y[l] = static_cast<float>(high[1]);
    node.low_z[l] = static_cast<float>(low[2]);
    node.high_z[l] = static_cast<float>(high[2]);
    if (c.child >= 0) {
      node.child[l] = add_node(tree, triangles, members[l]);
      continue;
    }
    // Unused lanes repeat one point.
    TriangleLanes leaf;
    for (int t = 0; t < winding_lanes; ++t)
      for (int k = 0; k < 3; ++k) {
        const bool used = c.begin + t < c.end;
        const Point p = rotated(triangles[used ? c.begin + t : c.begin][used ? k : 0]);
        for (std::size_t d = 0; d < 3; ++d) leaf.corner[3 * k + d][t] = p[d];
      }
    leaves_.push_back(leaf);
    node.child[l] = -int_size(leaves_);
  }
  nodes_[at] = node;
  return at;
}

}  // namespace littoral
