#include "sources/space/level_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/index.h"
#include "base/option_table.h"
#include "base/parallel.h"
#include "littoral/error.h"

namespace littoral {

namespace {

/// A value and its slope, in node units.
struct CubicSample {
  double value = 0;
  Vec3 slope = Vec3::Zero();
};

/// Catmull-Rom weights of the nodes at -1, 0, 1, 2 for a place t in [0, 1], and their derivatives.
void cubic_weights(double t, double w[4], double dw[4]) {
  const double t2 = t * t, t3 = t2 * t;
  w[0] = 0.5 * (-t3 + 2 * t2 - t);
  w[1] = 0.5 * (3 * t3 - 5 * t2 + 2);
  w[2] = 0.5 * (-3 * t3 + 4 * t2 + t);
  w[3] = 0.5 * (t3 - t2);
  dw[0] = 0.5 * (-3 * t2 + 4 * t - 1);
  dw[1] = 0.5 * (9 * t2 - 10 * t);
  dw[2] = 0.5 * (-9 * t2 + 8 * t + 1);
  dw[3] = 0.5 * (3 * t2 - 2 * t);
}

/// The values around one cell, 4 x 4 x 4 nodes, minus the level; the cell is the middle one.
class CellCubic {
 public:
  CellCubic(const Volume& field, const std::array<int, 3>& cell, double level) {
    const auto& n = field.grid.n;
    for (int k = 0; k < 4; ++k) {
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
          const std::array<int, 3> node = {cell[0] + i - 1, cell[1] + j - 1, cell[2] + k - 1};
          bool inside = true;
          for (int a = 0; a < 3; ++a) inside = inside && node[a] >= 0 && node[a] < n[a];
          at({i, j, k}) = inside ? field.values[field.grid.node(node[0], node[1], node[2])] - level
                                 : std::numeric_limits<double>::quiet_NaN();
        }
      }
    }
    for (int axis = 0; axis < 3; ++axis) extend(axis);
    double size = 0;  // of the values: they may have any unit
    for (double value : values_) size = std::max(size, std::abs(value));
    if (size > 0)
      for (double& value : values_) value /= size;
  }

  /// At a place in [0, 1]^3.
  CubicSample ask(const Vec3& t) const {
    double w[3][4], dw[3][4];
    for (int a = 0; a < 3; ++a) cubic_weights(t[a], w[a], dw[a]);
    CubicSample sample;
    for (int k = 0; k < 4; ++k) {
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
          const double value = at({i, j, k});
          sample.value += w[0][i] * w[1][j] * w[2][k] * value;
          sample.slope += value * Vec3(dw[0][i] * w[1][j] * w[2][k], w[0][i] * dw[1][j] * w[2][k],
                                       w[0][i] * w[1][j] * dw[2][k]);
        }
      }
    }
    return sample;
  }

  bool finite() const {
    for (double value : values_)
      if (!std::isfinite(value)) return false;
    return true;
  }

  /// The mean of where the level set crosses the cell's edges, linearly; none if all eight corners
  /// are on one side.
  bool middle(Vec3& mean) const {
    int crossings = 0;
    mean.setZero();
    for (int axis = 0; axis < 3; ++axis) {
      for (int e = 0; e < 4; ++e) {
        std::array<int, 3> from = {1, 1, 1};
        from[(axis + 1) % 3] += e & 1;
        from[(axis + 2) % 3] += e >> 1;
        std::array<int, 3> to = from;
        ++to[axis];
        const double a = at(from), b = at(to);
        if ((a <= 0) == (b <= 0)) continue;
        for (int d = 0; d < 3; ++d) mean[d] += from[d] - 1;
        mean[axis] += a / (a - b);
        ++crossings;
      }
    }
    if (crossings > 0) mean /= crossings;
    return crossings > 0;
  }

 private:
  double& at(const std::array<int, 3>& i) { return values_[i[0] + 4 * i[1] + 16 * i[2]]; }
  double at(const std::array<int, 3>& i) const { return values_[i[0] + 4 * i[1] + 16 * i[2]]; }

  /// Nodes beyond the box or without a value: linear along one axis after the other.
  void extend(int axis) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 4; ++k) {
        const auto on_line = [&](int i) -> double& {
          std::array<int, 3> node;
          node[axis] = i;
          node[(axis + 1) % 3] = j;
          node[(axis + 2) % 3] = k;
          return at(node);
        };
        if (!std::isfinite(on_line(0))) on_line(0) = 2 * on_line(1) - on_line(2);
        if (!std::isfinite(on_line(3))) on_line(3) = 2 * on_line(2) - on_line(1);
      }
    }
  }

  std::array<double, 64> values_{};
};

struct LevelPoint {
  Vec3 point, normal;
  std::array<int, 3> cell;
};

