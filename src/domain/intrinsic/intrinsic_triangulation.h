#pragma once
// A triangle mesh as the operators see it: connectivity, side lengths and frames, no coordinates.

#include <cstdint>
#include <vector>

#include "base/shared_rows.h"
#include "base/triangle.h"
#include "domain/intrinsic/face_triangles.h"
#include "domain/mesh/surface_mesh.h"
#include "littoral/report.h"
#include "littoral/types.h"

namespace littoral {

/// Triangles glued along edges. Lengths are in `unit`s, a power of two near the size of the mesh,
/// so that no scale of the input can overflow or underflow what is computed from them.
///
/// Frames. Face f has a complex frame: real axis along its side 0, imaginary axis to its left if
/// orientation[f] = +1, to its right if -1. Orientations are chosen consistent over every
/// orientable patch, by majority of area, so that a few flipped faces do not matter; on a patch
/// that is not orientable they are the given ones. An edge's frame has its real axis along the edge
/// and its imaginary axis to the left as its first face sees it. Where a face's frame disagrees
/// with its edge's about that side (a seam), coordinates change by conjugation as well as rotation.
struct IntrinsicTriangulation {
  double unit = 1;  // [length] of one unit in the input's coordinates
  int n_vertices = 0;
  SharedRows<int, 3> faces;              // triangles x 3, vertices
  SharedRows<int, 3> side_edge;          // triangles x 3, edge of side k
  Rows<std::int8_t, 3> along{0, 3};      // triangles x 3, +1 if side k runs along its edge, else -1
  MatX3 length{0, 3};                    // triangles x 3, side lengths, strictly a triangle
  std::vector<std::int8_t> orientation;  // triangles, +1 or -1
  Rows<std::uint8_t, 3> seams{0, 3};     // triangles x 3, frames differ by a reflection; or none
  SharedRows<int, 2> edges;              // edges x 2, tail and head
  std::vector<std::uint8_t> edge_use;    // edges: number of triangles (255 = that many or more)
  double mean_edge_length = 0;           // over edges with a triangle, units
  std::vector<int> component;            // per vertex; -1 without a triangle
  int n_components = 0;
  FaceTriangles triangle_of_face;  // of the mesh; -1 where a vertex is repeated

  int n_faces() const { return static_cast<int>(faces.rows()); }
  int n_edges() const { return static_cast<int>(edges.rows()); }
  bool has_seams() const { return seams.rows() > 0; }
  bool seam(Eigen::Index f, int k) const { return has_seams() && seams(f, k) != 0; }

  /// Layout of a face in its own frame.
  TriangleShape shape(int f) const {
    return triangle_shape(length(f, 0), length(f, 1), length(f, 2), orientation[f] < 0);
  }
  /// Direction of the edge at side k, in the frame of face f.
  Complex edge_in_face(const TriangleShape& t, int f, int k) const {
    return double(along(f, k)) * t.side[k];
  }
  /// A vector of face f in the frame of the edge at its side k.
  Complex face_to_edge(const TriangleShape& t, int f, int k, Complex z) const {
    z *= std::conj(edge_in_face(t, f, k));
    return seam(f, k) ? std::conj(z) : z;
  }
};

/// Lengths, frames and components of a triangle mesh. Faces that repeat a vertex are left out;
/// faces that violate the strict triangle inequality by position (needles, collinear or coincident
/// corners) get their own sides lengthened by up to 1e-10 of the longest, which moves no other
/// face. Each such repair is counted in a warning. Throws UnsupportedError for polygon meshes and
/// InputError for meshes without a face or without extent.
IntrinsicTriangulation intrinsic_triangulation(const SurfaceMesh& mesh, Report& report);

}  // namespace littoral
