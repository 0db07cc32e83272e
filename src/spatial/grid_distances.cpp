// Distances from triangles at the nodes of a grid: TriangleBvh::distances.

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"
#include "spatial/nearest_kernels.h"
#include "spatial/prepared_triangles.h"
#include "spatial/triangle_bvh.h"

namespace littoral {

namespace {

constexpr int root_side = 32;       // of the blocks that threads take, in nodes
constexpr int leaf_nodes = 64;      // at most, of blocks whose triangles are all looked at
constexpr int few_triangles = 12;   // are looked at without dividing the block further
constexpr int nodes_at_once = 8;    // are not divided further
constexpr int most_per_node = 100;  // triangles; beyond, nodes ask the tree one by one
constexpr double near_enough = 32;  // in sizes of the triangles: single precision tells them apart

/// Triangles in groups of eight, with their numbers in the tree, and balls about the groups, again
/// eight together.
struct Candidates {
  std::vector<CornerLanes> groups;
  std::vector<BallLanes> balls;
  std::vector<int> number;
  int n = 0;

  int n_groups() const { return (n + nearest_lanes - 1) / nearest_lanes; }
  int n_balls() const { return (n_groups() + nearest_lanes - 1) / nearest_lanes; }
  /// Empty, with room.
  void start(int most) {
    n = 0;
    if (most <= int_size(number)) return;
    number.resize(2 * most);
    groups.resize(number.size() / nearest_lanes + 1);
  }
  void add(int triangle, const CornerLanes& from, int lane) {
    CornerLanes& group = groups[n / nearest_lanes];
    const int to = n % nearest_lanes;
    const auto copy = [&]<std::size_t... c>(std::index_sequence<c...>) {
      ((group.corner[c][to] = from.corner[c][lane]), ...);
    };
    copy(std::make_index_sequence<9>());  // no loop: compilers leave one
    number[n++] = triangle;
  }
  void add_number(int triangle) { number[n++] = triangle; }
  /// Fills the last group by its last triangle, and makes the balls.
  void finish() {
    for (int at = n; at % nearest_lanes != 0; ++at)
      for (auto& c : groups[at / nearest_lanes].corner)
        c[at % nearest_lanes] = c[(n - 1) % nearest_lanes];
    if (n_balls() > int_size(balls)) balls.resize(n_balls());
    for (int g = 0; g < n_groups(); ++g)
      nearest_kernels().put_ball(groups[g], balls[g / nearest_lanes], g % nearest_lanes);
  }
};

/// Nodes first <= i < last along each axis.
struct Block {
  std::array<int, 3> first, last;
  int n_nodes() const { return (last[0] - first[0]) * (last[1] - first[1]) * (last[2] - first[2]); }
};

}  // namespace

/// One thread's way down through blocks of blocks of nodes.
///
/// A triangle R is at most as far from a point of a box as a mean of its distances to the box's
/// corners: distance to a convex set is a convex function. So what is nearest to some point of the
/// box meets the convex hull of the balls about the corners that just reach R (Pujol and Chica,
/// "Influence supersets", 2023). Every block keeps those of its parent's triangles that do, first
/// with the R of the block before for eight triangles at once, then with R the one nearest to its
/// centre.
class TriangleBvh::BlockSearch {
 public:
  BlockSearch(const TriangleBvh& tree, const Grid& grid, const Candidates& all,
              const NodeValue* value, double* values)
      : tree_(tree), grid_(grid), all_(all), value_(value), values_(values) {}

  void visit(const Block& block) {
    reference_ = 0;  // whatever was before: the same way down on any number of threads
    descend(block, all_, 0);
  }

 private:
  Vec3 place(int i, int j, int k) const {
    return (tree_.to_tree(grid_.point(i, j, k)) - tree_.centre_) / tree_.unit_;
  }
  std::array<Vec3, 3> corners(int stored) const {
    std::array<Vec3, 3> out;
    for (std::size_t k = 0; k < 3; ++k)
      out[k] = (tree_.corners_[stored][k] - tree_.centre_) / tree_.unit_;
    return out;
  }

