#include "spatial/winding_number.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

#include "base/index.h"
#include "spatial/boundary_edges.h"

namespace littoral {

namespace {

constexpr int leaf_size = winding_lanes;
constexpr int few_boundary_edges = 1500;    // beyond, the sum over clusters is mostly faster
constexpr int most_boundary_edges = 20000;  // beyond, surely
// What was measured on average.
constexpr double ns_an_edge = 1.2, ns_a_node = 12, ns_a_leaf = 14;
constexpr double least_radius = 1e-6;  // in units, of a cluster
constexpr double far_away = 1e5;       // in units: what is there sees one vector area

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

/// Adds a triangle about a centre: six points and weights, exact for polynomials of degree four
/// (Strang and Fix), and so for all moments up to degree five.
void add_triangle(DipoleMoments& moments, const Triangle& t, const Vec3& area, const Vec3& centre) {
  static_assert(dipole_degree == 5);
  constexpr double weight[2] = {0.22338158967801146570, 0.10995174365532186764};
  constexpr double at[2] = {0.44594849091596488632, 0.09157621350977074346};
  const Vec3 sum = t[0] + t[1] + t[2] - 3 * centre;
  for (int k = 0; k < 2; ++k)
    for (const Vec3& corner : t)
      moments.add(at[k] * sum + (1 - 3 * at[k]) * (corner - centre), weight[k] * area);
}

}  // namespace

void WindingNumber::set_frame(const MatX3& points) {
  if (points.rows() == 0) return;
  const Vec3 low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  origin_ = low + (high - low) / 2;
  const double longest = (high - low).maxCoeff();
  if (longest > 0 && std::isfinite(longest)) unit_ = std::exp2(std::ceil(std::log2(longest)));
}

WindingNumber::WindingNumber(const MatX3& points, const MatX3i& faces, Queries queries) {
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
    build(items, queries);
    if (int_size(chain) > most_boundary_edges ||
        nanoseconds_of_clusters((corners.colwise().maxCoeff().transpose() - origin_) / unit_) <
            ns_an_edge * int_size(chain))
      return;
    root_ = none;
    nodes_ = {};
    clusters_ = {};
    triangle_leaves_ = {};
    narrow_leaves_ = {};
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

WindingNumber::WindingNumber(const MatX3& points, const MatX3& normals, const VecX& areas,
                             Queries queries) {
  set_frame(points);
  Items items;
  items.tree = cluster(points, leaf_size);
  for (int i : items.tree.order) {
    items.centres.emplace_back((points.row(i).transpose() - origin_) / unit_);
    items.areas.emplace_back(areas[i] / unit_ / unit_ * normals.row(i));
  }
  build(items, queries);
}

void WindingNumber::build(const Items& items, Queries queries) {
  if (items.centres.empty()) return;
  for (const Vec3& a : items.areas) total_ += a;
  const auto& clusters = items.tree.clusters;
  std::vector<Expansion> expansions(clusters.size());
  for (std::size_t at = clusters.size(); at-- > 0;) {  // children stand behind their parents
    const Cluster& cluster = clusters[at];
    Expansion& e = expansions[at];
    const auto each_point = [&](auto&& visit) {
      for (int i = cluster.begin; i < cluster.end; ++i)
        if (items.triangles.empty())
          visit(items.centres[i]);
        else
          for (const Vec3& corner : items.triangles[i]) visit(corner);
    };
    if (cluster.child < 0) {
      e.low.setConstant(infinity), e.high.setConstant(-infinity);
      each_point([&](const Vec3& x) { e.low = e.low.cwiseMin(x), e.high = e.high.cwiseMax(x); });
    } else {
      const Expansion &a = expansions[cluster.child], &b = expansions[cluster.child + 1];
      e.low = a.low.cwiseMin(b.low), e.high = a.high.cwiseMax(b.high);
    }
    e.centre = (e.low + e.high) / 2;
    double squared = 0;
    each_point([&](const Vec3& x) { squared = std::max(squared, (x - e.centre).squaredNorm()); });
    e.radius = std::max(std::sqrt(squared), least_radius);
    if (cluster.child >= 0) {
      for (int child : {cluster.child, cluster.child + 1})
        e.moments.add(expansions[child].moments, expansions[child].centre - e.centre);
      continue;
    }
    for (int i = cluster.begin; i < cluster.end; ++i)
      if (items.triangles.empty())
        e.moments.add(items.centres[i] - e.centre, items.areas[i]);
      else
        add_triangle(e.moments, items.triangles[i], items.areas[i], e.centre);
  }
  if (queries == Queries::together)
    for (std::size_t at = 0; at < clusters.size(); ++at)
      clusters_.push_back(expanded(expansions[at], clusters[at].child));
  root_ = add_node(items, expansions, 0);
}

GroupCluster WindingNumber::expanded(const Expansion& e, int child) {
  const auto f = [](double x) { return static_cast<float>(x); };
  GroupCluster to{f(e.centre[0]), f(e.centre[1]), f(e.centre[2]), f(e.radius), child, {}};
  const auto moments = e.moments.coefficients(e.radius);
  for (std::size_t k = 0; k < moments.size(); ++k) to.moments[k] = f(moments[k] / e.radius);
  return to;
}

int WindingNumber::add_leaf(const Items& items, const Cluster& cluster,
                            const Expansion& expansion) {
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
  NarrowTriangleLanes narrow;
  for (std::size_t k = 0; k < 3; ++k) narrow.centre[k] = expansion.centre[k];
  narrow.radius = static_cast<float>(expansion.radius);
  for (std::size_t l = 0; l < winding_lanes; ++l)
    for (std::size_t c = 0; c < 9; ++c) {
      const Triangle& t = items.triangles[begin + std::min(l, count - 1)];
      leaf.corner[c][l] = t[l < count ? c / 3 : 0][c % 3];
      narrow.corner[c][l] = static_cast<float>(leaf.corner[c][l] - narrow.centre[c % 3]);
    }
  triangle_leaves_.push_back(leaf);
  narrow_leaves_.push_back(narrow);
  return int_size(triangle_leaves_) - 1;
}

int WindingNumber::add_node(const Items& items, const std::vector<Expansion>& expansions,
                            int root) {
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
    const Expansion& e = expansions[members[l]];
    ClusterLanes& to = node.moments;
    const GroupCluster from = clusters_.empty() ? expanded(e, none) : clusters_[members[l]];
    to.x[l] = from.x, to.y[l] = from.y, to.z[l] = from.z, to.radius[l] = from.radius;
    for (std::size_t k = 0; k < from.moments.size(); ++k) to.moments[k][l] = from.moments[k];
    const Cluster& cluster = clusters[members[l]];
    node.child[l] = cluster.child < 0 ? -1 - add_leaf(items, cluster, e)
                                      : add_node(items, expansions, members[l]);
    if (cluster.child < 0 && !clusters_.empty()) clusters_[members[l]].child = node.child[l];
  }
  nodes_[at] = node;
  return at;
}

double WindingNumber::leaf_sum(int leaf, const double* q, bool exactly) const {
  const WindingKernels& kernels = winding_kernels();
  if (triangle_leaves_.empty()) return kernels.dipoles(dipole_leaves_[leaf], q);
  float sum = 0;
  if (!exactly && kernels.narrow_angles(narrow_leaves_[leaf], q, sum)) return 2 * sum;
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
  const auto share = static_cast<float>(1 / (accuracy * accuracy));
  const bool exactly = std::isinf(accuracy);
  std::array<int, 32 * winding_lanes> stack;  // a path is at most 32 nodes deep
  std::size_t top = 0;
  stack[top++] = root_;
  double sum = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    unsigned near = 0;
    if (work) ++work->nodes;
    sum += kernels.far(node.moments, near_q.data(), share, near);
    for (; near != 0; near &= near - 1) {
      const int child = node.child[std::countr_zero(near)];
      if (child == none) continue;
      if (child >= 0) {
        stack[top++] = child;
      } else {
        sum += leaf_sum(-1 - child, q.data(), exactly);
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
  constexpr double beyond = 0.1;
  const Vec3 reach = half.array() + beyond * half.maxCoeff();
  Work work;
  for (int i = 0; i < probes; ++i) {
    const Vec3 even(0.8191725133961645 * i, 0.6710436067037893 * i, 0.5497004779019703 * i);
    const Vec3 inside = even - even.array().floor().matrix();
    clustered_sum((2 * inside - Vec3::Ones()).cwiseProduct(reach), sign_accuracy, &work);
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
  return static_cast<double>(sum) / (4 * M_PI);
}

}  // namespace littoral
