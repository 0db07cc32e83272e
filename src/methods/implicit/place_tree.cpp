#include "methods/implicit/place_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>

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
};

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
    const Bits of_a = (Bits)(a >= 0), of_b = (Bits)(b >= 0), of_c = (Bits)(c >= 0);
    const Lanes area = a + b + c;
    const Bits met = ~(of_a ^ of_b) & ~(of_b ^ of_c) & (Bits)(own != t.number) & (Bits)(area != 0);
    std::int64_t any = 0;
    for (int l = 0; l < width; ++l) any |= met[l];
    if (any == 0) continue;
    const Lanes height = a * (t.z[0] - qz) + b * (t.z[1] - qz) + c * (t.z[2] - qz);
    const Bits after =
        ((Bits)(height > 0) & (Bits)(area > 0)) | ((Bits)(height < 0) & (Bits)(area < 0));
    const Bits turn = met & ((after & odd_after) | (~after & odd_before));
    for (int l = 0; l < width; ++l) bits[first + l] ^= static_cast<unsigned char>(turn[l]);
  }
}

void pass_plain(const LeafView& leaf, const TurnedTriangle& t, unsigned char* bits) {
  pass_lanes<2>(leaf, t, bits);
}
#if defined(__x86_64__)
[[gnu::target("avx2")]] void pass_avx2(const LeafView& leaf, const TurnedTriangle& t,
                                       unsigned char* bits) {
  pass_lanes<4>(leaf, t, bits);
}
#endif

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

  /// Calls visit(leaf) for leaves that lines through the triangle may be in.
  template <class Visit>
  void for_leaves(const TurnedTriangle& t, const Visit& visit) const {
    const auto [low_x, high_x] = std::minmax({t.x[0], t.x[1], t.x[2]});
    const auto [low_y, high_y] = std::minmax({t.y[0], t.y[1], t.y[2]});
    const double extent = high_x - low_x + high_y - low_y;
    struct Entry {
      int node, first, end;
    };
    std::array<Entry, 64> stack;
    std::size_t size = 0;
    stack[size++] = {0, 0, n_leaves};
    while (size > 0) {
      const auto [node, first, end] = stack[--size];
      const PlaneBox& box = boxes[node];
      if (box.low[0] > high_x || box.high[0] < low_x || box.low[1] > high_y || box.high[1] < low_y)
        continue;
      // Small triangles in large boxes are told apart by their own boxes alone.
      if (extent > box.high[0] - box.low[0] + box.high[1] - box.low[1] && !may_meet(t, box))
        continue;
      if (end - first == 1) {
        visit(first);
        continue;
      }
      const int middle_leaf = middle(first, end);
      stack[size++] = {right_of(node, first, end), middle_leaf, end};
      stack[size++] = {node + 1, first, middle_leaf};
    }
  }
};

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
    for (std::size_t f = begin; f < end; ++f) {
      if ((f - begin) % 1024 == 0) task.checkpoint();
      TurnedTriangle t;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto p = points.row(faces(index(f), int(k)));
        t.x[k] = along(u, p[0], p[1], p[2]);
        t.y[k] = along(v, p[0], p[1], p[2]);
        t.z[k] = along(direction, p[0], p[1], p[2]);
      }
      t.number = static_cast<double>(f);
      tree.for_leaves(t, [&](int leaf) {
        const std::size_t at = std::size_t(leaf) * leaf_size;
        pass({x.data() + at, y.data() + at, z.data() + at, own_.data() + at}, t, bits.data() + at);
      });
    }
    const std::lock_guard lock(adding);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] ^= bits[i];
  });
  for (std::size_t i = 0; i < order_.size(); ++i) out[order_[i]] = sum[i];
  return out;
}

}  // namespace littoral