  void descend(const Block& block, const Candidates& from, std::size_t depth) {
    const int nodes = block.n_nodes();
    if (from.n > static_cast<double>(most_per_node) * nodes) {
      ask_tree(block);
      return;
    }
    if (levels_.size() <= depth) levels_.emplace_back(std::make_unique<Candidates>());
    Candidates& kept = *levels_[depth];
    if (!select(block, from, kept)) {
      ask_tree(block);
      return;
    }
    if (nodes <= nodes_at_once || (nodes <= leaf_nodes && kept.n <= few_triangles)) {
      look_at_all(block, kept);
      return;
    }
    kept.finish();
    // Halves at multiples of a power of two, so that all but the last blocks are cubes.
    const int half = root_side >> (depth + 1);
    std::array<int, 3> at;
    for (at[2] = block.first[2]; at[2] < block.last[2]; at[2] += half)
      for (at[1] = block.first[1]; at[1] < block.last[1]; at[1] += half)
        for (at[0] = block.first[0]; at[0] < block.last[0]; at[0] += half) {
          Block child{at, at};
          for (std::size_t a = 0; a < 3; ++a) child.last[a] = std::min(at[a] + half, block.last[a]);
          descend(child, kept, depth + 1);
        }
  }

  /// Those of `from` that may be nearest to a node of the block, without `finish`, of small blocks
  /// their numbers only; false where single precision does not tell.
  bool select(const Block& block, const Candidates& from, Candidates& kept) {
    const bool is_leaf = block.n_nodes() <= nodes_at_once;
    const auto& [first, last] = block;
    const Vec3 low = place(first[0], first[1], first[2]),
               high = place(last[0] - 1, last[1] - 1, last[2] - 1);
    const Vec3 centre = (low + high) / 2, half = (high - low) / 2;
    if (!(low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff() <= near_enough)) return false;
    BoxWithBalls box;
    for (std::size_t a = 0; a < 3; ++a) {
      box.centre[a] = static_cast<float>(centre[index(a)]);
      box.half[a] = static_cast<float>(half[index(a)]);
    }
    // The rounding of coordinates, of the way, and of the box.
    box.slack = static_cast<float>(2e-6 * (2 + centre.cwiseAbs().sum() + half.sum()));

    set_radii(centre, half, box);
    near_.clear();
    float least = std::numeric_limits<float>::infinity();
    int nearest = -1;
    for (int b = 0; b < from.n_balls(); ++b) {
      unsigned far = 0, met = kernels_.balls_within(from.balls[b], box, far);
      for (; met != 0; met &= met - 1) {
        const int lane = std::countr_zero(met), g = b * nearest_lanes + lane;
        if (g >= from.n_groups()) break;
        if (near_.size() == ways_.size()) ways_.emplace_back();
        WayLanes& ways = ways_[near_.size()];
        near_.push_back(g);
        const auto find_ways = (far >> lane & 1) != 0 ? kernels_.ways_to_middles : kernels_.ways;
        if (!(find_ways(from.groups[g], box.centre.data(), ways) < least)) continue;
        const auto shortest = std::min_element(ways.squared.begin(), ways.squared.end());
        least = *shortest;
        nearest = std::min(g * nearest_lanes + static_cast<int>(shortest - ways.squared.begin()),
                           from.n - 1);
      }
    }
    if (nearest < 0) return false;
    if (reference_ != from.number[nearest]) {
      reference_ = from.number[nearest];
      set_radii(centre, half, box);
    }
    kept.start(int_size(near_) * nearest_lanes);
    for (std::size_t i = 0; i < near_.size(); ++i) {
      const int g = near_[i];
      unsigned met = kernels_.within(from.groups[g], ways_[i], box);
      if (g + 1 == from.n_groups()) met &= (1u << (from.n - g * nearest_lanes)) - 1;
      for (; met != 0; met &= met - 1) {
        const int l = std::countr_zero(met), triangle = from.number[g * nearest_lanes + l];
        if (is_leaf)
          kept.add_number(triangle);
        else
          kept.add(triangle, from.groups[g], l);
      }
    }
    return kept.n > 0;
  }

