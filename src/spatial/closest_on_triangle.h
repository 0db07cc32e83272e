#pragma once
// The point of one triangle nearest to the origin.

#include <array>

#include "littoral/types.h"

namespace littoral {

/// Foot of the perpendicular from a query to a triangle.
struct TriangleFoot {
  std::array<double, 3> barycentric{1, 0, 0};  // each in [0, 1], sum 1 to rounding
  Vec3 offset = Vec3::Zero();                  // foot minus query
  double squared = 0;                          // |offset|^2
};

/// Nearest point of the triangle with corners a, b, c, all given relative to the query.
///
/// Degenerate triangles fall back to their sides and corners. Sides are measured in an order that
/// depends on the coordinates only, so that triangles sharing a side agree to the last bit there.
TriangleFoot closest_on_triangle(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace littoral
