// Unit vectors at all nodes of a grid from values on a lattice graded with the distance.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"
#include "operators/grid.h"

namespace littoral {

namespace {

constexpr float tolerance = 0.01f;
constexpr float few = 4;              // tolerances: beyond, a cell has more than curvature in it
constexpr std::size_t at_once = 256;  // nodes
constexpr std::size_t cells_at_once = 4096;
constexpr char wanted_now = 2;
constexpr std::size_t cells_between_checkpoints = 65536, nodes_between_checkpoints = 65536;

// Nodes low .. high (both included) along each axis; owns low .. high - 1, and high at the end of
// the grid, so that every node belongs to exactly one cell.
struct Cell {
  std::array<int, 3> low;
};

/// Interpolates unit vectors on a lattice of two or three nodes along each axis, the ends included.
class Patch {
 public:
  /// width: between the ends; 0 where they are one.
  Patch(int nodes, const std::array<int, 3>& low, const std::array<int, 3>& width)
      : nodes_(nodes), low_(low), width_(width) {}

  Eigen::Vector3f& value(int i, int j, int k) { return values_[(k * nodes_ + j) * nodes_ + i]; }
  /// Whether all values are within 60 degrees of a direction.
  bool all_near(const Eigen::Vector3f& y) const {
    for (int v = 0; v < nodes_ * nodes_ * nodes_; ++v)
      if (values_[v].dot(y) < 0.5f) return false;
    return true;
  }
  void set_row(int j, int k) {
    const Weights y = weights(1, j), z = weights(2, k);
    for (int i = 0; i < nodes_; ++i) {
      row_[i].setZero();
      for (int w = 0; w < nodes_; ++w)
        for (int v = 0; v < nodes_; ++v) row_[i] += z[w] * y[v] * value(i, v, w);
    }
  }
  Eigen::Vector3f at(int i) const {
    const Weights x = weights(0, i);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (int u = 0; u < nodes_; ++u) sum += x[u] * row_[u];
    const float size = sum.norm();
    return size > 0 ? Eigen::Vector3f(sum / size) : Eigen::Vector3f::Zero();
  }

 private:
  using Weights = std::array<float, 3>;
  Weights weights(std::size_t axis, int at) const {
    const int width = width_[axis];
    const float t =
        width > 0 ? static_cast<float>(at - low_[axis]) / static_cast<float>(width) : 0.0f;
    if (nodes_ == 2) return {1 - t, t, 0};
    return {(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)};
  }

  int nodes_;
  std::array<int, 3> low_, width_;
  std::array<Eigen::Vector3f, 27> values_;
  std::array<Eigen::Vector3f, 3> row_;
};

class Sampler {
 public:
  Sampler(const Grid& grid, const Sample& sample)
      : grid_(grid),
        sample_(sample),
        Y(grid.n_nodes(), 3),
        known_(grid.n_nodes()),
        distance_(grid.n_nodes()) {}

  void run(const Task& task) {
    // The system hands out memory when it is first written to, which takes a while for all of it.
    parallel_for(known_.size(), nodes_between_checkpoints, [&](std::size_t begin, std::size_t end) {
      task.checkpoint();
      const auto from = index(begin), n = index(end - begin);
      Y.middleRows(from, n).setZero();
      known_.segment(from, n).setZero();
      distance_.segment(from, n).setZero();
    });
    const int longest = *std::max_element(grid_.n.begin(), grid_.n.end());
    stride_ = 1;
    while (stride_ * 8 < longest) stride_ *= 2;
    largest_ = stride_;
    std::vector<Cell> cells;
    for (int k = 0; k < std::max(1, grid_.n[2] - 1); k += stride_)
      for (int j = 0; j < std::max(1, grid_.n[1] - 1); j += stride_)
        for (int i = 0; i < std::max(1, grid_.n[0] - 1); i += stride_) cells.push_back({{i, j, k}});
    for (; !cells.empty(); stride_ /= 2) {
      evaluate(cells, task);
      if (stride_ == 1) break;
      cells = settle(cells, task);
    }
  }

  std::size_t evaluated() const { return evaluated_; }

 private:
  int high(const Cell& c, int a) const {
    const std::size_t s = a;
    return std::min(c.low[s] + stride_, grid_.n[s] - 1);
  }
  std::size_t corner(const Cell& c, int which) const {
    return grid_.node(which & 1 ? high(c, 0) : c.low[0], which & 2 ? high(c, 1) : c.low[1],
                      which & 4 ? high(c, 2) : c.low[2]);
  }
  std::size_t middle(const Cell& c) const {
    return grid_.node((c.low[0] + high(c, 0)) / 2, (c.low[1] + high(c, 1)) / 2,
                      (c.low[2] + high(c, 2)) / 2);
  }

