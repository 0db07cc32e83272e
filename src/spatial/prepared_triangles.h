#pragma once
// Triangles as the kernels of searches on grids want them, those that were asked for last.

#include <array>
#include <vector>

#include "littoral/types.h"
#include "spatial/nearest_kernels.h"

namespace littoral {

struct PreparedTriangle {
  int triangle = -1;
  unsigned turn = 0;   // of who uses it
  bool plane = false;  // known to all digits; the numbers below are set only then
  NearTriangle<double> exact;
  NearTriangle<float> rough;  // with a normal and directions inward of unit length
};

/// For one thread: a slot for each remainder of the triangles' numbers, kept until another triangle
/// needs it.
class PreparedTriangles {
 public:
  /// From here on `free` tells of what was asked for since.
  void next_turn() { ++turn_; }
  /// May the triangle be asked for without taking the slot of one of this turn?
  bool free(int triangle) const {
    const PreparedTriangle& other = slots_[triangle % n];
    return other.triangle == triangle || other.turn != turn_;
  }
  /// Valid until another one with the same remainder is asked for. corners(triangle): relative to
  /// the frame of the search.
  template <class Corners>
  const PreparedTriangle& get(int triangle, const Corners& corners) {
    PreparedTriangle& out = slots_[triangle % n];
    if (out.triangle != triangle) set(triangle, corners(triangle), out);
    out.turn = turn_;
    return out;
  }

 private:
  static void set(int triangle, const std::array<Vec3, 3>& corners, PreparedTriangle& out);
  static constexpr int n = 1024;
  std::vector<PreparedTriangle> slots_ = std::vector<PreparedTriangle>(n);
  unsigned turn_ = 1;
};

}  // namespace littoral
