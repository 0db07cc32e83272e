#include "spatial/triangle_bvh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>

#include "base/counted.h"
#include "base/index.h"
#include "base/parallel.h"
#include "base/stable_length.h"
#include "littoral/error.h"
#include "spatial/covered_triangles.h"

namespace littoral {

namespace {

constexpr int bins = 12;
constexpr int deepest_by_area = 48;  // below, splits by count: depth never exceeds 48 + 31
constexpr int stack_size = 8 * 80;
constexpr int finest_unit = -60;        // below the rounding of coordinates up to 1
constexpr int farthest_exponent = 200;  // squares of 2^200 are far from overflow

Vec3 scaled(const Vec3& v, int exponent) {
  if (std::abs(exponent) < 1000) {  // the power is a normal number: the same, faster
    const auto power = static_cast<std::uint64_t>(exponent + 1023) << 52;
    return std::bit_cast<double>(power) * v;
  }
  return {std::ldexp(v[0], exponent), std::ldexp(v[1], exponent), std::ldexp(v[2], exponent)};
}

int exponent_of(double magnitude) { return magnitude > 0 ? std::ilogb(magnitude) + 1 : 0; }

/// Half the area of a box's surface.
double half_area(const Vec3& low, const Vec3& high) {
  const Vec3 d = high - low;
  return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

/// Is a triangle (corners seen from the query) farther than the root of `best`, surely, by how far
/// it reaches towards the query along the way to its middle? Says so only where the rounding of a
/// computed foot cannot say otherwise.
bool surely_farther(const Vec3& a, const Vec3& b, const Vec3& c, double best) {
  constexpr double rounding = 1e-12;
  const Vec3 way = a + b + c;
  const double least = std::min({way.dot(a), way.dot(b), way.dot(c)});
  const double sum = a.cwiseAbs().sum() + b.cwiseAbs().sum() + c.cwiseAbs().sum();
  const double sure = least - rounding * sum * sum;
  return sure > 0 && sure * sure > best * way.squaredNorm();
}

}  // namespace

TriangleBvh::TriangleBvh(const MatX3& points, const MatX3i& faces) {
  double magnitude = 0;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    bool finite = true;
    double largest = 0;
    for (int k = 0; k < 3; ++k) {
      const int v = faces(f, k);
      if (v < 0 || v >= points.rows())
        throw InputError("face " + std::to_string(f) + " refers to vertex " + std::to_string(v) +
                             "; there are " + counted(points.rows(), "vertex", "vertices") +
                             ", counted from 0",
                         "no-such-element");
      finite = finite && points.row(v).allFinite();
      if (finite) largest = std::max(largest, points.row(v).cwiseAbs().maxCoeff());
    }
    if (!finite) continue;
    faces_.push_back(f);
    magnitude = std::max(magnitude, largest);
  }
  if (faces_.empty())
    throw InputError("closest points need a face with three finite corners; there is none among " +
                         counted(faces.rows(), "face", "faces"),
                     "not-finite");
  exponent_ = exponent_of(magnitude);
  std::vector<std::array<Vec3, 3>> corners;
  corners.reserve(faces_.size());
  for (int f : faces_) {
    std::array<Vec3, 3>& c = corners.emplace_back();
    for (int k = 0; k < 3; ++k) c[k] = scaled(points.row(faces(f, k)), -exponent_);
  }
  const std::vector<bool> covered = covered_triangles(corners);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (covered[i]) continue;
    corners[kept] = corners[i];
    faces_[kept++] = faces_[i];
  }
  corners.resize(kept);
  faces_.resize(kept);
  std::vector<Box> boxes;
  boxes.reserve(kept);
  for (const auto& c : corners)
    boxes.push_back({c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2])});
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  const std::vector<Split> splits = split(boxes, order);

  std::vector<int> sorted(faces_.size()), rows(3 * faces_.size());
  std::iota(rows.begin(), rows.end(), 0);
  MatX3 all(rows.size(), 3);  // corners in the order of the tree
  corners_.resize(corners.size());
  group_of_.assign(faces.rows(), -1);
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted[i] = faces_[order[i]];
    corners_[i] = corners[order[i]];
    for (std::size_t k = 0; k < 3; ++k) all.row(3 * i + k) = corners_[i][k];
  }
  faces_ = std::move(sorted);
  const Box& whole = splits.front().box;
  centre_ = 0.5 * (whole.low + whole.high);
  const double extent = (whole.high - whole.low).maxCoeff();
  if (extent > 0) unit_ = std::ldexp(1.0, std::max(exponent_of(extent), finest_unit));
  all = (all.rowwise() - centre_.transpose()) / unit_;
  std::vector<Lanes> ranges;
  add_node(splits, 0, ranges);
  for (int g = 0; g < int_size(groups_); ++g)
    for (int i = groups_[g].begin; i < groups_[g].end; ++i) group_of_[faces_[i]] = g;
  lanes_.resize(groups_.size());
  parallel_for(groups_.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g)
      for (int l = 0; l < nearest_lanes; ++l) {
        const int at = std::min(groups_[g].begin + l, groups_[g].end - 1);  // the last again
        for (int k = 0; k < 9; ++k)
          lanes_[g].corner[k][l] = static_cast<float>(all(3 * at + k / 3, k % 3));
      }
  });
  parallel_for(nodes_.size(), 64, [&](std::size_t begin, std::size_t end) {
    BoundNode node;
    for (std::size_t at = begin; at < end; ++at) {
      std::copy_n(nodes_[at].child, width, node.child);
      for (int c = 0; c < width; ++c) {
        const auto [from, to] = ranges[at][c];
        if (from == to)
          set_empty(node, c);
        else
          set_bounds(all, rows.data() + 3 * from, rows.data() + 3 * to, node, c);
      }
      set_small(node, nodes_[at]);
    }
  });
}

