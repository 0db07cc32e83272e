#include "littoral/methods/tori.h"

#include <array>
#include <numeric>
#include <string>
#include <unsupported/Eigen/AutoDiff>

#include "littoral/base/error.h"

namespace littoral {

namespace {

constexpr int blended = 12;      // tori that have a say at a place
constexpr double sharpness = 8;  // decay of weights over one spacing
// Tori are believed on the side within this many spacings of the nearest point, or if no more than
// this share of the weight disagrees; farther than this many spacings only if the winding number
// is not this certain of the contrary: patches of flipped normals agree among themselves.
constexpr double near_surface = 1.5, dissent = 0.02, far_away = 3, certain = 0.25;
constexpr double side_accuracy = 2;  // of the winding number: errors of 0.01 do not matter

/// Which side a place is on, if it is known, and what the tori say about that.
struct Side {
  int known = 0;  // 1 outside, -1 inside, 0 not known
  bool disputed = false, far = false;
};

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
        const Eigen::Matrix<T, 3, 1>& x, Side& side) {
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
  T negative = T(0.0);  // weight of those that see x inside
  for (int j = 0; j < n; ++j) {
    const Torus& torus = tori[found[j].point];
    const T decay = exp(T(-sharpness * (d[j] - nearest) / rho));
    const T w = std::exp(torus.log_weight) * (decay - last) + 1e-7;
    T g = patch_distance<T>(torus, x);
    if (g < 0.0) negative += w;
    if (side.known != 0 && (g < 0.0) != (side.known < 0)) g = -g;
    sum += w * g;
    total += w;
  }
  side.far = nearest > far_away * rho;
  side.disputed = nearest > near_surface * rho && negative > dissent * total &&
                  negative < (1 - dissent) * total;
  // The surface passes near the nearest point: no farther than it, and not much nearer.
  const T phi = sum / total;
  const T least = nearest - rho;
  const T size = phi < 0.0 ? T(-phi) : phi;
  if (size > nearest) return phi < 0.0 ? T(-nearest) : nearest;
  if (size < least) return phi < 0.0 ? T(-least) : least;
  return phi;
}

/// One torus stands for about this area: 5 (hexagons) to 6 (random points) lie within rho of it.
VecX areas_of(const std::vector<Torus>& tori) {
  VecX areas(static_cast<Eigen::Index>(tori.size()));
  for (std::size_t i = 0; i < tori.size(); ++i) {
    const double area = std::acos(-1.0) * tori[i].rho * tori[i].rho / 5.5;
    areas[static_cast<Eigen::Index>(i)] = std::isfinite(area) ? area : 0;  // a lone point's plane
  }
  return areas;
}

MatX3 normals_of(const std::vector<Torus>& tori) {
  MatX3 normals(static_cast<Eigen::Index>(tori.size()), 3);
  for (std::size_t i = 0; i < tori.size(); ++i)
    normals.row(static_cast<Eigen::Index>(i)) = tori[i].n;
  return normals;
}

/// Everything that a constructor makes.
struct Fitted {
  MatX3 points;
  std::vector<Torus> tori;
};

Fitted fitted(const OrientedPoints& cloud, const TorusFit& fit, const Task& task, Report& report) {
  OrientedPoints used = distinct(cloud, report);
  task.checkpoint();
  std::vector<Torus> tori = fit_tori(used, PointTree(used.points), fit, task);
  return {std::move(used.points), std::move(tori)};
}

/// 1 if normals point out of what the cloud encloses, -1 if into it, 0 if it encloses hardly
/// anything: the sign of the enclosed volume.
int orientation_of(const MatX3& points, const std::vector<Torus>& tori) {
  constexpr double hardly = 1e-3;  // of area^(3/2); a sphere has 0.09
  const VecX areas = areas_of(tori);
  const Eigen::RowVector3d centre = points.colwise().mean();
  double volume = 0;
  for (std::size_t i = 0; i < tori.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    volume += areas[row] * (points.row(row) - centre).dot(tori[i].n) / 3;
  }
  const double least = hardly * std::pow(areas.sum(), 1.5);
  return volume > least ? 1 : volume < -least ? -1 : 0;
}

template <class T>
T ask(const MatX3& points, const std::vector<Torus>& tori, const PointTree& tree,
      const WindingNumber& winding, int orientation, const Vec3& x,
      const Eigen::Matrix<T, 3, 1>& at) {
  std::array<Neighbour, blended> found;
  const int n = tree.nearest(x, blended, found.data());
  Side side;
  const T phi = blend<T>(points, tori, found.data(), n, at, side);
  if (!side.disputed && !(side.far && orientation != 0)) return phi;
  const bool inward = orientation < 0;  // then what is enclosed is positive
  const double enclosed = winding(x, side_accuracy) * (inward ? -1 : 1);
  bool negative = phi < 0.0;
  if (side.disputed) {
    negative = (enclosed > 0.5) != inward;
  } else if (enclosed < certain) {
    negative = inward;
  } else if (enclosed > 1 - certain) {
    negative = !inward;
  }
  if (!side.disputed && negative == (phi < 0.0)) return phi;
  side.known = negative ? -1 : 1;
  return blend<T>(points, tori, found.data(), n, at, side);
}

}  // namespace

Tori::Tori(const OrientedPoints& cloud, const TorusFit& fit, const Task& task, Report& report)
    : Tori([&] {
        Fitted all = fitted(cloud, fit, task, report);
        return Tori(std::move(all.points), std::move(all.tori));
      }()) {}

Tori::Tori(MatX3 points, std::vector<Torus> tori)
    : points_(std::move(points)),
      tori_(std::move(tori)),
      tree_(points_),
      winding_(points_, normals_of(tori_), areas_of(tori_)),
      orientation_(orientation_of(points_, tori_)) {
  if (points_.rows() == 0 || static_cast<std::size_t>(points_.rows()) != tori_.size())
    throw InputError("tori need one point each, and at least one");
}

double Tori::value(const Vec3& x) const {
  return ask<double>(points_, tori_, tree_, winding_, orientation_, x, x);
}

DistanceSample Tori::at(const Vec3& x) const {
  using Dual = Eigen::AutoDiffScalar<Vec3>;
  Eigen::Matrix<Dual, 3, 1> place;
  for (int d = 0; d < 3; ++d) place[d] = Dual(x[d], 3, d);
  const Dual phi = ask<Dual>(points_, tori_, tree_, winding_, orientation_, x, place);
  return {phi.value(), phi.derivatives()};
}

}  // namespace littoral
