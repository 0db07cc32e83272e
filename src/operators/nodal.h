#pragma once
// Operators with vectors at nodes, for every domain that is a nodal surface.

#include "domain/mesh/nodal_surface.h"
#include "operators/calculus.h"

namespace littoral {

/// A tangent plane with its frame: real axis x, imaginary axis y = n x x.
struct TangentFrame {
  Vec3 n, x, y;
  explicit TangentFrame(const Vec3& normal) : n(normal), x(tangent_axis(n)), y(n.cross(x)) {}
  /// A vector in space, projected to the plane.
  Complex coordinates(const Vec3& v) const { return {x.dot(v), y.dot(v)}; }
  /// The factor that takes coordinates in this frame into `other`'s by the smallest rotation.
  Complex turn_into(const TangentFrame& other) const;
};

/// The operators of a nodal surface (signed heat method, sections 8.3 to 8.5). Vector dofs are
/// nodes, cells are its triangles; on the patches L = P^T L_cells P, and the connection Laplacian
/// is the same with the vectors of the nodes turned into the patch's plane by the smallest
/// rotation: it is positive semidefinite whatever the weights, which L with its entries turned from
/// node to node (section 8.3) is only without negative cotangents.
Operators nodal_operators(const NodalSurface& S);

}  // namespace littoral
