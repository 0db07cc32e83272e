#include "domain/cloud/cloud_normals.h"

#include <algorithm>
#include <array>
#include <queue>
#include <string>
#include <tuple>
#include <vector>

#include "base/dense_decompositions.h"
#include "base/parallel.h"
#include "littoral/error.h"
#include "spatial/point_tree.h"

namespace littoral {

namespace {

constexpr int neighbours = 16;  // enough for principal directions

}  // namespace

void check_cloud(const MatX3& points) {
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (!points.row(i).allFinite())
      throw InputError("point " + std::to_string(i) + " has coordinates that are not finite",
                       "not-finite");
  Eigen::Index second = 0, third = 0;
  while (second < points.rows() && points.row(second) == points.row(0)) ++second;
  for (third = second; third < points.rows(); ++third)
    if (points.row(third) != points.row(0) && points.row(third) != points.row(second)) break;
  if (third >= points.rows())
    throw InputError("a point cloud needs points at three different places at least",
                     "empty-input");
}

MatX3 estimate_normals(const MatX3& points, const Task& task) {
  check_cloud(points);
  const Eigen::Index n = points.rows();
  const PointTree tree(points);
  const int k = std::min<Eigen::Index>(neighbours, n);
  MatX3 normals(n, 3);
  std::vector<std::vector<int>> graph(n);
  parallel_for(n, 1024, [&](std::size_t begin, std::size_t end) {
    task.checkpoint();
    std::array<Neighbour, neighbours> near;
    for (std::size_t i = begin; i < end; ++i) {
      const int found = tree.nearest(points.row(i), k, near.data());
      Vec3 mean = Vec3::Zero();
      for (int j = 0; j < found; ++j) mean += points.row(near[j].point);
      mean /= found;
      Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
      for (int j = 0; j < found; ++j) {
        const int p = near[j].point;
        const Vec3 d = points.row(p).transpose() - mean;
        covariance += d * d.transpose();
        if (p != static_cast<int>(i)) graph[i].push_back(p);
      }
      normals.row(i) = symmetric_eigenvectors(covariance).vectors.col(0);
    }
  });
  for (std::size_t i = 0; i < graph.size(); ++i)  // neighbours both ways
    for (std::size_t j = 0, end = graph[i].size(); j < end; ++j) {
      std::vector<int>& back = graph[graph[i][j]];
      if (std::find(back.begin(), back.end(), static_cast<int>(i)) == back.end()) back.push_back(i);
    }

  // Roots from the highest point down; from each, the tree of least turning (Prim).
  std::vector<int> by_height(n);
  for (int i = 0; i < n; ++i) by_height[i] = i;
  std::stable_sort(by_height.begin(), by_height.end(),
                   [&](int a, int b) { return points(a, 2) > points(b, 2); });
  struct Step {
    double turning;
    int from, to;
    bool operator<(const Step& other) const {  // the queue gives the largest: least turning first
      return std::tie(turning, to, from) > std::tie(other.turning, other.to, other.from);
    }
  };
  std::vector<char> done(n, 0);
  for (int root : by_height) {
    if (done[root]) continue;
    if (normals(root, 2) < 0) normals.row(root) *= -1;
    std::priority_queue<Step> queue;
    queue.push({0, root, root});
    for (std::size_t steps = 0; !queue.empty(); ++steps) {
      if (steps % 4096 == 0) task.checkpoint();
      const Step step = queue.top();
      queue.pop();
      if (done[step.to]) continue;
      done[step.to] = 1;
      if (normals.row(step.to).dot(normals.row(step.from)) < 0) normals.row(step.to) *= -1;
      for (int next : graph[step.to])
        if (!done[next])
          queue.push({1 - std::abs(normals.row(next).dot(normals.row(step.to))), step.to, next});
    }
  }
  return normals;
}

}  // namespace littoral