  /// How far each corner of the box is from the reference.
  void set_radii(const Vec3& centre, const Vec3& half, BoxWithBalls& box) {
    for (int c = 0; c < 8; ++c) {
      x_[c] = centre[0] + (c & 1 ? half[0] : -half[0]);
      y_[c] = centre[1] + (c & 2 ? half[1] : -half[1]);
      z_[c] = centre[2] + (c & 4 ? half[2] : -half[2]);
    }
    look_at(reference_, start(8));
    for (int c = 0; c < 8; ++c) box.radius[c] = static_cast<float>(std::sqrt(squared_[c]));
  }

  /// The first n places, with nothing near them yet.
  NearNodes start(int n) {
    const int end = (n + nearest_lanes - 1) / nearest_lanes * nearest_lanes;
    for (int i = n; i < end; ++i) x_[i] = x_[0], y_[i] = y_[0], z_[i] = z_[0];
    std::fill_n(squared_.data(), end, infinity);
    return {x_.data(), y_.data(), z_.data(), end, squared_.data(), nearest_.data()};
  }
  const PreparedTriangle& prepared(int triangle) {
    return prepared_.get(triangle, [&](int stored) { return corners(stored); });
  }
  void look_at(int triangle, const NearNodes& nodes) {
    if (const PreparedTriangle& seen = prepared(triangle); seen.plane) {
      kernels_.look(seen.exact, triangle, nodes);
      return;
    }
    const auto at = corners(triangle);
    for (int i = 0; i < nodes.n; ++i) {
      const Vec3 x(nodes.x[i], nodes.y[i], nodes.z[i]);
      const double found = closest_on_triangle(at[0] - x, at[1] - x, at[2] - x).squared;
      if (!(found < nodes.squared[i])) continue;
      nodes.squared[i] = found;
      nodes.nearest[i] = triangle;
    }
  }

  void look_at_all(const Block& block, const Candidates& kept) {
    int n = 0;
    for_nodes(block, [&](int i, int j, int k) {
      const Vec3 x = place(i, j, k);
      x_[n] = x[0], y_[n] = x[1], z_[n] = x[2];
      ++n;
    });
    const NearNodes nodes = start(n);
    for (int from = 0; from < n; from += nearest_lanes)
      look_at_eight(kept, {nodes.x + from, nodes.y + from, nodes.z + from, nearest_lanes,
                           nodes.squared + from, nodes.nearest + from});
    n = 0;
    for_nodes(block, [&](int i, int j, int k) {
      const Vec3 x = grid_.point(i, j, k);
      const int triangle = static_cast<int>(nearest_[n++]);
      values_[grid_.node(i, j, k)] =
          value_ ? (*value_)(x, tree_.nearest_on(triangle, x)) : tree_.distance_to(triangle, x);
    });
  }

  /// Single precision leaves few triangles that double precision is needed for.
  void look_at_eight(const Candidates& kept, const NearNodes& nodes) {
    PlaceLanes places;
    double farthest = 0;
    for (int l = 0; l < nearest_lanes; ++l) {
      places.x[l] = static_cast<float>(nodes.x[l]);
      places.y[l] = static_cast<float>(nodes.y[l]);
      places.z[l] = static_cast<float>(nodes.z[l]);
      farthest =
          std::max(farthest, std::abs(nodes.x[l]) + std::abs(nodes.y[l]) + std::abs(nodes.z[l]));
    }
    prepared_.next_turn();
    rough_.clear();
    may_be_.assign(kept.n, true);
    for (int c = 0; c < kept.n; ++c) {
      const int triangle = kept.number[c];
      if (!prepared_.free(triangle)) continue;  // two want one slot
      const PreparedTriangle& seen = prepared(triangle);
      if (seen.plane) rough_.push_back({&seen.rough, &may_be_[c]});
    }
    room_.resize(std::max(room_.size(), rough_.size() * nearest_lanes));
    // The rounding of coordinates, of the way there, and as much for the nearest one.
    kernels_.candidates(rough_.data(), int_size(rough_), places,
                        static_cast<float>(2e-6 * (2 + farthest)), room_.data());
    for (int c = 0; c < kept.n; ++c)
      if (may_be_[c]) look_at(kept.number[c], nodes);
  }

