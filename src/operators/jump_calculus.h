#pragma once
// Exterior calculus of functions that may jump across edges: values live on corners.

#include <array>
#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/types.h"

namespace littoral {

/// Triangles glued in pairs along edges, with what differential forms on them need. An edge runs
/// from its tail to its head; its left is where the mesh's orientation says. Corners of one vertex
/// that edges connect form a node; where several such fans touch at a vertex each is a node of its
/// own. All lengths are in units of the triangulation.
struct JumpCalculus {
  /// Side k of a face, from its corner k to k + 1; face -1: none.
  struct Side {
    int face = -1, k = 0;
  };

  int n_faces = 0, n_edges = 0, n_nodes = 0;
  MatX3i node{0, 3};                         // faces x 3, node of each corner
  MatX3i edge{0, 3};                         // faces x 3, edge at each side
  Rows<std::int8_t, 3> along{0, 3};          // faces x 3, +1 if the side runs along its edge
  std::vector<std::array<Side, 2>> sides;    // edges: left, right; one alone on the boundary
  std::vector<char> manifold;                // edges: 0 where three or more faces meet
  MatX3 weight{0, 3};                        // faces x 3, half the cotangent opposite each side
  std::vector<std::array<Complex, 3>> side;  // faces; each side as a vector in the face's frame
  VecX length, star1;                        // edges; length, Hodge star of 1-forms (clamped > 0)
  VecX area;                                 // faces
  std::vector<int> component;                // faces, connected by edges
  int n_components = 0;
  std::vector<char> simply_connected, orientable;  // components

  bool interior(int e) const { return sides[e][0].face >= 0 && sides[e][1].face >= 0; }
  /// The side of the other face at an edge of two faces; face -1 elsewhere.
  Side across(int f, int k) const;
  /// The corner of `at.face` at that end of side `at` where side k of f has corner `corner`.
  int corner_across(int f, int corner, const Side& at) const;
  /// Corners of side s at the tail and at the head of its edge.
  std::array<int, 2> ends(const Side& s) const;

  /// d of a 1-form: its sum round every face. edges -> faces.
  VecX d1(const VecX& omega) const;
  /// The transpose of d1. faces -> edges.
  VecX d1_transpose(const VecX& beta) const;
};

/// Two faces at an edge where three or more meet, and how a function jumps between them.
struct FacePair {
  int left = -1, right = -1, edge = -1;
  double jump = 0;   // left minus right
  double star1 = 1;  // as of an edge of these two faces
};

/// Throws nothing: edges of three or more faces are left unglued, `manifold` says where.
JumpCalculus jump_calculus(const IntrinsicTriangulation& T);

/// All pairs of faces at edges of three or more, without jumps. Throws UnsupportedError where more
/// than 64 faces meet at one edge.
std::vector<FacePair> pairs_at_nonmanifold_edges(const JumpCalculus& J);

}  // namespace littoral
