#include "methods/implicit/place_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <utility>

#include "base/index.h"
#include "base/kernel_choice.h"
#include "base/parallel.h"
#include "base/vector_lanes.h"

namespace littoral {

namespace {

constexpr int leaf_size = 16;                                // places
constexpr std::size_t least_piece = 4096, most_pieces = 16;  // of triangles

/// Places of a leaf as the direction sees them: it is the third axis.
struct LeafView {
  const double *x, *y, *z, *own;
};

struct TurnedTriangle {
  std::array<double, 3> x, y, z;
  double number;

  /// What side of the edge from one corner to another a line counts as that meets it: the one where
  /// it would be if it were moved by e along the first axis and by e^2 along the second.
  [[gnu::always_inline]] std::int64_t side_on_edge(std::size_t from, std::size_t to) const {
    return y[from] > y[to] || (y[from] == y[to] && x[to] > x[from]) ? -1 : 0;
  }
};
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// Beside every box.
constexpr TurnedTriangle nowhere{{nan, nan, nan}, {nan, nan, nan}, {nan, nan, nan}, -2};

/// Turns the bits of places that are before or behind the triangle. The side of an edge is the same
/// number, but for the sign, whichever end comes first.
template <int width>
[[gnu::always_inline]] inline void pass_lanes(const LeafView& leaf, const TurnedTriangle& t,
                                              unsigned char* bits) {
  using Lanes = typename Wide<width>::Lanes;
  using Bits = typename Wide<width>::Bits;
  for (int first = 0; first < leaf_size; first += width) {
    Lanes qx, qy, qz, own;
    load(qx, leaf.x + first);
    load(qy, leaf.y + first);
    load(qz, leaf.z + first);
    load(own, leaf.own + first);
    const Lanes ax = t.x[0] - qx, ay = t.y[0] - qy, bx = t.x[1] - qx, by = t.y[1] - qy,
                cx = t.x[2] - qx, cy = t.y[2] - qy;
    const Lanes a = bx * cy - by * cx, b = cx * ay - cy * ax, c = ax * by - ay * bx;
    Lanes least = a, most = a;
    take_smaller(least, b);
    take_smaller(least, c);
    take_larger(most, b);
    take_larger(most, c);
    Bits met = ((Bits)(least >= 0) | (Bits)(most <= 0)) & (Bits)(own != t.number);
    if (!any(met)) continue;
    const Bits on_a = Bits{} + t.side_on_edge(1, 2), on_b = Bits{} + t.side_on_edge(2, 0),
               on_c = Bits{} + t.side_on_edge(0, 1);
    const Bits of_a = (Bits)(a > 0) | ((Bits)(a == 0) & on_a),
               of_b = (Bits)(b > 0) | ((Bits)(b == 0) & on_b),
               of_c = (Bits)(c > 0) | ((Bits)(c == 0) & on_c);
    const Lanes area = a + b + c;
    met &= ~(of_a ^ of_b) & ~(of_b ^ of_c) & (Bits)(area != 0);
    const Lanes height = a * (t.z[0] - qz) + b * (t.z[1] - qz) + c * (t.z[2] - qz);
    const Bits after =
        ((Bits)(height > 0) & (Bits)(area > 0)) | ((Bits)(height < 0) & (Bits)(area < 0));
    const Bits turn = met & ((after & odd_after) | (~after & odd_before));
    for (int l = 0; l < width; ++l) bits[first + l] ^= static_cast<unsigned char>(turn[l]);
  }
}

struct PlaneBox {
  std::array<double, 2> low, high;
};

/// Whether a line through somewhere in the box may meet the triangle; no only where all are beyond
/// one edge by more than rounding.
bool may_meet(const TurnedTriangle& t, const PlaneBox& box) {
  const double mx = (box.low[0] + box.high[0]) / 2, my = (box.low[1] + box.high[1]) / 2,
               hx = (box.high[0] - box.low[0]) / 2, hy = (box.high[1] - box.low[1]) / 2;
  std::array<double, 3> x, y;
  for (std::size_t k = 0; k < 3; ++k) x[k] = t.x[k] - mx, y[k] = t.y[k] - my;
  bool above = true, below = true;  // somewhere, for all edges
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3;
    const double side = x[k] * y[l] - y[k] * x[l];
    const double reach = std::abs(x[l] - x[k]) * hy + std::abs(y[l] - y[k]) * hx;
    const double terms = (std::abs(x[k]) + hx) * (std::abs(y[l]) + hy) +
                         (std::abs(y[k]) + hy) * (std::abs(x[l]) + hx);
    const double most = reach + 1e-14 * terms;
    above = above && side >= -most;
    below = below && side <= most;
  }
  return above || below;
}

/// Boxes of the nodes over leaves [first, end): of a node, then of its left half, then of its
/// right.
struct PlaneTree {
  int n_leaves;
  std::vector<PlaneBox> boxes;

