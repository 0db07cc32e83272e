#include "spatial/winding_number.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

#include "base/index.h"
#include "spatial/boundary_edges.h"

namespace littoral {

namespace {

constexpr double four_pi = 4 * M_PI;
constexpr int leaf_size = winding_lanes;
constexpr int few_boundary_edges = 1500;    // beyond, the sum over clusters is mostly faster
constexpr int most_boundary_edges = 20000;  // beyond, surely
// What was measured on average.
constexpr double ns_an_edge = 1.2, ns_a_node = 12, ns_a_leaf = 28;
constexpr double far_away = 1e5;  // in units: what is there sees one vector area

using Triangle = std::array<Vec3, 3>;

/// The sum of the angles arg(den + i num). Their product adds them up without an arc tangent each;
/// whole turns are counted as they pass.
double sum_of_angles(const AngleLanes& angles) {
  double re_so_far = 1, im_so_far = 0;
  int turns = 0;
  for (std::size_t l = 0; l < winding_lanes; ++l) {
    const double num = angles.num[l], den = angles.den[l];
    if (num == 0 && den == 0) continue;  // the query lies within the triangle: no side
    const double re = re_so_far * den - im_so_far * num, im = re_so_far * num + im_so_far * den;
    if (im_so_far >= 0 && num >= 0 && im < 0) turns += 1;
    if (im_so_far < 0 && num < 0 && im >= 0) turns -= 1;
    re_so_far = re;
    im_so_far = im;
  }
  return std::atan2(im_so_far, re_so_far) + 2 * M_PI * turns;
}

/// Adds an item to the moments; `triangle` is null for points.
template <class Moments>
void add(Moments& m, const Vec3& centre, const Vec3& a, const Triangle* triangle) {
  const Vec3 d = centre - m.centre;
  Eigen::Matrix3d dd = d * d.transpose();  // mean of (x - centre)(x - centre)^T over the item
  if (triangle != nullptr) {
    // Over a triangle: (sum of the corners' products + 9 d d^T) / 12.
    dd *= 9;
    for (const Vec3& corner : *triangle) {
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
    m.first[p] += i == j ? a[i] * d[i] : a[i] * d[j] + a[j] * d[i];
  }
  m.second += 2 * (dd * a) + dd.trace() * a;
  // sum_ijk a_i dd_jk r_i r_j r_k by monomial: xxx yyy zzz xxy xxz yyx yyz zzx zzy xyz.
  auto& s = m.cubic;
  for (int i = 0; i < 3; ++i) s[i] += a[i] * dd(i, i);
  const int mixed[6][2] = {{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}};
  for (int p = 0; p < 6; ++p) {
    const auto [i, j] = mixed[p];
    s[3 + p] += a[j] * dd(i, i) + 2 * a[i] * dd(i, j);
  }
  s[9] += 2 * (a[0] * dd(1, 2) + a[1] * dd(0, 2) + a[2] * dd(0, 1));
}

}  // namespace

void WindingNumber::set_frame(const MatX3& points) {
  if (points.rows() == 0) return;
  const Vec3 low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  origin_ = low + (high - low) / 2;
  const double longest = (high - low).maxCoeff();
  if (longest > 0 && std::isfinite(longest)) unit_ = std::exp2(std::ceil(std::log2(longest)));
}

WindingNumber::WindingNumber(const MatX3& points, const MatX3i& faces) {
  std::vector<char> nothing;
  const auto chain = boundary_chain(points, faces, &nothing);
  std::vector<Triangle> triangles;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    Triangle t;
    bool counts = nothing[f] == 0;
    for (int k = 0; k < 3; ++k) {
      t[k] = points.row(faces(f, k));
      counts = counts && t[k].allFinite();
    }
    if (counts) triangles.push_back(t);
  }
  MatX3 centres(triangles.size(), 3), corners(3 * triangles.size(), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    centres.row(i) = a / 3 + b / 3 + c / 3;
    corners.middleRows(3 * i, 3) << a.transpose(), b.transpose(), c.transpose();
  }
  set_frame(corners);
  Items items;
  items.tree = cluster(centres, leaf_size);
  for (int i : items.tree.order) {
    Triangle t = triangles[i];
    for (Vec3& corner : t) corner = (corner - origin_) / unit_;
    items.triangles.push_back(t);
    items.centres.emplace_back((t[0] + t[1] + t[2]) / 3);
    items.areas.emplace_back((t[1] - t[0]).cross(t[2] - t[0]) / 2);
  }
  if (int_size(chain) > few_boundary_edges) {
    build(items);
    if (int_size(chain) > most_boundary_edges ||
        nanoseconds_of_clusters((corners.colwise().maxCoeff().transpose() - origin_) / unit_) <
            ns_an_edge * int_size(chain))
      return;
    root_ = none;
    nodes_ = {};
    triangle_leaves_ = {};
    total_.setZero();
  }
  exact_ = true;
  const auto local = [&](int v) { return Vec3((points.row(v).transpose() - origin_) / unit_); };
  std::vector<std::array<Vec3, 2>> boundary;
  boundary.reserve(chain.size());
  for (const auto& [a, b] : chain) boundary.push_back({local(a), local(b)});
  if (!chain.empty())
    for (const Vec3& a : items.areas) total_ += a;
  crossing_ = CrossingNumber(items.tree, items.triangles, boundary);
}

WindingNumber::WindingNumber(const MatX3& points, const MatX3& normals, const VecX& areas) {
  set_frame(points);
  Items items;
  items.tree = cluster(points, leaf_size);
  for (int i : items.tree.order) {
    items.centres.emplace_back((points.row(i).transpose() - origin_) / unit_);
    items.areas.emplace_back(areas[i] / unit_ / unit_ * normals.row(i));
  }
  build(items);
}

void WindingNumber::build(const Items& items) {
  std::vector<Moments> moments;
  for (const Cluster& c : items.tree.clusters) {
    Moments m;
    m.centre.setZero();
    double weight = 0;
    for (int i = c.begin; i < c.end; ++i) {
      const std::size_t at = i;
      m.centre += items.centres[at] * items.areas[at].norm();
      weight += items.areas[at].norm();
    }
    if (weight > 0)
      m.centre /= weight;
    else if (c.begin < c.end)
      m.centre = items.centres[c.begin];
    for (int i = c.begin; i < c.end; ++i) {
      const std::size_t at = i;
      add(m, items.centres[at], items.areas[at],
          items.triangles.empty() ? nullptr : &items.triangles[at]);
    }
    moments.push_back(m);
  }
  total_ = moments.front().area;
  if (!items.centres.empty()) root_ = add_node(items, moments, 0);
}

int WindingNumber::add_leaf(const Items& items, const Cluster& cluster) {
  // Unused lanes repeat one point.
  const std::size_t begin = cluster.begin;
  const std::size_t count = cluster.end - cluster.begin;
  if (items.triangles.empty()) {
    DipoleLanes leaf;
    for (std::size_t l = 0; l < winding_lanes; ++l)
      for (std::size_t k = 0; k < 3; ++k) {
        leaf.at[k][l] = items.centres[begin + std::min(l, count - 1)][k];
        leaf.area[k][l] = l < count ? items.areas[begin + l][k] : 0;
      }
    dipole_leaves_.push_back(leaf);
    return int_size(dipole_leaves_) - 1;
  }
  TriangleLanes leaf;
  for (std::size_t l = 0; l < winding_lanes; ++l)
    for (std::size_t c = 0; c < 9; ++c) {
      const Triangle& t = items.triangles[begin + std::min(l, count - 1)];
      leaf.corner[c][l] = t[l < count ? c / 3 : 0][c % 3];
    }
  triangle_leaves_.push_back(leaf);
  return int_size(triangle_leaves_) - 1;
}

int WindingNumber::add_node(const Items& items, const std::vector<Moments>& moments, int root) {
  const auto& clusters = items.tree.clusters;
  const std::vector<int> members = items.tree.opened(root, winding_lanes);
  const int at = nodes_.size();
  nodes_.emplace_back();
  Node node;
  node.moments = {};
  node.child.fill(none);
  for (std::size_t l = 0; l < winding_lanes; ++l) {
    if (l >= members.size()) {
      node.moments.x[l] = 1e9f;  // of no area: counts as far, and adds nothing
      continue;
    }
    const Moments& m = moments[members[l]];
    ClusterLanes& to = node.moments;
    const auto f = [](double x) { return static_cast<float>(x); };
    to.x[l] = f(m.centre[0]), to.y[l] = f(m.centre[1]), to.z[l] = f(m.centre[2]);
    to.radius[l] = f(m.radius);
    to.ax[l] = f(m.area[0]), to.ay[l] = f(m.area[1]), to.az[l] = f(m.area[2]);
    to.trace[l] = f(m.trace);
    to.sx[l] = f(m.second[0]), to.sy[l] = f(m.second[1]), to.sz[l] = f(m.second[2]);
    for (std::size_t k = 0; k < m.first.size(); ++k) to.first[k][l] = f(m.first[k]);
    for (std::size_t k = 0; k < m.cubic.size(); ++k) to.cubic[k][l] = f(m.cubic[k]);
    const Cluster& cluster = clusters[members[l]];
    node.child[l] =
        cluster.child < 0 ? -1 - add_leaf(items, cluster) : add_node(items, moments, members[l]);
  }
  nodes_[at] = node;
  return at;
}

double WindingNumber::leaf_sum(int leaf, const double* q) const {
  const WindingKernels& kernels = winding_kernels();
  if (triangle_leaves_.empty()) return kernels.dipoles(dipole_leaves_[leaf], q);
  AngleLanes angles;
  kernels.angles(triangle_leaves_[leaf], q, angles);
  return 2 * sum_of_angles(angles);
}

double WindingNumber::operator()(const Vec3& query, double accuracy) const {
  if (root_ == none && !exact_) return 0;
  const Vec3 q = (query - origin_) / unit_;
  const double distance = q.norm();
  if (!(distance < far_away)) {
    const double sum = -total_.dot(q / distance) / distance / distance / four_pi;
    return std::isfinite(sum) ? sum : 0;
  }
  if (exact_) return crossing_(q);
  return clustered_sum(q, accuracy);
}

double WindingNumber::clustered_sum(const Vec3& q, double accuracy, Work* work) const {
  const std::array<float, 3> near_q{static_cast<float>(q[0]), static_cast<float>(q[1]),
                                    static_cast<float>(q[2])};
  const WindingKernels& kernels = winding_kernels();
  const auto reach = static_cast<float>(std::min(accuracy, 1e15));
  std::array<int, 32 * winding_lanes> stack;  // a path is at most 32 nodes deep
  std::size_t top = 0;
  stack[top++] = root_;
  double sum = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    unsigned near = 0;
    if (work) ++work->nodes;
    sum += kernels.far(node.moments, near_q.data(), reach, near);
    for (; near != 0; near &= near - 1) {
      const int child = node.child[std::countr_zero(near)];
      if (child == none) continue;
      if (child >= 0) {
        stack[top++] = child;
      } else {
        sum += leaf_sum(-1 - child, q.data());
        if (work) ++work->leaves;
      }
    }
  }
  return sum / four_pi;
}

/// A query in a box a little larger than that of the surface, whose half is given: counted, not
/// timed, so that one mesh is summed in one way everywhere.
double WindingNumber::nanoseconds_of_clusters(const Vec3& half) const {
  constexpr int probes = 64;
  constexpr double accuracy = 2.3, beyond = 0.1;
  const Vec3 reach = half.array() + beyond * half.maxCoeff();
  Work work;
  for (int i = 0; i < probes; ++i) {
    const Vec3 even(0.8191725133961645 * i, 0.6710436067037893 * i, 0.5497004779019703 * i);
    const Vec3 inside = even - even.array().floor().matrix();
    clustered_sum((2 * inside - Vec3::Ones()).cwiseProduct(reach), accuracy, &work);
  }
  return (ns_a_node * work.nodes + ns_a_leaf * work.leaves) / probes;
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
