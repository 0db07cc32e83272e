#pragma once
// Which sides a surface in space separates, seen by its own winding number: what its sign is worth.

#include <vector>

#include "spatial/winding_number.h"

namespace littoral {

/// How inside is told from outside: by a winding number above a level, or that of all faces turned
/// round.
struct SideRule {
  double sense = 1;    // -1: of the faces turned round
  double level = 0.5;  // half an odd number
  /// > 0 inside.
  double inside(double winding) const { return sense * winding - level; }
};

/// Winding numbers just behind and just in front of evenly spread places on the faces.
struct SideCensus {
  std::vector<int> face;
  std::vector<double> back, front;

  /// Shares of the area, by a rule: where the inside ends as its normals say, within the inside or
  /// without it on both sides. What is left ends the inside the other way.
  struct Shares {
    double bounds = 0, within = 0, without = 0;
  };
  Shares shares(const SideRule& rule) const;
};

/// At as many places, by area; points n x 3, faces m x 3 with finite corners, about unit size.
SideCensus side_census(const MatX3& points, const MatX3i& faces, const WindingNumber& winding,
                       int places = 2048);

/// The rule by which most of the area bounds. The inside is what the surface encloses, whichever
/// way its normals point; with `as_given` it is behind the normals.
SideRule choose_sides(const SideCensus& census, bool as_given);

}  // namespace littoral
