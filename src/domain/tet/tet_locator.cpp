#include "domain/tet/tet_locator.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/index.h"

namespace littoral {

namespace {

constexpr double rounding = 1e-6;  // barycentric: how far outside a point may be
constexpr int leaf_size = 8;

Vec3 corner(const TetMesh& mesh, int tet, int k) { return mesh.points.row(mesh.tets(tet, k)); }

/// Columns: the edges from corner 0.
Eigen::Matrix3d edges_of(const TetMesh& mesh, int tet) {
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = corner(mesh, tet, k + 1) - corner(mesh, tet, 0);
  return edges;
}

bool is_solid(const Eigen::Matrix3d& edges) {
  return edges.allFinite() &&
         std::abs(edges.determinant()) > 1e-14 * std::pow(edges.colwise().norm().maxCoeff(), 3);
}

}  // namespace

TetLocator::TetLocator(const TetMesh& mesh) : mesh_(mesh) {
  for (int t = 0; t < mesh.n_tets(); ++t)
    if (is_solid(edges_of(mesh, t))) tets_.push_back(t);
  MatX3 centres(tets_.size(), 3);
  for (std::size_t i = 0; i < tets_.size(); ++i) {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 4; ++k) sum += corner(mesh, tets_[i], k) / 4;
    centres.row(i) = sum;
  }
  tree_ = cluster(centres, leaf_size);
  boxes_.assign(tree_.clusters.size(), {Vec3::Constant(infinity), Vec3::Constant(-infinity)});
  // Children stand behind their parents.
  for (std::size_t c = tree_.clusters.size(); c-- > 0;) {
    Box& box = boxes_[c];
    const Cluster& group = tree_.clusters[c];
    if (group.child >= 0) {
      for (int k = 0; k < 2; ++k) {
        const Box& part = boxes_[group.child + k];
        box.low = box.low.cwiseMin(part.low);
        box.high = box.high.cwiseMax(part.high);
      }
      continue;
    }
    for (int i = group.begin; i < group.end; ++i) {
      const int t = tets_[tree_.order[i]];
      Vec3 low = corner(mesh, t, 0), high = low;
      for (int k = 1; k < 4; ++k) {
        low = low.cwiseMin(corner(mesh, t, k));
        high = high.cwiseMax(corner(mesh, t, k));
      }
      const Vec3 slack = 4 * rounding * (high - low);
      box.low = box.low.cwiseMin(low - slack);
      box.high = box.high.cwiseMax(high + slack);
    }
  }
}

TetPoint TetLocator::locate(const Vec3& x) const {
  TetPoint best;
  double depth = -rounding;
  std::array<int, 128> stack;  // medians: a path is at most 32 clusters deep
  std::size_t top = 0;
  if (!tets_.empty()) stack[top++] = 0;
  while (top > 0) {
    const std::size_t at = stack[--top];
    const Box& box = boxes_[at];
    if ((box.low.array() > x.array()).any() || (box.high.array() < x.array()).any()) continue;
    const Cluster& group = tree_.clusters[at];
    if (group.child >= 0) {
      stack[top++] = group.child + 1;
      stack[top++] = group.child;
      continue;
    }
    for (int i = group.begin; i < group.end; ++i) {
      const int t = tets_[tree_.order[i]];
      const Vec3 b = edges_of(mesh_, t).inverse() * (x - corner(mesh_, t, 0));
      const std::array<double, 4> barycentric{1 - b.sum(), b[0], b[1], b[2]};
      const double least = *std::min_element(barycentric.begin(), barycentric.end());
      if (least > depth || (least == depth && t < best.tet)) {
        depth = least;
        best = {t, barycentric};
      }
    }
  }
  return best;
}

double mean_edge(const TetMesh& mesh, const std::vector<int>& tets) {
  double sum = 0;
  for (int t : tets)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) sum += (corner(mesh, t, a) - corner(mesh, t, b)).norm();
  return tets.empty() ? 0 : sum / (6.0 * static_cast<double>(tets.size()));
}

MatX3i boundary_faces(const TetMesh& mesh) {
  // Corners in order -> outward corners, or nothing where a second tet has them.
  std::map<std::array<int, 3>, std::array<int, 3>> faces;
  constexpr int sides[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  for (int t = 0; t < mesh.n_tets(); ++t) {
    const bool right_handed = edges_of(mesh, t).determinant() >= 0;
    for (const auto& side : sides) {
      std::array<int, 3> outward{mesh.tets(t, side[0]), mesh.tets(t, side[1]),
                                 mesh.tets(t, side[2])};
      if (!right_handed) std::swap(outward[0], outward[1]);
      std::array<int, 3> key = outward;
      std::sort(key.begin(), key.end());
      const auto [found, is_new] = faces.try_emplace(key, outward);
      if (!is_new) found->second = {-1, -1, -1};
    }
  }
  std::vector<int> corners;
  for (const auto& [key, outward] : faces)
    if (outward[0] >= 0) corners.insert(corners.end(), outward.begin(), outward.end());
  return Eigen::Map<const MatX3i>(corners.data(), corners.size() / 3, 3);
}

}  // namespace littoral
