#include "methods/tori/tori.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/fetch_ahead.h"
#include "base/index.h"
#include "base/parallel.h"
#include "littoral/error.h"
#include "sources/space/likely_outliers.h"
#include "sources/space/oriented_points.h"

namespace littoral {

namespace {

constexpr int blended = blended_tori;
// Tori are believed on the side within this many spacings of the nearest point, or if no more than
// this share of the weight disagrees; farther than this many spacings only if the winding number
// does not say the contrary with this margin: patches of flipped normals agree among themselves.
constexpr double near_surface = 1.5, disagreement_tolerance = 0.02, far_away = 3,
                 winding_margin = 0.25;
// Errors of 0.01 do not matter.
constexpr double side_accuracy = WindingNumber::sign_accuracy;
// Points in groups: their normals are trusted if the winding number is clear by winding_margin on
// both sides of the group, this many spacings away, and their mean is at least `agreement` long;
// then on places that see the nearest point within this cosine of its normal.
constexpr int group = 16;
constexpr double probe = 2.5, agreement = 0.9, frontal = 0.7;

/// Do the tori need the winding number's word?
struct SideCheck {
  bool disputed, far;
  SideCheck(double nearest, double rho, double negative)
      : disputed(nearest > near_surface * rho && negative > disagreement_tolerance &&
                 negative < 1 - disagreement_tolerance),
        far(nearest > far_away * rho) {}
};

/// The surface passes near the nearest point: no farther than it, and not much nearer.
template <class T>
T clamp_to_nearest(const T& phi, const T& nearest, const T& rho) {
  const T least = nearest - rho;
  const T size = phi < 0.0 ? T(-phi) : phi;
  if (size > nearest) return phi < 0.0 ? T(-nearest) : nearest;
  if (size < least) return phi < 0.0 ? T(-least) : least;
  return phi;
}

template <class T>
struct Blend {
  T phi, rho, nearest;
  double negative;
};

/// Eq. 5.1 over the nearest tori. Weights fall to zero at the last of them, so that the value does
/// not jump when neighbours change. known: the side if not 0, as in BlendKernel.
template <class T>
Blend<T> blend(const MatX3& points, const std::vector<Torus>& tori, const std::vector<int>& order,
               const Neighbour* found, int n, const std::array<T, 3>& x, int known) {
  using std::exp;
  using std::sqrt;
  const auto point = [&](int j) { return order[found[j].point]; };
  const auto torus = [&](int j) -> const Torus& { return tori[point(j)]; };
  std::array<T, blended> d;
  d.fill(T(0.0));
  for (int j = 0; j < n; ++j) {
    T squared = T(torus_tiny<double>);
    for (int k = 0; k < 3; ++k) {
      const T y = x[k] - T(points(point(j), k));
      squared += y * y;
    }
    d[j] = sqrt(squared);
  }
  const T& nearest = d[0];
  const T& farthest = d[n - 1];
  T sum = T(0.0), total = T(0.0);
  for (int j = 0; j < n; ++j) {
    const T closeness = 1.0 - d[j] / farthest;
    const T w = closeness * closeness + 1e-9;
    sum += w * torus(j).rho;
    total += w;
  }
  const T rho = sum / total;
  const T last = exp(T(-blend_sharpness * (farthest - nearest) / rho));
  sum = T(0.0);
  total = T(0.0);
  T negative = T(0.0);  // weight of those that see x inside
  for (int j = 0; j < n; ++j) {
    const T decay = exp(T(-blend_sharpness * (d[j] - nearest) / rho));
    const T w = std::exp(torus(j).log_weight) * (decay - last) + blend_floor;
    T g = patch_distance<T>(torus(j), x);
    if (g < 0.0) negative += w;
    if (known != 0 && (g < 0.0) != (known < 0)) g = -g;
    sum += w * g;
    total += w;
  }
  const T share = negative / total;
  if constexpr (std::is_same_v<T, double>)
    return {sum / total, rho, nearest, share};
  else
    return {sum / total, rho, nearest, share.value};
}

/// One torus stands for about this area: 5 (hexagons) to 6 (random points) lie within rho of it.
VecX areas_of(const std::vector<Torus>& tori) {
  VecX areas(tori.size());
  for (std::size_t i = 0; i < tori.size(); ++i) {
    const double area = std::acos(-1.0) * tori[i].rho * tori[i].rho / 5.5;
    areas[i] = std::isfinite(area) ? area : 0;  // a lone point's plane
  }
  return areas;
}

MatX3 normals_of(const std::vector<Torus>& tori) {
  MatX3 normals(tori.size(), 3);
  for (std::size_t i = 0; i < tori.size(); ++i) normals.row(i) = tori[i].n;
  return normals;
}

/// 1 if normals point out of what the cloud encloses, -1 if into it, 0 if it encloses hardly
/// anything: the sign of the enclosed volume.
int orientation_of(const MatX3& points, const std::vector<Torus>& tori) {
  constexpr double hardly = 1e-3;  // of area^(3/2); a sphere has 0.09
  const VecX areas = areas_of(tori);
  const Eigen::RowVector3d centre = points.colwise().mean();
  double volume = 0;
  for (std::size_t i = 0; i < tori.size(); ++i) {
    const Eigen::Index row = i;
    volume += areas[row] * (points.row(row) - centre).dot(tori[i].n) / 3;
  }
  const double least = hardly * std::pow(areas.sum(), 1.5);
  return volume > least ? 1 : volume < -least ? -1 : 0;
}

/// The numbers of tori as the kernels read them, by place.
template <class S>
std::vector<TorusRecord<S>> records_of(const MatX3& points, const std::vector<Torus>& tori,
                                       const std::vector<int>& order) {
  const auto number = [](double x) {  // spacings of lone points are huge
    constexpr double most = std::numeric_limits<S>::max();
    return static_cast<S>(std::clamp(x, -most, most));
  };
  std::vector<TorusRecord<S>> records(tori.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Torus& t = tori[order[i]];
    TorusRecord<S>& r = records[i];
    for (int d = 0; d < 3; ++d) {
      r.p[d] = points(order[i], d);
      r.q[d] = number(t.q[d] - r.p[d]);
      r.n[d] = number(t.n[d]);
      r.e1[d] = number(t.e1[d]);
    }
    r.k1 = number(t.k1);
    r.k2 = number(t.k2);
    r.rho = number(t.rho);
    r.weight = number(std::exp(t.log_weight));
  }
  return records;
}

/// The tori of neighbours as a place sees them.
template <class S>
void gather(const std::vector<TorusRecord<S>>& records, const Neighbour* found, int n,
            const Vec3& x, TorusLanes<S>& lanes) {
  for (int l = 0; l < torus_lanes; ++l) {
    const Neighbour& neighbour = found[l < n ? l : 0];
    const TorusRecord<S>& r = records[neighbour.point];
    for (int d = 0; d < 3; ++d) {
      lanes.x[d][l] = static_cast<S>(x[d] - r.p[d]) - r.q[d];
      lanes.n[d][l] = r.n[d];
      lanes.e1[d][l] = r.e1[d];
    }
    lanes.k1[l] = r.k1;
    lanes.k2[l] = r.k2;
    lanes.rho[l] = r.rho;
    lanes.weight[l] = r.weight;
    lanes.squared[l] = static_cast<S>(neighbour.squared_distance);
    lanes.excess[l] = static_cast<S>(neighbour.squared_distance - found[0].squared_distance);
    lanes.used[l] = l < n ? S(1) : S(0);
  }
}

/// The place from the points of neighbours.
template <class S>
void gather_away(const std::vector<TorusRecord<S>>& records, const Neighbour* found, int n,
                 const Vec3& x, TorusAway<S>& away) {
  for (int l = 0; l < torus_lanes; ++l)
    for (int d = 0; d < 3; ++d)
      away.x[d][l] = static_cast<S>(x[d] - records[found[l < n ? l : 0].point].p[d]);
}

ToriDistance fitted(const OrientedPoints& cloud, const TorusFit& fit, const Task& task,
                    Report& report, ToriOutliers outliers, auto make) {
  OrientedPoints used = distinct_points(cloud, report);
  if (outliers == ToriOutliers::drop) used = without_outliers(used, task, report);
  task.checkpoint();
  PointTree tree(used.points);
  std::vector<Torus> tori = fit_tori(used, tree, fit, task);
  return make(std::move(used.points), std::move(tori), std::move(tree));
}

}  // namespace

ToriDistance::ToriDistance(const OrientedPoints& cloud, const TorusFit& fit, const Task& task,
                           Report& report, ToriPrecision precision, ToriOutliers outliers)
    : ToriDistance(fitted(
          cloud, fit, task, report, outliers, [&](MatX3 p, std::vector<Torus> t, PointTree tree) {
            return ToriDistance(std::move(p), std::move(t), std::move(tree), precision);
          })) {}

ToriDistance::ToriDistance(MatX3 points, std::vector<Torus> tori, ToriPrecision precision)
    : ToriDistance(points, std::move(tori), PointTree(points), precision) {}

ToriDistance::ToriDistance(MatX3 points, std::vector<Torus> tori, PointTree tree,
                           ToriPrecision precision)
    : points_(std::move(points)),
      tori_(std::move(tori)),
      tree_(std::move(tree)),
      order_(tree_.renumber()),
      winding_(points_, normals_of(tori_), areas_of(tori_)),
      orientation_(orientation_of(points_, tori_)) {
  if (points_.rows() == 0 || points_.rows() != index(tori_.size()))
    throw InputError("tori need one point each, and at least one");
  if (precision == ToriPrecision::single)
    single_ = records_of<float>(points_, tori_, order_);
  else
    records_ = records_of<double>(points_, tori_, order_);
  find_trusted();
}

void ToriDistance::find_trusted() {
  const std::size_t n = tori_.size();
  trusted_.assign((n + group - 1) / group, 0);
  if (orientation_ == 0) return;
  parallel_for(trusted_.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      const std::size_t from = g * group, to = std::min(n, from + group);
      Vec3 centre = Vec3::Zero(), normal = Vec3::Zero();
      double rho = 0;
      for (std::size_t i = from; i < to; ++i) {
        const Torus& t = tori_[order_[i]];
        centre += points_.row(order_[i]);
        normal += t.n;
        rho += t.rho;
      }
      const auto members = static_cast<double>(to - from);
      centre /= members;
      const double length = normal.norm();
      if (!(length > agreement * members)) continue;
      const Vec3 away = probe * rho / members / length * normal;
      if (!away.allFinite()) continue;
      const double outside = orientation_ * winding_(centre + orientation_ * away, side_accuracy);
      const double inside = orientation_ * winding_(centre - orientation_ * away, side_accuracy);
      trusted_[g] = outside < winding_margin && inside > 1 - winding_margin ? 1 : 0;
    }
  });
}

