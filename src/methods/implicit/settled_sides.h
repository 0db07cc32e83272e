#pragma once
// Which side of a surface in space is inside, as far as its faces tell.

#include <array>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "methods/implicit/side_census.h"
#include "spatial/winding_number.h"

namespace littoral {

/// The faces that bound, oriented, and what their winding number says of places. Immutable.
struct SettledSides {
  WindingNumber winding;  // of the faces below
  SideRule rule;
  MatX3i faces{0, 3};
  std::vector<std::array<int, 2>> boundary;  // where they end
  bool bounds = true;                        // some of their area does, as far as was looked

  /// Winding number less the level between outside and inside: 1/2 in a closed surface, -1/2
  /// around it, 0 where nothing tells.
  double inside(const Vec3& x, double accuracy) const { return rule.inside(winding(x, accuracy)); }
};

/// Faces whose own orientation disagrees are turned by the parity of lines (orient_soup.h). What
/// the surface's winding number then says about it is reported, with warnings where the sign is
/// doubtful. points: n x 3, about unit size; faces: m x 3, with finite corners and an area;
/// as_given: inside is behind the normals even where the surface encloses the other side.
SettledSides settled_sides(const MatX3& points, const MatX3i& faces, bool as_given,
                           const Task& task, Report& report);

}  // namespace littoral
