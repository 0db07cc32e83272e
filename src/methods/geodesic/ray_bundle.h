#pragma once
// Windows of one edge on their way through a triangle, side by side.

#include <Eigen/Core>
#include <vector>

#include "littoral/types.h"
#include "methods/geodesic/polyhedral_window.h"

namespace littoral {

/// A triangle above an edge that rays come through: the edge on the real axis from its tail at 0 to
/// its length, the far corner above.
struct TriangleAbove {
  double length;
  Complex apex;
};

/// A side through which rays leave the triangle, from an end of the edge below to the apex.
struct RayExit {
  RayExit(const TriangleAbove& triangle, double side_length, bool is_right, bool starts_at_apex);

  double length;
  bool right;         // starts at the head of the edge below, else at its tail
  bool from_apex;     // its own tail is the apex
  Complex tail;       // in the coordinates of the edge below
  Complex along, up;  // unit vectors: from its tail to its head, out of the triangle

  /// The rays of earlier windows leave nearer to its head than those of later ones.
  bool turned() const { return right != from_apex; }
};

/// Every step is done for four windows at once: most of what a window costs is waiting for
/// quotients and roots, which then overlap.
class RayBundle {
 public:
  void clear() { windows_.clear(); }
  /// Windows stay where they are.
  void add(const Window& w) { windows_.push_back(&w); }
  int size() const { return static_cast<int>(windows_.size()); }
  const Window& operator[](int i) const { return *windows_[i]; }

  /// On which side of the rays at the ends of each window the apex lies.
  void look_at(const TriangleAbove& triangle);
  /// > 0: the apex lies left of the ray at the window's start, end.
  double at_start(int i) const { return blocks_[i / lanes].apex0[i % lanes]; }
  double at_end(int i) const { return blocks_[i / lanes].apex1[i % lanes]; }

  /// Carries windows first, ..., last - 1, and perhaps their neighbours, to a side.
  void leave(const TriangleAbove& triangle, const RayExit& exit, int first, int last);
  /// Fills in a window that has been carried there, in the coordinates of the edge of that side.
  void left_as(int i, const RayExit& exit, std::uint16_t page, Window& w) const;

 private:
  static constexpr int lanes = 4;
  using Lanes = Eigen::Array<double, lanes, 1>;
  struct Block {
    Lanes b0, b1, x, y, behind, g0, g1, gy;  // direction (g, gy) of the rays at the ends
    Lanes apex0, apex1;
    Lanes to0, to1, to_x, to_y, to_d0, to_d1;
  };
  template <bool right>
  void carry(const TriangleAbove& triangle, const RayExit& exit, Block& of) const;

  std::vector<const Window*> windows_;
  std::vector<Block> blocks_;
};

}  // namespace littoral
