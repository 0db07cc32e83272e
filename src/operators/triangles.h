#pragma once
// Triangle meshes: Crouzeix-Raviart vectors on edges, linear functions on vertices.

#include <memory>

#include "base/task.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "operators/calculus.h"

namespace littoral {

/// Linear functions on the vertices of a triangle mesh, which is shared.
Calculus triangle_calculus(const std::shared_ptr<const IntrinsicTriangulation>& T,
                           const Task& task = {});

/// The operators of a triangle mesh (signed heat method, section 5). Vector dofs are edges, nodes
/// are vertices, cells are faces. The triangulation is shared, or copied.
Operators triangle_operators(const std::shared_ptr<const IntrinsicTriangulation>& T,
                             const Task& task = {});
Operators triangle_operators(const IntrinsicTriangulation& T);

/// A unit mass of outward radial unit vectors at a point of the mesh, restricted to the listed
/// triangles (eq. 19, generalised to points on edges and in faces): appended to `out` as (edge,
/// vector in the edge's frame) times `weight`. `corner_weights` are the point's barycentrics in
/// each triangle.
struct PointInFace {
  int face;
  std::array<double, 3> b;
};
void add_radial_measure(const IntrinsicTriangulation& T, std::span<const PointInFace> where,
                        double weight, std::vector<std::pair<int, Complex>>& out);

}  // namespace littoral
