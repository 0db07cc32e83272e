#include "spatial/smoothed_winding.h"

#include <cmath>
#include <numbers>

namespace littoral {

namespace {

constexpr double reach = 5;       // deviations; beyond, a point is as sharp as without
constexpr double nearest = 1e-4;  // deviations; the sum of what is sharp is singular at points

}  // namespace

SmoothedWindingNumber::SmoothedWindingNumber(const MatX3& points, const MatX3& normals,
                                             const VecX& areas, double sigma)
    : points_(points),
      vector_areas_(normals.array().colwise() * areas.array()),
      sigma_(sigma),
      near_(points),
      sharp_(points, normals, areas) {}

double SmoothedWindingNumber::operator()(const Vec3& query) const {
  using std::numbers::inv_sqrtpi, std::numbers::pi, std::numbers::sqrt2;
  Vec3 q = query;
  if (std::sqrt(near_.nearest(q).squared_distance) < nearest * sigma_)
    q = points_.row(near_.nearest(q).point).transpose() + Vec3(nearest * sigma_, 0, 0);
  double sum = sharp_(q);
  for (const Neighbour& n : near_.within(q, reach * sigma_)) {
    const double r = std::sqrt(n.squared_distance), s = r / (sqrt2 * sigma_);
    const double missing = std::erfc(s) + 2 * inv_sqrtpi * s * std::exp(-s * s);
    sum -= missing * vector_areas_.row(n.point).dot(points_.row(n.point) - q.transpose()) /
           (4 * pi * n.squared_distance * r);
  }
  return sum;
}

}  // namespace littoral