  void ask_tree(const Block& block) {
    int last = -1;
    for_nodes(block, [&](int i, int j, int k) {
      const Vec3 x = grid_.point(i, j, k);
      const NearestPoint foot = tree_.closest_point(x, last);
      last = foot.face;
      values_[grid_.node(i, j, k)] = value_ ? (*value_)(x, foot) : foot.distance;
    });
  }

  template <class Visit>
  static void for_nodes(const Block& block, const Visit& visit) {
    const auto& [first, last] = block;
    for (int k = first[2]; k < last[2]; ++k)
      for (int j = first[1]; j < last[1]; ++j)
        for (int i = first[0]; i < last[0]; ++i) visit(i, j, k);
  }

  const TriangleBvh& tree_;
  const Grid& grid_;
  const Candidates& all_;
  const NodeValue* value_;
  double* values_;
  const NearestKernels& kernels_ = nearest_kernels();
  std::vector<std::unique_ptr<Candidates>> levels_;
  std::vector<int> near_;       // groups in reach,
  std::vector<WayLanes> ways_;  // and what they see
  PreparedTriangles prepared_;
  std::vector<RoughTriangle> rough_;
  std::vector<char> may_be_;
  std::vector<float> room_;
  int reference_ = 0;
  std::array<double, leaf_nodes> x_{}, y_{}, z_{}, squared_{}, nearest_{};
};

VecX TriangleBvh::distances(const Grid& grid, const Task& task) const {
  return by_blocks(grid, nullptr, task);
}

VecX TriangleBvh::values_at_nodes(const Grid& grid, const NodeValue& value,
                                  const Task& task) const {
  return by_blocks(grid, &value, task);
}

VecX TriangleBvh::by_blocks(const Grid& grid, const NodeValue* value, const Task& task) const {
  VecX values(grid.n_nodes());
  Candidates all;
  if (corners_.size() <= std::size_t{most_per_node} * root_side * root_side * root_side) {
    all.start(int_size(corners_));
    CornerLanes one;
    for (int i = 0; i < int_size(corners_); ++i) {
      for (std::size_t c = 0; c < 9; ++c)
        one.corner[c][0] =
            static_cast<float>((corners_[i][c / 3][index(c % 3)] - centre_[index(c % 3)]) / unit_);
      all.add(i, one, 0);
    }
    all.finish();
  } else {
    all.n = int_size(corners_);  // too many: every block asks the tree
  }
  std::array<int, 3> blocks;
  for (std::size_t a = 0; a < 3; ++a) blocks[a] = (grid.n[a] + root_side - 1) / root_side;
  const std::size_t n = std::size_t(blocks[0]) * blocks[1] * blocks[2];
  std::mutex mutex;
  std::vector<std::unique_ptr<BlockSearch>> idle;  // with the room they have
  parallel_for(n, 1, [&](std::size_t at, std::size_t) {
    task.checkpoint(static_cast<double>(at) / static_cast<double>(n));
    Block block;
    std::size_t rest = at;
    for (std::size_t a = 0; a < 3; ++a) {
      block.first[a] = static_cast<int>(rest % blocks[a]) * root_side;
      block.last[a] = std::min(block.first[a] + root_side, grid.n[a]);
      rest /= blocks[a];
    }
    std::unique_ptr<BlockSearch> search;
    {
      const std::lock_guard lock(mutex);
      if (!idle.empty()) {
        search = std::move(idle.back());
        idle.pop_back();
      }
    }
    if (!search) search = std::make_unique<BlockSearch>(*this, grid, all, value, values.data());
    search->visit(block);
    const std::lock_guard lock(mutex);
    idle.push_back(std::move(search));
  });
  return values;
}

}  // namespace littoral
