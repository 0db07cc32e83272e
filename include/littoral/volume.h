#pragma once
// Regular grids in space, and values at their nodes.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "littoral/types.h"

namespace littoral {

class Sdf;
struct PolygonSoup;

/// Where a grid lies. At most one of resolution and spacing; without both, 64 nodes.
struct GridOptions {
  std::optional<int> resolution{};                // nodes along the longest side, >= 2
  std::optional<double> spacing{};                // between nodes [length]
  std::optional<std::array<double, 6>> bounds{};  // x0 y0 z0 x1 y1 z1 [length]
  double padding = 0.25;  // without bounds: margin around the input, in its longest side
};

/// Nodes at origin + (i, j, k) * spacing, 0 <= i < n[0], ...; x runs fastest.
struct Grid {
  std::array<int, 3> n{0, 0, 0};
  Vec3 origin = Vec3::Zero();
  Vec3 spacing = Vec3::Ones();

  std::size_t n_nodes() const {
    return static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) *
           static_cast<std::size_t>(n[2]);
  }
  std::size_t node(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(n[0]) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(k));
  }
  Vec3 point(int i, int j, int k) const { return origin + spacing.cwiseProduct(Vec3(i, j, k)); }

  /// A grid around an input. With bounds, nodes lie on all of them, and spacings differ by axis as
  /// little as that allows. Throws InputError for options out of range and for an input without
  /// extent, IoError if computing on it will not fit into memory.
  static Grid around(const Sdf& distance, const GridOptions& options = {});
  static Grid around(const PolygonSoup& input, const GridOptions& options = {});
};

/// A function in a box, linear along each axis between nodes.
struct Volume {
  Grid grid;
  VecX values;  // nodes, x fastest
  std::string name = "distance";
};

/// The value at a point of the box, in node units (0 <= at <= n - 1); each axis needs two nodes.
/// Nodes of weight zero do not count, so infinite values reach no farther than their cells.
inline double interpolate(const Volume& field, const Vec3& at) {
  std::array<int, 3> cell;
  Vec3 t;
  for (int a = 0; a < 3; ++a) {
    cell[a] = std::clamp(static_cast<int>(std::floor(at[a])), 0, field.grid.n[a] - 2);
    t[a] = at[a] - cell[a];
  }
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int i = c & 1, j = c >> 1 & 1, k = c >> 2;
    const double weight = (i ? t[0] : 1 - t[0]) * (j ? t[1] : 1 - t[1]) * (k ? t[2] : 1 - t[2]);
    if (weight == 0) continue;
    sum += weight * field.values[static_cast<Eigen::Index>(
                        field.grid.node(cell[0] + i, cell[1] + j, cell[2] + k))];
  }
  return sum;
}

}  // namespace littoral