/// The ball around x up to the nearest point is empty, so that x is on the side that this point's
/// normal says, if it is seen from the front.
bool ToriDistance::trusted(const Neighbour& nearest, const Vec3& x, bool negative) const {
  const std::size_t place = nearest.point;
  if (trusted_[place / group] == 0) return false;
  const int point = order_[place];
  const double height = (x - points_.row(point).transpose()).dot(tori_[point].n);
  return height * height > frontal * frontal * nearest.squared_distance && (height < 0) == negative;
}

int ToriDistance::side_of(const Vec3& x, bool negative, bool disputed) const {
  const bool inward = orientation_ < 0;  // then what is enclosed is positive
  const double enclosed = winding_(x, side_accuracy) * (inward ? -1 : 1);
  if (disputed)
    negative = (enclosed > 0.5) != inward;
  else if (enclosed < winding_margin)
    negative = inward;
  else if (enclosed > 1 - winding_margin)
    negative = !inward;
  return negative ? -1 : 1;
}

template <class T, class S>
T ToriDistance::blended(const std::vector<TorusRecord<S>>& records, const Vec3& x) const {
  constexpr bool sloped = !std::is_same_v<T, double>;
  std::array<Neighbour, littoral::blended> found;
  const int n = tree_.nearest(x, littoral::blended, found.data(), [&](int place) {
    const char* const bytes = reinterpret_cast<const char*>(&records[place]);
    for (std::size_t line = 0; line < sizeof records[place]; line += 64) fetch_ahead(bytes + line);
  });
  TorusLanes<S> lanes;
  gather(records, found.data(), n, x, lanes);
  BlendedTori<S, std::conditional_t<sloped, Slope<S>, S>> out;
  TorusAway<S> away;
  T nearest = std::sqrt(found[0].squared_distance);
  if constexpr (sloped) {
    gather_away(records, found.data(), n, x, away);
    const double* const p = records[found[0].point].p;
    const double over = 1 / std::max(nearest.value, torus_tiny<double>);
    nearest = {nearest.value, over * (x[0] - p[0]), over * (x[1] - p[1]), over * (x[2] - p[2])};
  }
  const auto ask = [&](int known) {
    if constexpr (sloped)
      slope_kernel<S>()(lanes, away, n, known, out);
    else
      blend_kernel<S>()(lanes, n, known, out);
  };
  ask(0);
  const SideCheck check(out.nearest, value_of(out.rho), out.negative);
  const bool negative = value_of(out.phi) < 0;
  if (check.disputed || (check.far && orientation_ != 0 && !trusted(found[0], x, negative))) {
    const int side = side_of(x, negative, check.disputed);
    if (check.disputed || (side < 0) != negative) ask(side);
  }
  return clamp_to_nearest<T>(T(out.phi), nearest, T(out.rho));
}