  void evaluate(const std::vector<Cell>& cells, const Task& task) {
    parallel_for(cells.size(), cells_at_once, [&](std::size_t begin, std::size_t end) {
      task.checkpoint();
      for (std::size_t c = begin; c < end; ++c) {
        for (int w = 0; w < 8; ++w) want(corner(cells[c], w));
        if (stride_ > 1) want(middle(cells[c]));
      }
    });
    // Cubes of cubes, so that those next to one another in the list are so in space.
    const int cube = 2 * stride_, tile = 2 * cube;
    std::array<int, 3> tiles{};
    for (std::size_t a = 0; a < 3; ++a) tiles[a] = (grid_.n[a] + tile - 1) / tile;
    std::vector<std::size_t> found(std::size_t(tiles[1]) * tiles[2]);
    parallel_for(found.size(), 1, [&](std::size_t row, std::size_t) {
      task.checkpoint();
      std::vector<std::size_t> wanted;
      std::array<int, 3> low{0, static_cast<int>(row) % tiles[1] * tile,
                             static_cast<int>(row) / tiles[1] * tile};
      for (; low[0] < grid_.n[0]; low[0] += tile)
        for (int w = 0; w < 8; ++w)
          append({low[0] + (w & 1) * cube, low[1] + (w >> 1 & 1) * cube, low[2] + (w >> 2) * cube},
                 cube, wanted);
      evaluate(wanted, task);
      found[row] = wanted.size();
    });
    for (const std::size_t n : found) evaluated_ += n;
  }

  void want(std::size_t node) {
    // As std::atomic_ref does, which libc++ 13 lacks.
    if (__atomic_load_n(&known_[node], __ATOMIC_RELAXED) == 0)
      __atomic_store_n(&known_[node], wanted_now, __ATOMIC_RELAXED);
  }

  /// The nodes of a cube that are wanted now.
  void append(const std::array<int, 3>& low, int side, std::vector<std::size_t>& wanted) {
    const auto end = [&](std::size_t a) { return std::min(low[a] + side, grid_.n[a]); };
    for (int k = low[2]; k < end(2); ++k)
      for (int j = low[1]; j < end(1); ++j)
        for (int i = low[0]; i < end(0); ++i)
          if (const std::size_t node = grid_.node(i, j, k); known_[node] == wanted_now)
            wanted.push_back(node);
  }

  void evaluate(const std::vector<std::size_t>& wanted, const Task& task) {
    const std::size_t row = grid_.n[0], slab = row * grid_.n[1];
    std::array<Vec3, at_once> places;
    std::array<Flow, at_once> flows;
    for (std::size_t from = 0; from < wanted.size(); from += at_once) {
      task.checkpoint();
      const std::size_t n = std::min(at_once, wanted.size() - from);
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t node = wanted[from + i];
        places[i] = grid_.point(node % row, node % slab / row, node / slab);
      }
      sample_(places.data(), static_cast<int>(n), flows.data());
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t node = wanted[from + i];
        Y.row(node) = flows[i].direction.transpose().cast<float>();
        distance_[node] = static_cast<float>(flows[i].distance);
        known_[node] = 1;
      }
    }
  }

  /// Through the corners of a cell, or the 27 nodes of its parent's lattice.
  Patch corners(const Cell& c) const {
    std::array<int, 3> width{};
    for (int a = 0; a < 3; ++a) width[a] = high(c, a) - c.low[a];
    Patch patch(2, c.low, width);
    for (int w = 0; w < 8; ++w) patch.value(w & 1, w >> 1 & 1, w >> 2) = Y.row(corner(c, w));
    return patch;
  }
  /// False at the end of the grid, and of the largest cells, which have no parent.
  bool has_lattice(const Cell& c) const {
    bool whole = stride_ < largest_;
    for (std::size_t a = 0; a < 3; ++a)
      whole = whole && c.low[a] / (2 * stride_) * (2 * stride_) + 2 * stride_ < grid_.n[a];
    return whole;
  }
  Patch lattice(const Cell& c) const {
    std::array<int, 3> low{};
    for (std::size_t a = 0; a < 3; ++a) low[a] = c.low[a] / (2 * stride_) * (2 * stride_);
    Patch patch(3, low, {2 * stride_, 2 * stride_, 2 * stride_});
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          patch.value(i, j, k) =
              Y.row(grid_.node(low[0] + i * stride_, low[1] + j * stride_, low[2] + k * stride_));
    return patch;
  }

