#pragma once
// A surface mesh with its connectivity: polygons over points, any topology, immutable.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/groups.h"
#include "base/large_vector.h"
#include "base/lazy.h"
#include "base/shared_rows.h"
#include "domain/mesh/vertex_faces.h"
#include "littoral/polygon_soup.h"
#include "littoral/surface_point.h"
#include "littoral/types.h"

namespace littoral {

struct FaceOrientation;  // face_orientation.h

/// Faces, edges and their incidences. Nonmanifold edges and vertices, boundary, several components,
/// inconsistent orientation, isolated vertices and degenerate faces are all allowed. Copies share
/// everything.
///
/// Side k of face f runs from its corner k to corner k+1. Edges are numbered in the order in which
/// the sides of face 0, face 1, ... first meet them, and directed as that first side.
class SurfaceMesh {
 public:
  /// Builds the connectivity. Throws InputError if a face has fewer than three corners or a vertex
  /// used by a face is not finite (naming it). Unused non-finite vertices are allowed.
  explicit SurfaceMesh(PolygonSoup soup);
  /// The same with the edges given: sides are one edge if their numbers in `edge_of_side` (per
  /// corner, any numbers from 0) are the same, so that several edges may join two vertices. No face
  /// may have two sides with the same ends.
  SurfaceMesh(PolygonSoup soup, const std::vector<int>& edge_of_side);

  int n_vertices() const { return soup().n_vertices(); }
  int n_faces() const { return soup().n_faces(); }
  int n_edges() const { return parts_->edges.rows(); }
  bool is_triangle_mesh() const { return parts_->triangles; }

  const PolygonSoup& soup() const { return parts_->soup; }
  const MatX3& points() const { return soup().points; }
  std::span<const int> face(int f) const { return soup().face(f); }
  bool has_distinct_corners(int f) const {  // of a triangle
    const auto c = face(f);
    return c[0] != c[1] && c[1] != c[2] && c[2] != c[0];
  }
  Vec3 point(int v) const { return soup().points.row(v); }
  Vec3 position(const SurfacePoint& p) const;

  const Rows<int, 2>& edges() const { return parts_->edges; }  // edges x 2, tail and head
  int side_edge(int f, int k) const { return parts_->side_edge[soup().face_offsets[f] + k]; }
  bool side_along(int f, int k) const {  // does side k run along its edge's direction?
    return edges()(side_edge(f, k), 0) == face(f)[k];
  }
  SharedRows<int, 2> shared_edges() const;
  /// Of a triangle mesh: corners of its faces and edges of their sides.
  SharedRows<int, 3> shared_faces() const;
  SharedRows<int, 3> shared_side_edges() const;
  /// Faces at an edge, ascending; a face appears once for each of its sides on the edge.
  std::span<const int> edge_faces(int e) const { return parts_->edge_faces.at(e); }
  /// Faces at a vertex, the same way for its corners; found when they are first asked for.
  std::span<const int> vertex_faces(int v) const { return parts_->vertex_faces.at(v); }
  /// An edge between two vertices, or -1.
  int find_edge(int a, int b) const;
  /// Component of each vertex, by shared faces; -1 for vertices without a face.
  const std::vector<int>& vertex_component() const { return parts_->vertex_component; }
  int n_components() const { return parts_->n_components; }
  /// A power of two near the largest coordinate of a face; 1 without one.
  double scale() const { return parts_->scale; }
  /// Kept by `face_orientation`.
  const Kept<FaceOrientation>& kept_orientation() const { return parts_->orientation; }

 private:
  struct Parts {
    explicit Parts(PolygonSoup of);
    /// first_side: per corner, the first side of the same edge.
    void connect(std::span<const int> first_side);
    void number_edges(std::span<const int> first_side);
    void find_edge_faces();
    void find_components();

    PolygonSoup soup;
    bool triangles = true;
    Rows<int, 2> edges;
    LargeVector<int> side_edge;  // per corner
    Groups<int> edge_faces;      // edge -> faces
    VertexFaces vertex_faces{soup};
    std::vector<int> vertex_component;
    int n_components = 0;
    double scale = 1;
    Kept<FaceOrientation> orientation;
  };

  std::shared_ptr<const Parts> parts_;
};

}  // namespace littoral
