#pragma once
// A regular grid of nodes in space.

#include <array>
#include <cstddef>

#include "base/types.h"

namespace littoral {

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
};

}  // namespace littoral
