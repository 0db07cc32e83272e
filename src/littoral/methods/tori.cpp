#include "littoral/methods/tori.h"

#include <array>
#include <numeric>
#include <string>
#include <unsupported/Eigen/AutoDiff>

#include "littoral/base/error.h"
#include "littoral/base/parallel.h"

namespace littoral {

namespace {

constexpr int blended = 12;      // tori that have a say at a place
constexpr double sharpness = 8;  // decay of weights over one spacing

/// Distinct points with unit normals.
OrientedPoints distinct(const OrientedPoints& cloud, Report& report) {
  const auto n = static_cast<int>(cloud.size());
  if (n == 0) throw InputError("the point cloud is empty");
  if (cloud.normals.rows() != n)
    throw InputError("the point cloud has " + std::to_string(n) + " points and " +
                     std::to_string(cloud.normals.rows()) + " normals");
  for (int i = 0; i < n; ++i) {
    if (!cloud.points.row(i).allFinite() || !cloud.normals.row(i).allFinite())
      throw InputError("point " + std::to_string(i) + " has a coordinate that is not finite");
    if (!(cloud.normals.row(i).stableNorm() > 0))
      throw InputError("point " + std::to_string(i) + " has no normal");
  }
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  auto before = [&](int a, int b) {
    for (int d = 0; d < 3; ++d)
      if (cloud.points(a, d) != cloud.points(b, d)) return cloud.points(a, d) < cloud.points(b, d);
    return false;
  };
  std::stable_sort(order.begin(), order.end(), before);
  std::vector<std::pair<int, Vec3>> kept;  // first point of its place, sum of normals
  int cancelled = 0;
  for (int i = 0; i < n;) {
    int end = i + 1;
    Vec3 sum = cloud.normals.row(order[i]).stableNormalized();
    const int members = i;
    for (; end < n && !before(order[i], order[end]); ++end)
      sum += cloud.normals.row(order[end]).stableNormalized();
    if (sum.norm() > 1e-9 * (end - members))
      kept.emplace_back(order[i], sum.normalized());
    else
      ++cancelled;
    i = end;
  }
  if (kept.empty()) throw InputError("the normals of coincident points cancel everywhere");
  if (cancelled)
    report.warn(std::to_string(cancelled) +
                " places where normals of coincident points cancel were left out");
  std::sort(kept.begin(), kept.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  if (static_cast<int>(kept.size()) < n - cancelled)
    report.warn(std::to_string(n - static_cast<int>(kept.size())) +
                " points coincide with others; each place was used once");
  OrientedPoints out;
  out.points.resize(static_cast<Eigen::Index>(kept.size()), 3);
  out.normals.resize(out.points.rows(), 3);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    out.points.row(static_cast<Eigen::Index>(i)) = cloud.points.row(kept[i].first);
    out.normals.row(static_cast<Eigen::Index>(i)) = kept[i].second;
  }
  return out;
}

/// Eq. 5.1 over the nearest tori. Weights fall to zero at the last of them, so that the value does
/// not jump when neighbours change.
template <class T>
T blend(const MatX3& points, const std::vector<Torus>& tori, const Neighbour* found, int n,
        const Eigen::Matrix<T, 3, 1>& x) {
  using std::exp;
  using std::sqrt;
  std::array<T, blended> d;
  d.fill(T(0.0));
  for (int j = 0; j < n; ++j) {
    const Eigen::Matrix<T, 3, 1> y = x - points.row(found[j].point).transpose().template cast<T>();
    d[j] = sqrt(T(y.squaredNorm() + 1e-300));
  }
  const T& nearest = d[0];
  const T& farthest = d[n - 1];
  T sum = T(0.0), total = T(0.0);
  for (int j = 0; j < n; ++j) {
    const T closeness = 1.0 - d[j] / farthest;
    const T w = closeness * closeness + 1e-9;
    sum += w * tori[found[j].point].rho;
    total += w;
  }
  const T rho = sum / total;
  const T last = exp(T(-sharpness * (farthest - nearest) / rho));
  sum = T(0.0);
  total = T(0.0);
  for (int j = 0; j < n; ++j) {
    const Torus& torus = tori[found[j].point];
    const T decay = exp(T(-sharpness * (d[j] - nearest) / rho));
    const T w = std::exp(torus.log_weight) * (decay - last) + 1e-7;
    sum += w * patch_distance<T>(torus, x);
    total += w;
  }
  // The surface passes near the nearest point: no farther than it, and not much nearer.
  const T phi = sum / total;
  const T least = nearest - rho;
  const T size = phi < 0.0 ? T(-phi) : phi;
  if (size > nearest) return phi < 0.0 ? T(-nearest) : nearest;
  if (size < least) return phi < 0.0 ? T(-least) : least;
  return phi;
}

}  // namespace

Tori::Tori(const OrientedPoints& cloud, const TorusFit& fit, const Task& task, Report& report)
    : tree_(MatX3(0, 3)) {
  const OrientedPoints used = distinct(cloud, report);
  tree_ = PointTree(used.points);
  tori_ = fit_tori(used, tree_, fit, task);
  points_ = used.points;
}

Tori::Tori(MatX3 points, std::vector<Torus> tori)
    : points_(std::move(points)), tori_(std::move(tori)), tree_(points_) {
  if (points_.rows() == 0 || static_cast<std::size_t>(points_.rows()) != tori_.size())
    throw InputError("tori need one point each, and at least one");
}

double Tori::value(const Vec3& x) const {
  std::array<Neighbour, blended> found;
  const int n = tree_.nearest(x, blended, found.data());
  return blend<double>(points_, tori_, found.data(), n, x);
}

double Tori::value(const Vec3& x, Vec3& gradient) const {
  using Dual = Eigen::AutoDiffScalar<Vec3>;
  std::array<Neighbour, blended> found;
  const int n = tree_.nearest(x, blended, found.data());
  Eigen::Matrix<Dual, 3, 1> at;
  for (int d = 0; d < 3; ++d) at[d] = Dual(x[d], 3, d);
  const Dual phi = blend<Dual>(points_, tori_, found.data(), n, at);
  gradient = phi.derivatives();
  return phi.value();
}

VecX Tori::values(const MatX3& x, const Task& task, MatX3* gradients) const {
  VecX phi(x.rows());
  if (gradients) gradients->resize(x.rows(), 3);
  parallel_for(static_cast<std::size_t>(x.rows()), 512, [&](std::size_t begin, std::size_t end) {
    task.checkpoint();
    for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i) {
      if (!gradients) {
        phi[i] = value(x.row(i));
        continue;
      }
      Vec3 gradient;
      phi[i] = value(x.row(i), gradient);
      gradients->row(i) = gradient;
    }
  });
  return phi;
}

}  // namespace littoral
