#include "littoral/spatial/winding_number.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace littoral {

namespace {

constexpr double four_pi = 4 * M_PI;
constexpr int leaf_size = 8;

/// The solid angle of a triangle is 2 arg(den + i num). The product of these numbers adds up the
/// angles without an arc tangent each; whole turns are counted as they pass.
class AngleSum {
 public:
  void add(double num, double den) {
    const double re = re_ * den - im_ * num, im = re_ * num + im_ * den;
    if (im_ >= 0 && num >= 0 && im < 0) turns_ += 1;
    if (im_ < 0 && num < 0 && im >= 0) turns_ -= 1;
    const double size = std::abs(re) + std::abs(im);
    if (!(size > 0)) return;  // the query lies on the triangle's plane within it: no side
    re_ = re / size;
    im_ = im / size;
  }
  /// Sum of the angles, half of the solid angle.
  double value() const { return std::atan2(im_, re_) + 2 * M_PI * turns_; }

 private:
  double re_ = 1, im_ = 0;
  int turns_ = 0;
};

}  // namespace

WindingNumber::WindingNumber(const MatX3& points, const MatX3i& faces) {
  std::vector<Triangle> triangles;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    Triangle t;
    bool finite = true;
    for (int k = 0; k < 3; ++k) {
      t[static_cast<std::size_t>(k)] = points.row(faces(f, k));
      finite = finite && t[static_cast<std::size_t>(k)].allFinite();
    }
    if (finite) triangles.push_back(t);
  }
  MatX3 centres(static_cast<Eigen::Index>(triangles.size()), 3);
  std::vector<Vec3> areas;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    centres.row(static_cast<Eigen::Index>(i)) = (a + b + c) / 3;
    areas.emplace_back((b - a).cross(c - a) / 2);
  }
  tree_ = cluster(centres, leaf_size);
  for (int i : tree_.order) triangles_.push_back(triangles[static_cast<std::size_t>(i)]);
  build(centres, areas);
}

WindingNumber::WindingNumber(const MatX3& points, const MatX3& normals, const VecX& areas) {
  std::vector<Vec3> vector_areas;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    vector_areas.emplace_back(areas[i] * normals.row(i));
  tree_ = cluster(points, leaf_size);
  build(points, vector_areas);
}

void WindingNumber::build(const MatX3& centres, const std::vector<Vec3>& areas) {
  for (int i : tree_.order) {
    centres_.emplace_back(centres.row(i));
    areas_.push_back(areas[static_cast<std::size_t>(i)]);
  }
  for (const Cluster& c : tree_.clusters) {
    Moments m;
    m.centre.setZero();
    double weight = 0;
    for (int i = c.begin; i < c.end; ++i) {
      const auto at = static_cast<std::size_t>(i);
      m.centre += centres_[at] * areas_[at].norm();
      weight += areas_[at].norm();
    }
    if (weight > 0)
      m.centre /= weight;
    else if (c.begin < c.end)
      m.centre = centres_[static_cast<std::size_t>(c.begin)];
    for (int i = c.begin; i < c.end; ++i) add(m, static_cast<std::size_t>(i));
    moments_.push_back(m);
  }
}

void WindingNumber::add(Moments& m, std::size_t item) const {
  const Vec3& a = areas_[item];
  const Vec3 d = centres_[item] - m.centre;
  Eigen::Matrix3d dd = d * d.transpose();  // mean of (x - centre)(x - centre)^T over the item
  if (!triangles_.empty()) {
    // Over a triangle: (sum of the corners' products + 9 d d^T) / 12.
    dd *= 9;
    for (const Vec3& corner : triangles_[item]) {
      const Vec3 e = corner - m.centre;
      dd += e * e.transpose();
      m.radius = std::max(m.radius, e.norm());
    }
    dd /= 12;
  } else {
    m.radius = std::max(m.radius, d.norm());
  }
  m.area += a;
  m.trace += a.dot(d);
  const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
  for (int p = 0; p < 6; ++p) {
    const auto [i, j] = pair[p];
    m.first[static_cast<std::size_t>(p)] += i == j ? a[i] * d[i] : a[i] * d[j] + a[j] * d[i];
  }
  m.second += 2 * (dd * a) + dd.trace() * a;
  // sum_ijk a_i dd_jk r_i r_j r_k by monomial: xxx yyy zzz xxy xxz yyx yyz zzx zzy xyz.
  auto& s = m.cubic;
  for (int i = 0; i < 3; ++i) s[static_cast<std::size_t>(i)] += a[i] * dd(i, i);
  const int mixed[6][2] = {{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}};
  for (int p = 0; p < 6; ++p) {
    const auto [i, j] = mixed[p];
    s[static_cast<std::size_t>(3 + p)] += a[j] * dd(i, i) + 2 * a[i] * dd(i, j);
  }
  s[9] += 2 * (a[0] * dd(1, 2) + a[1] * dd(0, 2) + a[2] * dd(0, 1));
}

