#pragma once
// Windows of one edge on their way through a triangle, side by side.

#include <vector>

#include "littoral/types.h"
#include "methods/geodesic/polyhedral_window.h"
#include "methods/geodesic/ray_kernels.h"

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

/// Every step is done for several windows at once: most of what a window costs is waiting for
/// quotients and roots, which then overlap.
class RayBundle {
 public:
  explicit RayBundle(const RayKernels& kernels = ray_kernels()) : kernels_(kernels) {}

  void clear() { windows_.clear(); }
  /// Windows stay where they are.
  void add(const Window& w) { windows_.push_back(&w); }
  int size() const { return static_cast<int>(windows_.size()); }
  const Window& operator[](int i) const { return *windows_[i]; }

  /// On which side of the rays at the ends of each window the apex lies; rays that pass it by less
  /// than `tolerance` reach it.
  void look_at(const TriangleAbove& triangle, double tolerance);
  /// Which sides of the apex each window goes on to (`RayColumns::goes`).
  void see_where_to(double crossing, double reach) {
    kernels_.see_where_to(columns_, size(), crossing, reach);
  }
  /// Carries windows first, ..., last - 1, and perhaps their neighbours, to a side with these ends.
  void leave(const TriangleAbove& triangle, const RayExit& exit, const EdgeEnds& ends, int first,
             int last);
  const RayColumns& columns() const { return columns_; }
  /// Fills in a window that has been carried there, in the coordinates of the edge of that side.
  void left_as(int i, std::uint16_t page, Window& w) const {
    const Window& from = *windows_[i];
    w.b0 = columns_.to0[i];
    w.b1 = columns_.to1[i];
    w.d0 = columns_.to_d0[i];
    w.d1 = columns_.to_d1[i];
    w.x = columns_.to_x[i];
    w.y = columns_.to_y[i];
    w.behind = columns_.to_behind[i];
    w.source = from.source;
    w.page = page;
    w.depth = static_cast<std::uint8_t>(from.depth + (from.depth < Window::deep));
    w.parallel = from.parallel;
    w.open = true;
  }

 private:
  void make_room();

  std::vector<const Window*> windows_;
  std::vector<double> numbers_;
  std::vector<std::int64_t> flags_;
  RayColumns columns_{};
  const RayKernels& kernels_;
};

}  // namespace littoral
