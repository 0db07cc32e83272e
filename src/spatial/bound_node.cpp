#include "spatial/bound_node.h"

#include <cmath>

#include "base/dense_decompositions.h"
#include "base/index.h"

namespace littoral {

namespace {

constexpr int most_with_disk = 2048;

/// Returns the largest coordinate of a point from the centre.
double set_disk(const MatX3& points, const int* from, const int* to, BoundNode& node, int lane) {
  Vec3 centre = Vec3::Zero();
  for (const int* i = from; i < to; ++i) centre += points.row(*i);
  centre /= static_cast<double>(to - from);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double largest = 0;
  for (const int* i = from; i < to; ++i)
    largest = std::max(largest, (points.row(*i).transpose() - centre).cwiseAbs().maxCoeff());
  const double unit = largest > 0 ? largest : 1;  // so that squares stay in range
  for (const int* i = from; i < to; ++i) {
    const Vec3 d = (points.row(*i).transpose() - centre) / unit;
    spread.noalias() += d * d.transpose();
  }
  Vec3 axis = Vec3::UnitZ();
  const Vec3 least = least_eigenvector(spread);
  if (least.allFinite() && least.norm() > 0.5) axis = least.normalized();
  double radius = 0, half = 0;
  for (const int* i = from; i < to; ++i) {
    const Vec3 d = points.row(*i).transpose() - centre;
    const double h = d.dot(axis);
    half = std::max(half, std::abs(h));
    radius = std::max(radius, (d - h * axis).norm());
  }
  for (int d = 0; d < 3; ++d) {
    node.centre[d][lane] = centre[d];
    node.axis[d][lane] = axis[d];
  }
  node.radius[lane] = radius;
  node.half[lane] = half;
  return largest;
}

}  // namespace

void set_bounds(const MatX3& points, const int* from, const int* to, BoundNode& node, int lane) {
  Vec3 low = Vec3::Constant(infinity), high = -low;
  for (const int* i = from; i < to; ++i) {
    low = low.cwiseMin(points.row(*i).transpose());
    high = high.cwiseMax(points.row(*i).transpose());
  }
  for (int d = 0; d < 3; ++d) {
    node.low[d][lane] = low[d];
    node.high[d][lane] = high[d];
  }
  double largest = 0;
  if (to - from <= most_with_disk) {
    largest = set_disk(points, from, to, node, lane);
  } else {
    for (int d = 0; d < 3; ++d) {
      node.centre[d][lane] = 0.5 * low[d] + 0.5 * high[d];
      node.axis[d][lane] = 0;
    }
    node.radius[lane] = node.half[lane] = infinity;
    largest = (0.5 * high - 0.5 * low).maxCoeff();
  }
  node.slack[lane] = 3e-14 * largest;
}

void set_empty(BoundNode& node, int lane) {
  for (int d = 0; d < 3; ++d) {
    node.low[d][lane] = node.high[d][lane] = infinity;
    node.centre[d][lane] = node.axis[d][lane] = 0;
  }
  node.radius[lane] = node.half[lane] = node.slack[lane] = 0;
}

void set_small(const BoundNode& from, SmallBoundNode& to) {
  for (int l = 0; l < bound_lanes; ++l) {
    for (int d = 0; d < 3; ++d) {
      to.low[d][l] = static_cast<float>(from.low[d][l]);
      to.high[d][l] = static_cast<float>(from.high[d][l]);
      to.centre[d][l] = static_cast<float>(from.centre[d][l]);
      to.axis[d][l] = static_cast<float>(from.axis[d][l]);
    }
    to.radius[l] = static_cast<float>(from.radius[l]);
    to.half[l] = static_cast<float>(from.half[l]);
    to.child[l] = from.child[l];
  }
}

}  // namespace littoral
