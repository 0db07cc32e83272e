#pragma once
// Which of many places the lines through them leave by an odd number of triangles.

#include <cstdint>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// A place on a triangle, by the triangle's number or -1.
struct Place {
  int face;
  Vec3 x;
};

/// What a line passes on its way from a place in its direction, and in the other one.
constexpr unsigned char odd_after = 1, odd_before = 2;

/// Places in leaves of a few, in a tree over their positions. Boxes of triangles would lie over one
/// another where many triangles are in one place; places never do.
class PlaceTree {
 public:
  explicit PlaceTree(const std::vector<Place>& places);

  /// For each place, bits for an odd number of triangles but its own that the line through it
  /// meets. points: n x 3, finite; faces: m x 3; direction: of length 1. A line through the side
  /// or the corner of triangles that close up there meets one of them.
  std::vector<unsigned char> parities(const MatX3& points, const MatX3i& faces,
                                      const Vec3& direction, const Task& task) const;

 private:
  void divide(int first_leaf, int end_leaf, const std::vector<Place>& places);

  int n_leaves_ = 0;
  std::vector<int> order_;  // numbers of places, leaf by leaf
  std::vector<double> x_, y_, z_, own_;
};

}  // namespace littoral
