// Unit vectors at all nodes of a grid from values on a lattice graded with the distance.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "operators/grid.h"

namespace littoral {

namespace {

constexpr float tolerance = 0.01f;
constexpr std::size_t grain = 256;
constexpr std::size_t cells_between_checkpoints = 65536, nodes_between_checkpoints = 65536;

// Nodes low .. high (both included) along each axis; owns low .. high - 1, and high at the end of
// the grid, so that every node belongs to exactly one cell.
struct Cell {
  std::array<int, 3> low;
};

class Sampler {
 public:
  Sampler(const Grid& grid, const std::function<Vec3(const Vec3&, double&)>& sample)
      : grid_(grid),
        sample_(sample),
        Y(grid.n_nodes(), 3),
        known_(grid.n_nodes()),
        distance_(grid.n_nodes()) {}

  void run(const Task& task) {
    // The system hands out memory when it is first written to, which takes a while for all of it.
    parallel_for(known_.size(), nodes_between_checkpoints, [&](std::size_t begin, std::size_t end) {
      task.checkpoint();
      const auto from = static_cast<Eigen::Index>(begin),
                 n = static_cast<Eigen::Index>(end - begin);
      Y.middleRows(from, n).setZero();
      known_.segment(from, n).setZero();
      distance_.segment(from, n).setZero();
    });
    const int longest = *std::max_element(grid_.n.begin(), grid_.n.end());
    stride_ = 1;
    while (stride_ * 8 < longest) stride_ *= 2;
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
    std::vector<std::size_t> wanted;
    const auto want = [&](std::size_t node) {
      if (known_[node] != 0) return;
      known_[node] = 1;
      wanted.push_back(node);
    };
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i % cells_between_checkpoints == 0) task.checkpoint();
      const Cell& c = cells[i];
      for (int w = 0; w < 8; ++w) want(corner(c, w));
      if (stride_ > 1) want(middle(c));
    }
    const std::size_t row = grid_.n[0];
    const std::size_t slab = row * grid_.n[1];
    parallel_for(wanted.size(), grain, [&](std::size_t begin, std::size_t end) {
      task.checkpoint();
      for (std::size_t w = begin; w < end; ++w) {
        const std::size_t node = wanted[w];
        double d = 0;
        const Vec3 direction = sample_(grid_.point(node % row, node % slab / row, node / slab), d);
        Y.row(node) = direction.transpose().cast<float>();
        distance_[node] = static_cast<float>(d);
      }
    });
    evaluated_ += wanted.size();
  }

  Eigen::Vector3f interpolate(const Cell& c, int i, int j, int k) const {
    const std::array<int, 3> at{i, j, k};
    std::array<float, 3> t{};
    for (int a = 0; a < 3; ++a) {
      const std::size_t s = a;
      const int width = high(c, a) - c.low[s];
      t[s] = width > 0 ? static_cast<float>(at[s] - c.low[s]) / static_cast<float>(width) : 0.0f;
    }
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (int w = 0; w < 8; ++w)
      sum += (w & 1 ? t[0] : 1 - t[0]) * (w & 2 ? t[1] : 1 - t[1]) * (w & 4 ? t[2] : 1 - t[2]) *
             Y.row(corner(c, w)).transpose();
    const float size = sum.norm();
    return size > 0 ? Eigen::Vector3f(sum / size) : Eigen::Vector3f::Zero();
  }

  bool is_smooth(const Cell& c) const {
    Vec3 diagonal;
    for (int a = 0; a < 3; ++a) diagonal[a] = (high(c, a) - c.low[a]) * grid_.spacing[a];
    const std::size_t m = middle(c);
    if (distance_[m] < diagonal.norm()) return false;
    const Eigen::Vector3f y = Y.row(m);
    for (int w = 0; w < 8; ++w)
      if (Y.row(corner(c, w)).dot(y) < 0.5f) return false;
    return (interpolate(c, (c.low[0] + high(c, 0)) / 2, (c.low[1] + high(c, 1)) / 2,
                        (c.low[2] + high(c, 2)) / 2) -
            y)
               .norm() < tolerance;
  }

  /// Fills the smooth cells and divides the others.
  std::vector<Cell> settle(const std::vector<Cell>& cells, const Task& task) {
    std::vector<char> smooth(cells.size());
    // As many cells at once as hold about 64 times `grain` nodes: a large one is filled in a while.
    const std::size_t nodes = static_cast<std::size_t>(stride_) * stride_ * stride_;
    parallel_for(cells.size(), std::clamp<std::size_t>(64 * grain / nodes, 1, grain),
                 [&](std::size_t begin, std::size_t end) {
                   task.checkpoint();
                   for (std::size_t c = begin; c < end; ++c) {
                     smooth[c] = is_smooth(cells[c]) ? 1 : 0;
                     if (smooth[c] != 0) fill(cells[c]);
                   }
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

  void fill(const Cell& c) {
    std::array<int, 3> end{};
    for (int a = 0; a < 3; ++a) {
      const std::size_t s = a;
      end[s] = high(c, a) == grid_.n[s] - 1 ? grid_.n[s] : high(c, a);
    }
    for (int k = c.low[2]; k < end[2]; ++k)
      for (int j = c.low[1]; j < end[1]; ++j)
        for (int i = c.low[0]; i < end[0]; ++i) {
          const std::size_t node = grid_.node(i, j, k);
          if (known_[node] == 0) Y.row(node) = interpolate(c, i, j, k).transpose();
        }
  }

  const Grid& grid_;
  const std::function<Vec3(const Vec3&, double&)>& sample_;

 public:
  Directions Y;

 private:
  Eigen::Array<char, Eigen::Dynamic, 1> known_;  // evaluated, not interpolated
  Eigen::ArrayXf distance_;
  std::size_t evaluated_ = 0;
  int stride_ = 1;
};

}  // namespace

Directions sample_directions(const Grid& grid,
                             const std::function<Vec3(const Vec3&, double& distance)>& sample,
                             const Task& task, Report& report) {
  Sampler sampler(grid, sample);
  sampler.run(task);
  report.sizes.emplace_back("nodes_evaluated", static_cast<double>(sampler.evaluated()));
  return std::move(sampler.Y);
}

}  // namespace littoral