std::vector<TriangleBvh::Split> TriangleBvh::split(const std::vector<Box>& boxes,
                                                   std::vector<int>& order) {
  const int n = boxes.size();
  std::vector<Vec3> centre(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) centre[i] = 0.5 * (boxes[i].low + boxes[i].high);
  std::vector<Split> splits;
  struct Job {
    int node, begin, end, depth;
  };
  std::vector<Job> jobs{{0, 0, n, 0}};
  splits.reserve(2 * boxes.size());
  splits.resize(1);
  while (!jobs.empty()) {
    const Job job = jobs.back();
    jobs.pop_back();
    Box box = boxes[order[job.begin]];
    Box centres{centre[order[job.begin]], centre[order[job.begin]]};
    for (int i = job.begin; i < job.end; ++i) {
      box.low = box.low.cwiseMin(boxes[order[i]].low);
      box.high = box.high.cwiseMax(boxes[order[i]].high);
      centres.low = centres.low.cwiseMin(centre[order[i]]);
      centres.high = centres.high.cwiseMax(centre[order[i]]);
    }
    const int count = job.end - job.begin;
    splits[job.node] = {box, job.begin, job.end, -1};
    if (count <= nearest_lanes) continue;

    int axis = 0;
    const double extent = (centres.high - centres.low).maxCoeff(&axis);
    int middle = job.begin;
    if (extent > 0 && job.depth < deepest_by_area) {
      const double low = centres.low[axis];
      auto bin_of = [&](int i) {
        const double x = (centre[i][axis] - low) / extent;  // in [0, 1]
        return std::min(bins - 1, static_cast<int>(x * bins));
      };
      std::array<int, bins> number{};
      std::array<Box, bins> bin;
      bin.fill({Vec3::Constant(infinity), Vec3::Constant(-infinity)});
      for (int i = job.begin; i < job.end; ++i) {
        const int b = bin_of(order[i]);
        ++number[b];
        bin[b].low = bin[b].low.cwiseMin(boxes[order[i]].low);
        bin[b].high = bin[b].high.cwiseMax(boxes[order[i]].high);
      }
      // Cost of cutting after bin b: (triangles x area) on the left plus the same on the right.
      std::array<double, bins> left_cost{};
      auto sweep = [&](bool from_left) {
        Box sum{Vec3::Constant(infinity), Vec3::Constant(-infinity)};
        int total = 0;
        std::array<double, bins> cost{};
        for (int s = 0; s < bins; ++s) {
          const int b = from_left ? s : bins - 1 - s;
          total += number[b];
          sum.low = sum.low.cwiseMin(bin[b].low);
          sum.high = sum.high.cwiseMax(bin[b].high);
          cost[b] = total ? total * half_area(sum.low, sum.high) : infinity;
        }
        return cost;
      };
      left_cost = sweep(true);
      const std::array<double, bins> right_cost = sweep(false);
      int cut = -1;
      double cheapest = infinity;
      for (int b = 0; b + 1 < bins; ++b) {
        const double cost = left_cost[b] + right_cost[b + 1];
        if (cost < cheapest) {
          cheapest = cost;
          cut = b;
        }
      }
      if (cut >= 0)
        middle = std::stable_partition(order.begin() + job.begin, order.begin() + job.end,
                                       [&](int i) { return bin_of(i) <= cut; }) -
                 order.begin();
    }
    if (middle == job.begin || middle == job.end) {  // coincident centres, or too deep
      middle = job.begin + count / 2;
      std::nth_element(order.begin() + job.begin, order.begin() + middle, order.begin() + job.end,
                       [&](int i, int j) {
                         const double x = centre[i][axis], y = centre[j][axis];
                         return x < y || (x == y && i < j);
                       });
    }
    const int left = splits.size();
    splits[job.node].child = left;
    splits.resize(splits.size() + 2);
    jobs.push_back({left + 1, middle, job.end, job.depth + 1});
    jobs.push_back({left, job.begin, middle, job.depth + 1});
  }

  return splits;
}

