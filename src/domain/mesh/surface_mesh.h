#pragma once
// A surface mesh with its connectivity: polygons over points, any topology, immutable.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/lazy.h"
#include "littoral/polygon_soup.h"
#include "littoral/surface_point.h"
#include "littoral/types.h"

namespace littoral {

struct FaceOrientation;  // face_orientation.h

/// Faces, edges and their incidences. Nonmanifold edges and vertices, boundary, several components,
/// inconsistent orientation, isolated vertices and degenerate faces are all allowed.
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

  int n_vertices() const { return soup_.n_vertices(); }
  int n_faces() const { return soup_.n_faces(); }
  int n_edges() const { return edges_.rows(); }
  bool is_triangle_mesh() const { return triangles_; }

  const PolygonSoup& soup() const { return soup_; }
  const MatX3& points() const { return soup_.points; }
  std::span<const int> face(int f) const { return soup_.face(f); }
  bool has_distinct_corners(int f) const {  // of a triangle
    const auto c = face(f);
    return c[0] != c[1] && c[1] != c[2] && c[2] != c[0];
  }
  Vec3 point(int v) const { return soup_.points.row(v); }
  Vec3 position(const SurfacePoint& p) const;

  const Rows<int, 2>& edges() const { return edges_; }  // edges x 2, tail and head
  int side_edge(int f, int k) const { return side_edge_[soup_.face_offsets[f] + k]; }
  bool side_along(int f, int k) const {  // does side k run along its edge's direction?
    return edges_(side_edge(f, k), 0) == face(f)[k];
  }
  /// Faces at an edge, ascending; a face appears once for each of its sides on the edge.
  std::span<const int> edge_faces(int e) const {
    return {edge_faces_.data() + edge_offsets_[e], edge_faces_.data() + edge_offsets_[e + 1]};
  }
  std::span<const int> vertex_faces(int v) const {
    return {vertex_faces_.data() + vertex_offsets_[v],
            vertex_faces_.data() + vertex_offsets_[v + 1]};
  }
  /// An edge between two vertices, or -1.
  int find_edge(int a, int b) const;
  /// Component of each vertex, by shared faces; -1 for vertices without a face.
  const std::vector<int>& vertex_component() const { return vertex_component_; }
  int n_components() const { return n_components_; }
  /// A power of two near the largest coordinate of a face; 1 without one.
  double scale() const { return scale_; }
  /// Kept by `face_orientation`; copies share it.
  const Kept<FaceOrientation>& kept_orientation() const { return *orientation_; }

 private:
  void check();
  void connect(const std::vector<int>& first_side);
  void find_components();

  PolygonSoup soup_;
  bool triangles_ = true;
  Rows<int, 2> edges_;
  std::vector<int> side_edge_;                  // per corner
  std::vector<int> edge_offsets_, edge_faces_;  // edge -> faces
  std::vector<int> vertex_offsets_, vertex_faces_;
  std::vector<int> vertex_component_;
  int n_components_ = 0;
  double scale_ = 1;
  std::shared_ptr<const Kept<FaceOrientation>> orientation_;
};

}  // namespace littoral