/// The point of a cell, moved along the slope onto the level set; false where there is none in or
/// right beside the cell, or no slope.
bool find_point(const Volume& field, const std::array<int, 3>& cell, double level,
                LevelPoint& found) {
  const Grid& grid = field.grid;
  // Most cells end here.
  bool below = false, above = false;
  for (int c = 0; c < 8; ++c) {
    const double value =
        field.values[grid.node(cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2))];
    if (!std::isfinite(value)) return false;
    (value <= level ? below : above) = true;
  }
  if (!below || !above) return false;
  const CellCubic cubic(field, cell, level);
  Vec3 t;
  if (!cubic.finite() || !cubic.middle(t)) return false;
  CubicSample here = cubic.ask(t);
  for (int step = 0; step < 8; ++step) {
    const double steepness = here.slope.squaredNorm();
    if (!(steepness > 0) || !std::isfinite(steepness)) return false;
    Vec3 move = -here.value / steepness * here.slope;
    const double length = move.norm();
    if (length > 0.5) move *= 0.5 / length;
    t = (t + move).cwiseMax(-0.25).cwiseMin(1.25);
    here = cubic.ask(t);
    if (length < 1e-10) break;
  }
  const double steepness = here.slope.norm();
  if (!(steepness > 0) || !(std::abs(here.value) < 1e-3 * steepness)) return false;
  for (int a = 0; a < 3; ++a) found.point[a] = grid.origin[a] + grid.spacing[a] * (cell[a] + t[a]);
  found.normal = here.slope.cwiseQuotient(grid.spacing).stableNormalized();
  found.cell = cell;
  return found.point.allFinite() && found.normal.allFinite() && found.normal.norm() > 0.5;
}

void check(const Volume& field, double level) {
  for (int n : field.grid.n)
    if (n < 2) throw InputError("a volume needs two nodes along each axis at least");
  if (field.values.size() != index(field.grid.n_nodes()))
    throw InputError("the volume has " + std::to_string(field.values.size()) + " values for " +
                         std::to_string(field.grid.n_nodes()) + " nodes",
                     "sizes-differ");
  if (!field.grid.origin.allFinite() || !field.grid.spacing.allFinite() ||
      !(field.grid.spacing.minCoeff() > 0))
    throw InputError("the volume's box must be finite and its spacings positive", "option-value");
  if (!std::isfinite(level)) throw InputError("the level must be a finite number", "option-value");
}

}  // namespace

PolygonSoup level_points(const Volume& field, double level, const Task& task) {
  check(field, level);
  const Grid& grid = field.grid;
  const int layers = grid.n[2] - 1;
  std::vector<std::vector<LevelPoint>> by_layer(layers);
  parallel_for(by_layer.size(), 1, [&](std::size_t k, std::size_t) {
    for (int j = 0; j + 1 < grid.n[1]; ++j) {
      if (j % 16 == 0) task.checkpoint(static_cast<double>(k) / layers);
      for (int i = 0; i + 1 < grid.n[0]; ++i) {
        LevelPoint found;
        if (find_point(field, {i, j, static_cast<int>(k)}, level, found))
          by_layer[k].push_back(found);
      }
    }
  });
  // Cells that the level set hardly enters have points next to those of others.
  const double separation = 0.5 * grid.spacing.minCoeff();
  std::vector<LevelPoint> kept;
  std::vector<int> last(std::size_t(grid.n[0]) * grid.n[1] * 3,
                        -1);  // the point kept of each cell of the last layers
  const auto slot = [&](int i, int j, int k) -> int& {
    return last[i + std::size_t(grid.n[0]) * (j + std::size_t(grid.n[1]) * (k % 3))];
  };
  for (int k = 0; k < layers; ++k) {
    task.checkpoint();
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) slot(i, j, k) = -1;
    for (const LevelPoint& candidate : by_layer[k]) {
      const auto [ci, cj, ck] = candidate.cell;
      bool alone = true;
      for (int z = std::max(0, ck - 2); z <= ck; ++z)
        for (int y = std::max(0, cj - 2); y < std::min(grid.n[1], cj + 3); ++y)
          for (int x = std::max(0, ci - 2); x < std::min(grid.n[0], ci + 3); ++x) {
            const int other = slot(x, y, z);
            alone =
                alone && (other < 0 || (kept[other].point - candidate.point).norm() >= separation);
          }
      if (!alone) continue;
      slot(ci, cj, ck) = kept.size();
      kept.push_back(candidate);
    }
  }
  if (kept.empty())
    throw InputError("the values do not pass level " + rounded_text(level) +
                         " anywhere; they run from " + rounded_text(field.values.minCoeff()) +
                         " to " + rounded_text(field.values.maxCoeff()),
                     "nothing-there");
  PolygonSoup cloud;
  cloud.points.resize(kept.size(), 3);
  cloud.normals.resize(cloud.points.rows(), 3);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    cloud.points.row(i) = kept[i].point;
    cloud.normals.row(i) = kept[i].normal;
  }
  return cloud;
}

}  // namespace littoral