  /// Fills a cell where the field is smooth there; false where it is not.
  bool settle(const Cell& c) {
    Vec3 diagonal;
    for (int a = 0; a < 3; ++a) diagonal[a] = (high(c, a) - c.low[a]) * grid_.spacing[a];
    const std::size_t m = middle(c);
    if (distance_[m] < diagonal.norm()) return false;
    const Eigen::Vector3f y = Y.row(m);
    const auto error = [&](Patch& patch, const Cell& at) {
      patch.set_row((at.low[1] + high(at, 1)) / 2, (at.low[2] + high(at, 2)) / 2);
      return (patch.at((at.low[0] + high(at, 0)) / 2) - Y.row(middle(at)).transpose()).norm();
    };
    Patch linear = corners(c);
    if (!linear.all_near(y)) return false;
    const float linear_error = error(linear, c);
    if (linear_error < tolerance) {
      fill(c, linear);
      return true;
    }
    if (linear_error > few * tolerance || !has_lattice(c)) return false;
    Patch quadratic = lattice(c);
    if (!quadratic.all_near(y) || error(quadratic, c) > tolerance) return false;
    for (int w = 0; w < 8; ++w) {  // the parent's other parts
      Cell part = c;
      for (std::size_t a = 0; a < 3; ++a)
        part.low[a] = c.low[a] / (2 * stride_) * (2 * stride_) + (w >> a & 1) * stride_;
      if (error(quadratic, part) > few * tolerance) return false;
    }
    fill(c, quadratic);
    return true;
  }

  /// Fills the smooth cells and divides the others.
  std::vector<Cell> settle(const std::vector<Cell>& cells, const Task& task) {
    std::vector<char> smooth(cells.size());
    // As many cells at once as hold about 64 times `at_once` nodes: a large one is filled in a
    // while.
    const std::size_t nodes = std::size_t(stride_) * stride_ * stride_;
    parallel_for(cells.size(), std::clamp<std::size_t>(64 * at_once / nodes, 1, at_once),
                 [&](std::size_t begin, std::size_t end) {
                   task.checkpoint();
                   for (std::size_t c = begin; c < end; ++c) smooth[c] = settle(cells[c]) ? 1 : 0;
                 });
    std::vector<Cell> finer;
    const int half = stride_ / 2;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (c % cells_between_checkpoints == 0) task.checkpoint();
      if (smooth[c] != 0) continue;
      for (int w = 0; w < 8; ++w) {
        Cell child = cells[c];
        bool inside = true;
        for (int a = 0; a < 3; ++a) {
          if ((w >> a & 1) == 0) continue;
          const std::size_t s = a;
          child.low[s] += half;
          inside = inside && child.low[s] < grid_.n[s] - 1;
        }
        if (inside) finer.push_back(child);
      }
    }
    return finer;
  }

  void fill(const Cell& c, Patch& patch) {
    std::array<int, 3> end{};
    for (int a = 0; a < 3; ++a) {
      const std::size_t s = a;
      end[s] = high(c, a) == grid_.n[s] - 1 ? grid_.n[s] : high(c, a);
    }
    for (int k = c.low[2]; k < end[2]; ++k)
      for (int j = c.low[1]; j < end[1]; ++j) {
        patch.set_row(j, k);
        for (int i = c.low[0]; i < end[0]; ++i) {
          const std::size_t node = grid_.node(i, j, k);
          if (known_[node] == 0) Y.row(node) = patch.at(i).transpose();
        }
      }
  }

  const Grid& grid_;
  const Sample& sample_;

 public:
  Directions Y;

 private:
  Eigen::Array<char, Eigen::Dynamic, 1> known_;  // 1: evaluated, not interpolated
  Eigen::ArrayXf distance_;
  std::size_t evaluated_ = 0;
  int stride_ = 1, largest_ = 1;
};

}  // namespace

Directions sample_directions(const Grid& grid, const Sample& sample, const Task& task,
                             Report& report) {
  Sampler sampler(grid, sample);
  sampler.run(task);
  report.sizes.emplace_back("nodes_evaluated", static_cast<double>(sampler.evaluated()));
  return std::move(sampler.Y);
}

}  // namespace littoral
