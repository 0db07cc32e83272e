#include "methods/regularized/marched_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/falling_keys.h"
#include "base/fetch_ahead.h"
#include "base/groups.h"
#include "base/index.h"
#include "base/large_vector.h"
#include "base/parallel.h"

namespace littoral {

namespace {

constexpr std::size_t cell_grain = 1 << 14;

/// The triangles of a gradient, and the march over them.
class Marching {
 public:
  Marching(const VecX& A, Eigen::Index n)
      : A_(A), n_(n), way_(n_), accepted_(n_, 0), front_(static_cast<int>(n_)) {
    u_ = VecX::Constant(n_, infinity);
  }

  /// False if a cell has other than three nodes.
  bool find_cells(const SpRows& G) {
    cell_.resize(std::size_t(A_.size()));
    for (Eigen::Index c = 0; c < A_.size(); ++c) {
      const int at = G.outerIndexPtr()[2 * c];
      if (G.outerIndexPtr()[2 * c + 1] != at + 3 || G.outerIndexPtr()[2 * c + 2] != at + 6)
        return false;
      Cell& cell = cell_[std::size_t(c)];
      for (int k = 0; k < 3; ++k) {
        cell.corner[k] = G.innerIndexPtr()[at + k];
        if (cell.corner[k] != G.innerIndexPtr()[at + 3 + k]) return false;
        cell.hat[k] = {G.valuePtr()[at + k], G.valuePtr()[at + 3 + k]};
      }
    }
    cells_ = groups_of<int>(std::size_t(n_), [&](const auto& put) {
      for (int c = 0; c < A_.size(); ++c)
        for (int k = 0; k < 3; ++k) put(corner(c, k), c);
    });
    return true;
  }

  void march(const KnownDistances& known, const Task& task) {
    for (const auto& [v, distance] : known) {
      u_[v] = distance;
      front_.put(v, distance);
    }
    while (!front_.empty()) {
      const int v = front_.take();
      if ((order_.size() & 0xfff) == 0) task.checkpoint();
      accepted_[v] = 1;
      order_.push_back(v);
      for (const int c : cells_.at(v)) fetch_ahead(&cell_[std::size_t(c)]);
      for (const int c : cells_.at(v)) pass(c, v);
    }
  }

  /// cells: how much is transported, |flux|.
  VecX transport(const VecX& b, const Task& task) const {
    VecX through = b, flux = VecX::Zero(2 * A_.size());
    for (std::size_t i = order_.size(); i-- > 0;) {
      if ((i & 0xfff) == 0) task.checkpoint();
      const int v = order_[i];
      const Way& way = way_[v];
      if (way.cell < 0) continue;
      if (way.from < 0) {
        Vec2 along = Vec2::Zero();
        for (int k = 0; k < 3; ++k) along += u_[corner(way.cell, k)] * hat(way.cell, k);
        send(way.cell, way.to, along.normalized(), through[v], through, flux);
        continue;
      }
      // Along a side, in equal parts through the cells beside it: which of them the front took is
      // a matter of rounding.
      const int from = corner(way.cell, way.from);
      const double amount = through[v];
      int beside = 0;
      for (const int c : cells_.at(v)) beside += place(c, from) >= 0;
      for (const int c : cells_.at(v)) {
        const int at = place(c, from);
        if (at < 0) continue;
        const int to = place(c, v);
        send(c, to, side(c, at, to), amount / beside, through, flux);
      }
    }
    VecX out(A_.size());
    for (Eigen::Index c = 0; c < A_.size(); ++c) out[c] = flux.segment<2>(2 * c).norm();
    return out;
  }

  /// Cells get the mean of their nodes, which get that of their cells.
  void spread(VecX& amount) const {
    VecX at_nodes(n_);
    parallel_for(n_, cell_grain, [&](std::size_t v, std::size_t end) {
      for (; v < end; ++v) {
        double sum = 0, weight = 0;
        for (const int c : cells_.at(static_cast<int>(v))) {
          sum += A_[c] * amount[c];
          weight += A_[c];
        }
        at_nodes[v] = weight > 0 ? sum / weight : 0;
      }
    });
    parallel_for(A_.size(), cell_grain, [&](std::size_t c, std::size_t end) {
      for (; c < end; ++c)
        amount[c] = (at_nodes[corner(c, 0)] + at_nodes[corner(c, 1)] + at_nodes[corner(c, 2)]) / 3;
    });
  }

  VecX along_gradients(const VecX& amount) const {
    VecX flux = VecX::Zero(2 * A_.size());
    parallel_for(A_.size(), cell_grain, [&](std::size_t c, std::size_t end) {
      for (; c < end; ++c) {
        Vec2 g = Vec2::Zero();
        for (int k = 0; k < 3; ++k) g += u_[corner(c, k)] * hat(c, k);
        const double length = g.norm();
        if (length > 0 && std::isfinite(length)) flux.segment<2>(2 * c) = amount[c] / length * g;
      }
    });
    return flux;
  }