  static int middle(int first, int end) { return first + (end - first) / 2; }
  static int right_of(int node, int first, int end) {
    return node + 2 * (middle(first, end) - first);
  }

  PlaneTree(int leaves, const double* x, const double* y)
      : n_leaves(leaves), boxes(2 * leaves - 1) {
    fill(0, 0, leaves, x, y);
  }

  const PlaneBox& fill(int node, int first, int end, const double* x, const double* y) {
    PlaneBox& box = boxes[node];
    if (end - first == 1) {
      const auto from = first * leaf_size;
      const auto [low_x, high_x] = std::minmax_element(x + from, x + from + leaf_size);
      const auto [low_y, high_y] = std::minmax_element(y + from, y + from + leaf_size);
      return box = {{*low_x, *low_y}, {*high_x, *high_y}};
    }
    const int middle_leaf = middle(first, end);
    const PlaneBox &a = fill(node + 1, first, middle_leaf, x, y),
                   &b = fill(right_of(node, first, end), middle_leaf, end, x, y);
    for (std::size_t k = 0; k < 2; ++k) {
      box.low[k] = std::min(a.low[k], b.low[k]);
      box.high[k] = std::max(a.high[k], b.high[k]);
    }
    return box;
  }
};

[[gnu::always_inline]] inline std::pair<double, double> ends_of(const std::array<double, 3>& a) {
  return {std::min({a[0], a[1], a[2]}), std::max({a[0], a[1], a[2]})};
}

/// Places as the direction sees them, and their boxes.
struct PlaceView {
  const PlaneTree& tree;
  LeafView first;  // leaf

  LeafView leaf(int number) const {
    const std::size_t at = std::size_t(number) * leaf_size;
    return {first.x + at, first.y + at, first.z + at, first.own + at};
  }
};

/// Turns the bits of places for as many triangles as there are lanes, which go down the tree
/// together: neighbours in the list mostly lie beside each other.
template <int width>
[[gnu::always_inline]] inline void pass_group(const PlaceView& places, const TurnedTriangle* t,
                                              unsigned char* bits) {
  using Lanes = typename Wide<width>::Lanes;
  using Bits = typename Wide<width>::Bits;
  Lanes low_x, high_x, low_y, high_y;
  for (int l = 0; l < width; ++l) {
    const auto [x0, x1] = ends_of(t[l].x);
    const auto [y0, y1] = ends_of(t[l].y);
    low_x[l] = x0, high_x[l] = x1, low_y[l] = y0, high_y[l] = y1;
  }
  const Lanes extent = high_x - low_x + high_y - low_y;
  struct Entry {
    int node, first, end;
  };
  std::array<Entry, 64> stack;
  std::size_t size = 0;
  stack[size++] = {0, 0, places.tree.n_leaves};
  while (size > 0) {
    const auto [node, first, end] = stack[--size];
    const PlaneBox& box = places.tree.boxes[node];
    Bits over = (Bits)(low_x <= box.high[0]) & (Bits)(high_x >= box.low[0]) &
                (Bits)(low_y <= box.high[1]) & (Bits)(high_y >= box.low[1]);
    if (!any(over)) continue;
    // Small triangles in large boxes are told apart by their own boxes alone.
    const Bits large = over & (Bits)(extent > box.high[0] - box.low[0] + box.high[1] - box.low[1]);
    if (any(large)) {
      for (int l = 0; l < width; ++l)
        if (large[l] != 0 && !may_meet(t[l], box)) over[l] = 0;
      if (!any(over)) continue;
    }
    if (end - first == 1) {
      const LeafView leaf = places.leaf(first);
      for (int l = 0; l < width; ++l)
        if (over[l] != 0) pass_lanes<width>(leaf, t[l], bits + std::size_t(first) * leaf_size);
      continue;
    }
    const int middle_leaf = PlaneTree::middle(first, end);
    stack[size++] = {PlaneTree::right_of(node, first, end), middle_leaf, end};
    stack[size++] = {node + 1, first, middle_leaf};
  }
}

constexpr int most_lanes = 4;

/// Four triangles.
void pass_plain(const PlaceView& places, const TurnedTriangle* t, unsigned char* bits) {
  for (int l = 0; l < most_lanes; l += 2) pass_group<2>(places, t + l, bits);
}
#if defined(__x86_64__)
[[gnu::target("avx2")]] void pass_avx2(const PlaceView& places, const TurnedTriangle* t,
                                       unsigned char* bits) {
  pass_group<4>(places, t, bits);
}
#endif

}  // namespace

