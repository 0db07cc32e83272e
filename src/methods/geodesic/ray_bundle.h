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

  /// These windows, which stay as they are.
  void use(const WindowBlock& windows);
  int size() const { return static_cast<int>(windows_->size()); }
  Window operator[](int i) const { return (*windows_)[std::size_t(i)]; }

  /// On which side of the rays at the ends of each window the apex lies; rays that pass it by less
  /// than `tolerance` reach it.
  void look_at(const TriangleAbove& triangle, double tolerance) {
    kernels_.look_at_apex(columns_, size(), triangle.apex.real(), triangle.apex.imag(), tolerance,
                          covering_);
  }
  /// No window but first_covering(), ..., last_covering() - 1 has rays that reach the apex.
  int first_covering() const { return covering_[0]; }
  int last_covering() const { return covering_[1]; }
  /// Which sides of the apex each window goes on to (`RayColumns::goes`).
  void see_where_to(const CornerNumbers& corner) {
    kernels_.see_where_to(columns_, size(), corner);
  }
  /// Carries windows first, ..., last - 1, and perhaps their neighbours, to a side with these ends.
  void leave(const TriangleAbove& triangle, const RayExit& exit, const EdgeEnds& ends, int first,
             int last);
  const RayColumns& columns() const { return columns_; }
  /// A window that has been carried there, in the coordinates of the edge of that side.
  Window left_as(int i, std::uint16_t page) const {
    const Window from = (*this)[i];
    const RayColumns& c = columns_;
    return {.b0 = c.to0[i],
            .b1 = c.to1[i],
            .d0 = c.to_d0[i],
            .d1 = c.to_d1[i],
            .x = c.to_x[i],
            .y = c.to_y[i],
            .behind = c.to_behind[i],
            .source = from.source,
            .page = page,
            .depth = static_cast<std::uint8_t>(from.depth + (from.depth < Window::deep)),
            .parallel = from.parallel};
  }
  /// Adds windows first, ..., last - 1, which follow each other (`RayColumns::follows`), to a batch
  /// with room for them; all but the last in that order are cut from the one after them.
  void put(int first, int last, bool turned, std::uint16_t page, WindowBlock& batch) const {
    const std::size_t at = batch.size();
    batch.resize(at + std::size_t(last - first));
    kernels_.put(columns_, first, last, turned, page, batch, at);
    const int end = turned ? first : last - 1;
    batch.column(WindowBlock::b1)[batch.size() - 1] = columns_.to1[end];
    batch.column(WindowBlock::d1)[batch.size() - 1] = columns_.to_d1[end];
  }

 private:
  const WindowBlock* windows_ = nullptr;
  std::vector<double> numbers_;
  std::vector<std::int64_t> flags_;
  RayColumns columns_{};
  int covering_[2] = {0, 0};
  const RayKernels& kernels_;
};

}  // namespace littoral