  VecX& u() { return u_; }

 private:
  /// How the front came to a node.
  struct Way {
    int cell = -1;
    int to = 0;     // the node's place in the cell
    int from = -1;  // of the node it came from along a side; -1: from between the other two
  };

  /// What belongs to a triangle, in one line of memory.
  struct alignas(64) Cell {
    std::array<double, 2> hat[3];  // gradients of the functions that are 1 at a corner
    int corner[3];
  };

  int corner(Eigen::Index c, int k) const { return cell_[std::size_t(c)].corner[k]; }
  Vec2 hat(Eigen::Index c, int k) const { return Vec2(cell_[std::size_t(c)].hat[k].data()); }
  /// Unit vector from corner k to corner i.
  Vec2 side(Eigen::Index c, int k, int i) const {
    const Vec2 across = hat(c, 3 - k - i).normalized(), along(-across.y(), across.x());
    return hat(c, i).dot(along) > 0 ? along : Vec2(-along);
  }

  /// Of a node among the corners of a cell; -1: none of them.
  int place(Eigen::Index c, int v) const {
    for (int k = 0; k < 3; ++k)
      if (corner(c, k) == v) return k;
    return -1;
  }

  /// Through cell c, against `along`, from corner `to` to the others.
  void send(Eigen::Index c, int to, const Vec2& along, double amount, VecX& through,
            VecX& flux) const {
    const double slope = hat(c, to).dot(along);
    if (!(slope > 0)) return;
    flux.segment<2>(2 * c) += amount / (A_[c] * slope) * along;
    for (int k = 0; k < 3; ++k)
      if (k != to) through[corner(c, k)] += amount * std::max(0.0, -hat(c, k).dot(along) / slope);
  }

  /// The front is at v and goes on through cell c.
  void pass(int c, int v) {
    const int at = place(c, v);
    for (int k = 0; k < 3; ++k) {
      const int i = corner(c, k), other = 3 - at - k;
      if (k == at || accepted_[i]) continue;
      const Vec2 g = hat(c, k);
      if (accepted_[corner(c, other)]) {
        // |p + t g| = 1, from between the other two.
        const Vec2 p = u_[v] * hat(c, at) + u_[corner(c, other)] * hat(c, other);
        const double a = g.squaredNorm(), half_b = p.dot(g), rest = p.squaredNorm() - 1;
        const double root = half_b * half_b - a * rest;
        if (root >= 0) {
          const double t = (std::sqrt(root) - half_b) / a;
          const Vec2 q = p + t * g;
          if (q.dot(hat(c, at)) <= 0 && q.dot(hat(c, other)) <= 0) {
            offer(i, t, {c, k, -1});
            continue;
          }
        }
      }
      const Vec2 h = hat(c, at);
      const double twice_area = 1 / std::abs(g.x() * h.y() - g.y() * h.x());
      offer(i, u_[v] + hat(c, other).norm() * twice_area, {c, k, at});
    }
  }
  void offer(int v, double t, const Way& way) {
    if (!(t < u_[v])) return;
    u_[v] = t;
    way_[v] = way;
    front_.put(v, t);
  }

  const VecX& A_;
  Eigen::Index n_;
  LargeVector<Cell> cell_;
  Groups<int> cells_;  // around each node
  VecX u_;
  std::vector<Way> way_;
  std::vector<char> accepted_;
  std::vector<int> order_;
  FallingKeys front_;
};

}  // namespace

std::optional<MarchedStart> marched_start(const SpRows& G, const VecX& A, const VecX& b,
                                          const KnownDistances& known, const Task& task) {
  Marching marching(A, G.cols());
  if (!marching.find_cells(G)) return std::nullopt;
  marching.march(known, task);
  VecX amount = marching.transport(b, task);
  marching.spread(amount);
  MarchedStart out;
  out.flux = marching.along_gradients(amount);
  out.u = std::move(marching.u());
  return out;
}

void start_from(const VecX& flux, double alpha, bool quadratic_apart, const VecX& bound,
                SplitProblem& problem) {
  problem.near_gradient = VecX::Zero(problem.G.rows());
  problem.near_multipliers = problem.near_gradient;
  for (Eigen::Index i = 0; i < flux.size(); i += 2) {
    const Vec2 f = flux.segment<2>(i);
    const double amount = f.norm();
    if (!(amount > 0)) continue;
    const Vec2 gradient = f / std::max(alpha, amount);
    problem.near_gradient.segment<2>(i) = gradient;
    problem.near_multipliers.segment<2>(i) = quadratic_apart ? Vec2(f - alpha * gradient) : f;
  }
  for (Eigen::Index k = 0; k < bound.size(); ++k)
    problem.near_gradient[flux.size() + 2 * k] = bound[k];
}

}  // namespace littoral