int TriangleBvh::add_node(const std::vector<Split>& splits, int root, std::vector<Lanes>& ranges) {
  // The boxes of most triangles under the root are opened as long as there is room.
  std::vector<int> members{root};
  const auto size = [&](int at) {
    const Split& s = splits[at];
    return s.child < 0 ? 0 : s.end - s.begin;
  };
  while (members.size() < width) {
    const auto largest = std::max_element(members.begin(), members.end(),
                                          [&](int a, int b) { return size(a) < size(b); });
    const int child = splits[*largest].child;
    if (child < 0) break;
    *largest = child;
    members.push_back(child + 1);
  }
  const auto at = nodes_.size();
  nodes_.emplace_back();
  ranges.emplace_back();
  for (std::size_t c = 0; c < members.size(); ++c) {
    const Split& s = splits[members[c]];
    ranges[at][c] = {s.begin, s.end};
    if (s.child < 0) groups_.push_back({s.begin, s.end});
    const int child = s.child < 0 ? -int_size(groups_) : add_node(splits, members[c], ranges);
    nodes_[at].child[c] = child;
  }
  return at;
}

Vec3 TriangleBvh::to_tree(const Vec3& query) const { return scaled(query, -exponent_); }

double TriangleBvh::distance_to(int stored, const Vec3& query) const {
  const Vec3 q = to_tree(query);
  const auto& c = corners_[stored];
  return std::ldexp(stable_length(closest_on_triangle(c[0] - q, c[1] - q, c[2] - q).offset),
                    exponent_);
}

NearestPoint TriangleBvh::nearest_on(int stored, const Vec3& query) const {
  const Vec3 q = to_tree(query);
  const auto& c = corners_[stored];
  return point_of(stored, closest_on_triangle(c[0] - q, c[1] - q, c[2] - q), exponent_);
}

/// `exponent`: of the unit that the foot's offset is in.
NearestPoint TriangleBvh::point_of(int stored, const TriangleFoot& foot, int exponent) const {
  NearestPoint out;
  out.face = faces_[stored];
  out.barycentric = foot.barycentric;
  Vec3 point = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) point += foot.barycentric[k] * corners_[stored][k];
  out.point = scaled(point, exponent_);
  out.distance = std::min(std::ldexp(stable_length(foot.offset), exponent),
                          std::numeric_limits<double>::max());
  return out;
}