PlaceTree::PlaceTree(const std::vector<Place>& places)
    : n_leaves_((int_size(places) + leaf_size - 1) / leaf_size), order_(places.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (n_leaves_ > 0) divide(0, n_leaves_, places);
  order_.resize(std::size_t(n_leaves_) * leaf_size, order_.empty() ? 0 : order_.back());
  for (const int i : order_) {
    x_.push_back(places[i].x[0]);
    y_.push_back(places[i].x[1]);
    z_.push_back(places[i].x[2]);
    own_.push_back(places[i].face);
  }
}

/// Halves a range along the longest side of its box.
void PlaceTree::divide(int first_leaf, int end_leaf, const std::vector<Place>& places) {
  if (end_leaf - first_leaf == 1) return;
  const auto begin = order_.begin() + std::ptrdiff_t(first_leaf) * leaf_size,
             end = order_.begin() +
                   std::min(std::ptrdiff_t(end_leaf) * leaf_size, std::ssize(order_));
  Vec3 low = places[*begin].x, high = low;
  for (auto i = begin; i != end; ++i) {
    low = low.cwiseMin(places[*i].x);
    high = high.cwiseMax(places[*i].x);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int middle = PlaneTree::middle(first_leaf, end_leaf);
  std::nth_element(begin, order_.begin() + std::ptrdiff_t(middle) * leaf_size, end,
                   [&](int i, int j) {
                     const double a = places[i].x[axis], b = places[j].x[axis];
                     return a < b || (a == b && i < j);
                   });
  divide(first_leaf, middle, places);
  divide(middle, end_leaf, places);
}

std::vector<unsigned char> PlaceTree::parities(const MatX3& points, const MatX3i& faces,
                                               const Vec3& direction, const Task& task) const {
  const Vec3 u = direction.unitOrthogonal(), v = direction.cross(u);
  const auto along = [](const Vec3& axis, double x, double y, double z) {
    return axis[0] * x + axis[1] * y + axis[2] * z;
  };
  std::vector<double> x(x_.size()), y(x_.size()), z(x_.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = along(u, x_[i], y_[i], z_[i]);
    y[i] = along(v, x_[i], y_[i], z_[i]);
    z[i] = along(direction, x_[i], y_[i], z_[i]);
  }
  std::vector<unsigned char> out(
      order_.empty() ? 0 : 1 + *std::max_element(order_.begin(), order_.end()));
  if (out.empty()) return out;
  const PlaneTree tree(n_leaves_, x.data(), y.data());
  const PlaceView places{tree, {x.data(), y.data(), z.data(), own_.data()}};
#if defined(__x86_64__)
  const auto pass = LITTORAL_FASTEST(pass_plain, pass_avx2);
#else
  const auto pass = pass_plain;
#endif
  std::vector<unsigned char> sum(order_.size());
  std::mutex adding;
  const auto n = std::size_t(faces.rows());
  const std::size_t piece = std::max(least_piece, (n + most_pieces - 1) / most_pieces);
  parallel_for(n, piece, [&](std::size_t begin, std::size_t end) {
    std::vector<unsigned char> bits(order_.size());
    std::array<TurnedTriangle, most_lanes> group;
    for (std::size_t f = begin; f < end; f += most_lanes) {
      if ((f - begin) % 1024 == 0) task.checkpoint();
      for (std::size_t l = 0; l < most_lanes; ++l) {
        TurnedTriangle& t = group[l];
        if (f + l >= end) {
          t = nowhere;
          continue;
        }
        for (std::size_t k = 0; k < 3; ++k) {
          const auto p = points.row(faces(index(f + l), int(k)));
          t.x[k] = along(u, p[0], p[1], p[2]);
          t.y[k] = along(v, p[0], p[1], p[2]);
          t.z[k] = along(direction, p[0], p[1], p[2]);
        }
        t.number = static_cast<double>(f + l);
      }
      pass(places, group.data(), bits.data());
    }
    const std::lock_guard lock(adding);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] ^= bits[i];
  });
  for (std::size_t i = 0; i < order_.size(); ++i) out[order_[i]] = sum[i];
  return out;
}

}  // namespace littoral
