#include "spatial/valued_nearest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/index.h"
#include "spatial/closest_on_triangle.h"

namespace littoral {

namespace {

constexpr int sources_together = 8;
constexpr double squares_overflow = 1e100;  // farther away, values are below rounding

MatX3 centres_of(const MatX3& points, const MatX3i& faces) {
  if (faces.rows() == 0) return points;
  MatX3 centres(faces.rows(), 3);
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    centres.row(f) = points(faces.row(f), Eigen::all).colwise().mean();
  return centres;
}

}  // namespace

ValuedNearest::ValuedNearest(const MatX3& points, const MatX3i& faces, std::vector<double> values)
    : points_(points),
      faces_(faces),
      values_(std::move(values)),
      tree_(cluster(centres_of(points, faces), sources_together)) {
  const std::size_t n = tree_.clusters.size();
  low_ = MatX3::Constant(index(n), 3, infinity);
  high_ = -low_;
  least_.assign(n, infinity);
  greatest_.assign(n, -infinity);
  for (std::size_t at = n; at-- > 0;) {  // children before their parents
    const Cluster& box = tree_.clusters[at];
    const auto row = index(at);
    const auto add = [&](const auto& low, const auto& high, double least, double greatest) {
      low_.row(row) = low_.row(row).cwiseMin(low);
      high_.row(row) = high_.row(row).cwiseMax(high);
      least_[at] = std::min(least_[at], least);
      greatest_[at] = std::max(greatest_[at], greatest);
    };
    for (int c = box.child; box.child >= 0 && c < box.child + 2; ++c)
      add(low_.row(c), high_.row(c), least_[c], greatest_[c]);
    for (int i = box.begin; box.child < 0 && i < box.end; ++i) {
      const int source = tree_.order[i];
      for (int k = 0; k < (faces_.rows() == 0 ? 1 : 3); ++k) {
        const auto p = points_.row(faces_.rows() == 0 ? source : faces_(source, k));
        add(p, p, values_[source], values_[source]);
      }
    }
  }
}

double ValuedNearest::bound(std::size_t box, const Vec3& x, int sign) const {
  const Vec3 below = low_.row(index(box)).transpose() - x;
  const Vec3 above = x - high_.row(index(box)).transpose();
  const double distance = below.cwiseMax(above).cwiseMax(0.0).norm();
  return distance + (sign > 0 ? least_[box] : -greatest_[box]);
}

Vec3 ValuedNearest::way_to(int source, const Vec3& x) const {
  if (faces_.rows() == 0) return points_.row(source).transpose() - x;
  const auto corner = [&](int k) { return Vec3(points_.row(faces_(source, k)).transpose() - x); };
  return closest_on_triangle(corner(0), corner(1), corner(2)).offset;
}

ValuedPoint ValuedNearest::best(const Vec3& x, int sign) const {
  ValuedPoint found;
  double best = infinity;  // of d + sign * c
  const auto look = [&](int source) {
    const Vec3 way = way_to(source, x);
    const double distance = way.stableNorm();
    const double reach = distance + sign * values_[source];
    if (!(reach < best) && (reach != best || source > found.source)) return;
    best = reach;
    found = {sign * reach, distance, x + way, source};
  };
  if (!(x.cwiseAbs().maxCoeff() < squares_overflow)) {
    look(0);
    return found;
  }
  std::array<std::pair<double, int>, 128> stack;
  std::size_t top = 0;
  stack[top++] = {-infinity, 0};
  while (top > 0) {
    const auto [least, at] = stack[--top];
    if (least > best) continue;
    const Cluster& box = tree_.clusters[at];
    if (box.child < 0) {
      for (int i = box.begin; i < box.end; ++i) look(tree_.order[i]);
      continue;
    }
    std::pair<double, int> nearer{bound(box.child, x, sign), box.child};
    std::pair<double, int> farther{bound(box.child + 1, x, sign), box.child + 1};
    if (farther.first < nearer.first) std::swap(nearer, farther);
    stack[top++] = farther;
    stack[top++] = nearer;
  }
  return found;
}

}  // namespace littoral
