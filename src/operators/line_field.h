#pragma once
// Directions without a sign on faces: from space into frames, and interpolated.

#include <utility>
#include <vector>

#include "base/task.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "domain/mesh/surface_mesh.h"

namespace littoral {

/// The tangential part of a vector in space, in the frame of triangle f (a face of `mesh`).
Complex tangent_part(const SurfaceMesh& mesh, const IntrinsicTriangulation& T, int mesh_face,
                     const Vec3& v);

/// Axes of all triangles in space (2 triangles x 3): real, imaginary.
MatX3 face_frames(const SurfaceMesh& mesh, const IntrinsicTriangulation& T);

/// The smoothest line field through given directions (triangle, unit vector in its frame): squares
/// of directions are interpolated by least Dirichlet energy, on edges (Crouzeix-Raviart), so that
/// v and -v are the same, and square roots taken on faces (power fields of degree 2: Pluta,
/// Edelstein, Vaxman, Ben-Chen, "PH-CPF", 2021, section 5.5.4). Unit vectors (2 triangles), 0 on
/// components without a direction.
VecX interpolate_line_field(const IntrinsicTriangulation& T,
                            const std::vector<std::pair<int, Complex>>& directions,
                            const Task& task);

}  // namespace littoral
