#pragma once
// Surfaces whose vectors live at nodes: polygon meshes, point clouds, voxel surfaces.

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "domain/mesh/surface_mesh.h"

namespace littoral {

/// Nodes with normals; triangles between them, on which functions are linear once they have been
/// interpolated from the nodes; and triangles in space, on which sources are placed.
///
/// The nodes are the first vertices of `refined`. A patch is what vectors are carried across as if
/// it were flat: a polygon, a surfel, or one triangle of a point cloud.
struct NodalSurface {
  std::string domain;                                   // "polygon mesh"
  std::shared_ptr<const SurfaceMesh> refined;           // triangles that sources are placed on
  std::shared_ptr<const IntrinsicTriangulation> place;  // the same by lengths, with components
  std::shared_ptr<const IntrinsicTriangulation> cells;  // triangles that fields are linear on
  Eigen::SparseMatrix<double, Eigen::RowMajor> P;  // vertices of `refined` x nodes; rows sum to 1
  std::vector<int> face_offsets;  // faces of the input + 1, into faces of `refined`; or empty
  double spacing = 0;             // mean distance between neighbouring nodes [units]
  VecX weight;                    // cells; share of each in the surface (1 unless cells overlap)

  MatX3 normals{0, 3};             // nodes x 3, unit
  std::vector<int> patch_offsets;  // patches + 1, into cells
  MatX3 patch_normals{0, 3};       // patches x 3, unit

  int n_nodes() const { return P.cols(); }
  int n_patches() const { return patch_offsets.size() - 1; }
};

/// A unit vector orthogonal to the unit vector n: the real axis of the tangent plane there.
Vec3 tangent_axis(const Vec3& n);

/// Vector v, orthogonal to unit vector a, turned by the smallest rotation that takes a to unit
/// vector b (about their cross product; about an arbitrary axis if they are opposite).
Vec3 turned(const Vec3& v, const Vec3& a, const Vec3& b);

/// One row per patch or node: v normalised, z where it is 0.
Vec3 normalized_or_z(const Vec3& v);

/// Area times normal of a triangle by the positions of its corners, turned as T orients it
/// [units^2].
Vec3 area_vector(const SurfaceMesh& refined, const IntrinsicTriangulation& T, int t);

/// Vertices x 3: sums of the area vectors around each vertex [units^2].
MatX3 vertex_area_vectors(const SurfaceMesh& refined, const IntrinsicTriangulation& T);

}  // namespace littoral