template <class T>
T ToriDistance::plain(const Vec3& x, const std::array<T, 3>& at) const {
  std::array<Neighbour, littoral::blended> found;
  const int n = tree_.nearest(x, littoral::blended, found.data());
  const auto ask = [&](int known) {
    return blend<T>(points_, tori_, order_, found.data(), n, at, known);
  };
  const auto number = [](const T& v) {
    if constexpr (std::is_same_v<T, double>)
      return v;
    else
      return v.value;
  };
  Blend<T> out = ask(0);
  const SideCheck check(number(out.nearest), number(out.rho), out.negative);
  if (check.disputed || (check.far && orientation_ != 0)) {
    const bool negative = number(out.phi) < 0;
    const int side = side_of(x, negative, check.disputed);
    if (check.disputed || (side < 0) != negative) out = ask(side);
  }
  return clamp_to_nearest<T>(out.phi, out.nearest, out.rho);
}

double ToriDistance::value(const Vec3& x) const {
  return records_.empty() ? blended<double>(single_, x) : blended<double>(records_, x);
}

double ToriDistance::value_by_plain_sums(const Vec3& x) const {
  return plain<double>(x, {x[0], x[1], x[2]});
}

Jet ToriDistance::jet(const Vec3& x) const {
  return plain<Jet>(x, {Jet::coordinate(x, 0), Jet::coordinate(x, 1), Jet::coordinate(x, 2)});
}

DistanceSample ToriDistance::at(const Vec3& x) const {
  using Number = Slope<double>;
  const Number phi = records_.empty() ? blended<Number>(single_, x) : blended<Number>(records_, x);
  return {phi.value, phi.gradient()};
}

}  // namespace littoral
