#pragma once
// Random points on triangles.

#include <vector>

#include "base/random_numbers.h"
#include "littoral/polygon_soup.h"
#include "littoral/types.h"

namespace littoral {

struct PointOnTriangle {
  Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
};

/// Chooses triangles with probabilities in proportion to weights, and points on them uniformly.
class TriangleChoice {
 public:
  TriangleChoice() = default;
  /// Uniform over the area. Throws InputError for a surface without area.
  static TriangleChoice by_area(const PolygonSoup& triangles);
  /// By area times how far apart the normals of the corners are, which are the means about them;
  /// uniform where all are parallel.
  static TriangleChoice by_turn(const PolygonSoup& triangles);

  PointOnTriangle choose(RandomNumbers& random) const;

 private:
  template <class Factor>
  static TriangleChoice weighted(const PolygonSoup& triangles, const Factor& factor);

  const PolygonSoup* triangles_ = nullptr;
  std::vector<double> sums_;  // of weights, up to and with each triangle
};

}  // namespace littoral