double WindingNumber::expand(const Moments& m, const Vec3& query) const {
  // g(c) = (c - q) / |c - q|^3 about the cluster's centre, r = centre - q:
  //   a.g = a.r/R^3 + [tr M - 3 r.M r/R^2]/R^3 + [-3/2 second.r + 15/2 cubic(r)/R^2]/R^5.
  const Vec3 r = m.centre - query;
  const double x = r[0], y = r[1], z = r[2];
  const double i2 = 1 / r.squaredNorm(), i3 = i2 * std::sqrt(i2);
  const auto& M = m.first;
  const double quadratic =
      M[0] * x * x + M[1] * y * y + M[2] * z * z + M[3] * x * y + M[4] * y * z + M[5] * z * x;
  const auto& s = m.cubic;
  const double cubic = x * (x * (s[0] * x + s[3] * y + s[4] * z) + s[9] * y * z) +
                       y * (y * (s[1] * y + s[5] * x + s[6] * z)) +
                       z * (z * (s[2] * z + s[7] * x + s[8] * y));
  return i3 * (m.area.dot(r) + m.trace - 3 * quadratic * i2 +
               i2 * (-1.5 * m.second.dot(r) + 7.5 * cubic * i2));
}

double WindingNumber::near_sum(int begin, int end, const Vec3& query) const {
  if (triangles_.empty()) {
    double sum = 0;
    for (int i = begin; i < end; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Vec3 r = centres_[at] - query;
      const double r2 = r.squaredNorm();
      if (r2 > 0) sum += areas_[at].dot(r) / (r2 * std::sqrt(r2));
    }
    return sum;
  }
  AngleSum angles;
  for (int i = begin; i < end; ++i) {
    const Triangle& t = triangles_[static_cast<std::size_t>(i)];
    const Vec3 a = t[0] - query, b = t[1] - query, c = t[2] - query;
    const double A = a.norm(), B = b.norm(), C = c.norm();
    angles.add(a.dot(b.cross(c)), A * B * C + a.dot(b) * C + b.dot(c) * A + c.dot(a) * B);
  }
  return 2 * angles.value();
}

double WindingNumber::operator()(const Vec3& query, double accuracy) const {
  std::array<int, 128> stack;  // medians: a path is at most 32 clusters deep
  int top = 0;
  stack[static_cast<std::size_t>(top++)] = 0;
  double sum = 0;
  while (top > 0) {
    const auto at = static_cast<std::size_t>(stack[static_cast<std::size_t>(--top)]);
    const Moments& m = moments_[at];
    const Cluster& c = tree_.clusters[at];
    const double reach = accuracy * m.radius;
    if ((m.centre - query).squaredNorm() > reach * reach) {
      sum += expand(m, query);
    } else if (c.child < 0) {
      sum += near_sum(c.begin, c.end, query);
    } else {
      stack[static_cast<std::size_t>(top++)] = c.child + 1;
      stack[static_cast<std::size_t>(top++)] = c.child;
    }
  }
  return sum / four_pi;
}

double winding_number_brute_force(const MatX3& points, const MatX3i& faces, const Vec3& query) {
  using Real = long double;
  using Triple = Eigen::Matrix<Real, 3, 1>;
  Real sum = 0;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    Triple t[3];
    for (int k = 0; k < 3; ++k) t[k] = (points.row(faces(f, k)).transpose() - query).cast<Real>();
    const Real A = t[0].norm(), B = t[1].norm(), C = t[2].norm();
    sum += 2 * std::atan2(t[0].dot(t[1].cross(t[2])),
                          A * B * C + t[0].dot(t[1]) * C + t[1].dot(t[2]) * A + t[2].dot(t[0]) * B);
  }
  return static_cast<double>(sum) / four_pi;
}

}  // namespace littoral
