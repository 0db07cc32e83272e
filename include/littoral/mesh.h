#pragma once
// Surfaces: triangle and polygon meshes, point clouds, boundaries of voxels.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "littoral/polygon_soup.h"
#include "littoral/surface_point.h"
#include "littoral/types.h"
#include "littoral/volume.h"

namespace littoral {

struct SurfaceDomain;

/// A surface with its connectivity, immutable; copies share it. Nothing is merged, dropped or
/// repaired: nonmanifold edges, boundaries, several components, inconsistent orientation, isolated
/// vertices and degenerate faces are all allowed.
class Mesh {
 public:
  /// Throws InputError, naming the element, for a face of fewer than three corners, an index out of
  /// range or a vertex of a face that is not finite. A soup without faces is a point cloud.
  explicit Mesh(PolygonSoup soup);

  /// points: vertices x 3; faces: faces x corners by vertex from 0, of any integer type and storage
  /// order. Faces of fewer corners than columns end in -1.
  template <class P, class F>
  Mesh(const Eigen::MatrixBase<P>& points, const Eigen::MatrixBase<F>& faces)
      : Mesh(checked(points.template cast<double>(), faces.template cast<std::int64_t>())) {}

  /// A point cloud: points x 3, and normals x 3 or none, which are then estimated where needed.
  static Mesh cloud(const MatX3& points, const MatX3& normals = MatX3(0, 3));

  /// The boundary of the voxels that are not 0 (nodes of the grid, x fastest), with normals that do
  /// not know about the grid. Throws InputError where there is none and for spacings that are not
  /// positive.
  static Mesh voxels(const Grid& grid, const std::vector<unsigned char>& inside);

  /// "triangle mesh", "polygon mesh", "point cloud" or "voxel surface".
  std::string kind() const;
  int n_vertices() const;
  int n_faces() const;
  int n_edges() const;
  int n_components() const;
  const MatX3& points() const { return soup().points; }
  const PolygonSoup& soup() const;
  /// Edges x 2, by vertex, in the order in which SurfacePoint::on_edge counts them.
  const Rows<int, 2>& edges() const;
  Vec3 position(const SurfacePoint& point) const;

  /// A function given at the vertices, at any point of the surface: linear on edges and triangles.
  /// +inf where a vertex that counts has that value. Throws InputError for an element that does not
  /// exist or a wrong number of values.
  double interpolate(const VecX& values, const SurfacePoint& point) const;

  /// With one vertex for those that are close together: in their order, vertices no farther than
  /// `distance` [length] from the nearest of those kept before become that one; 0 joins those at
  /// one place. Faces with fewer than three corners left are dropped. Throws InputError for a
  /// distance that is negative or not finite.
  Mesh welded(double distance = 0) const;

  /// For the library's own layers.
  const SurfaceDomain& domain() const { return *domain_; }
  explicit Mesh(SurfaceDomain domain);

 private:
  using Integers = Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic>;
  static PolygonSoup checked(const MatX& points, const Integers& faces);

  std::shared_ptr<const SurfaceDomain> domain_;
};

}  // namespace littoral