NearestPoint TriangleBvh::closest_point(const Vec3& query, int hint) const {
  if (!query.allFinite())
    throw InputError("the query point of a closest-point search is not finite", "not-finite");
  // `shift` is extra down-scaling for queries so far away that squares would overflow.
  const int query_exponent = exponent_of(query.cwiseAbs().maxCoeff());
  const int shift = std::max(0, query_exponent - exponent_ - farthest_exponent);
  const Vec3 q = scaled(query, -exponent_ - shift);

  double best = infinity;
  TriangleFoot best_foot;
  int best_at = -1;
  const auto look_at = [&](int i) {
    const auto& corner = corners_[i];
    const Vec3 a = corner[0] - q, b = corner[1] - q, c = corner[2] - q;
    if (surely_farther(a, b, c, best)) return;
    const TriangleFoot foot = closest_on_triangle(a, b, c);
    if (best_at < 0 || foot.squared < best ||
        (foot.squared == best && faces_[i] < faces_[best_at])) {
      best = foot.squared;
      best_foot = foot;
      best_at = i;
    }
  };

  // In the nodes' coordinates. Bounds hold for computed feet, too, so that leaving out what is
  // beyond `reach` never changes which of several equally near faces wins.
  const Vec3 local = (q - centre_) / unit_;
  const double per_unit = 1 / (unit_ * unit_);  // a power of two
  const bool near = local.cwiseAbs().maxCoeff() <= near_bound_kernel;
  SmallBoundKernel* const bounds = near ? small_bound_kernels().near : small_bound_kernels().far;
  const NearestKernels& kernels = nearest_kernels();
  const std::array<float, 3> from{static_cast<float>(local[0]), static_cast<float>(local[1]),
                                  static_cast<float>(local[2])};
  double reach = std::numeric_limits<double>::max();  // empty lanes are at infinity
  struct Candidate {
    float squared;
    int stored;
  };
  std::array<Candidate, 64> candidates;
  int n_candidates = 0;
  const auto look_at_candidates = [&] {
    std::sort(candidates.begin(), candidates.begin() + n_candidates,
              [](const Candidate& a, const Candidate& b) { return a.squared < b.squared; });
    for (int i = 0; i < n_candidates; ++i)
      if (candidates[i].squared <= std::min(reach, best * per_unit)) look_at(candidates[i].stored);
    n_candidates = 0;
    reach = std::min(reach, best * per_unit);
  };
  const auto look_at_group = [&](int g) {
    const Group& group = groups_[g];
    if (!near) {
      for (int i = group.begin; i < group.end; ++i) look_at(i);
      reach = std::min(reach, best * per_unit);
      return;
    }
    alignas(32) std::array<float, nearest_lanes> bound;
    float most = std::numeric_limits<float>::max();
    unsigned met = kernels.bounds(lanes_[g], from.data(), most, bound.data());
    reach = std::min<double>(reach, most);
    for (met &= (1u << (group.end - group.begin)) - 1; met != 0; met &= met - 1) {
      const int l = std::countr_zero(met);
      if (!(bound[l] <= reach)) continue;
      candidates[n_candidates++] = {bound[l], group.begin + l};
      if (n_candidates == int_size(candidates)) look_at_candidates();
    }
  };
  const int hinted = hint >= 0 && hint < int_size(group_of_) ? group_of_[hint] : -1;
  if (hinted >= 0) look_at_group(hinted);

  std::array<BoundEntry, stack_size> stack;  // a node adds at most eight
  int top = 0;
  stack[top++] = {0, 0};
  while (top > 0) {
    const BoundEntry entry = stack[--top];
    if (entry.squared > reach) continue;
    if (entry.child < 0) {
      if (const int g = -1 - entry.child; g != hinted) look_at_group(g);
      continue;
    }
    const SmallBoundNode& node = nodes_[entry.child];
    alignas(64) double bound[width];
    const unsigned met = bounds(node, local.data(), reach, bound);
    top = push_children(node.child, bound, met, stack.data(), top);
  }
  look_at_candidates();

  return point_of(best_at, best_foot, exponent_ + shift);
}

}  // namespace littoral
