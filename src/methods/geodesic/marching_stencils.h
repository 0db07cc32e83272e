#pragma once
// From where marching fronts reach the vertices of triangles.

#include <cmath>
#include <complex>
#include <span>
#include <utility>
#include <vector>

#include "base/groups.h"
#include "base/index.h"
#include "base/task.h"
#include "base/triangle.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "domain/mesh/edge_sides.h"

namespace littoral {

/// How a front reaches a vertex from an edge: scalar products of the vectors from the vertex to the
/// end that is fixed last, and to the other one.
struct Products {
  double last, other, both;
};

/// Of the corner between sides of lengths `last` and `other`, across from `opposite`.
inline Products of_corner(double last, double other, double opposite) {
  return {last * last, other * other, 0.5 * law_of_cosines(last, other, opposite)};
}

/// A vertex v at an obtuse corner and an edge that it is reached from: one end, that of the
/// corner's own side, is a neighbour, the other was found by unfolding.
struct UnfoldedStencil {
  int v, side_end, in_front;
  double to_side_end, to_in_front, both;  // scalar products
};

/// Corners whose cosine is no larger are split as obtuse ones, so that rounding does not choose
/// among those of a grid.
inline constexpr double right_angle = 1e-9;

/// From where fronts reach vertices: from the side of each triangle across from them; where that is
/// seen at an obtuse angle, from two edges to a vertex in front, but not across curves with sides.
class Stencils {
 public:
  Stencils(const IntrinsicTriangulation& T, const std::vector<char>& with_sides, const Task& task)
      : T_(T), with_sides_(with_sides) {
    corners_ = groups_of<int>(std::size_t(T.n_vertices), [&](const auto& put) {
      for (int c = 0; c < 3 * T.n_faces(); ++c) put(T.faces(c / 3, c % 3), c);
    });
    unfold_obtuse(task);
  }

  /// Corners at a vertex: 3 f + k of triangle f.
  std::span<const int> corners_at(int v) const { return corners_.at(v); }
  /// Is the corner's vertex reached by unfolded stencils, not from the side across?
  bool unfolds(int f, int k) const { return unfolds_[3 * std::size_t(f) + k] != 0; }
  /// Unfolded stencils with an end at a vertex.
  template <class Body>
  void for_unfolded_at(int v, const Body& body) const {
    if (unfolded_.empty()) return;
    for (const int u : users_.at(v)) body(stencil(u / 2, u % 2));
  }

  int n_unsplit = 0;  // obtuse corners where the mesh ends before a vertex in front is found

 private:
  /// A corner whose vertex is reached from the edges between `in_front` and its sides' other ends:
  /// all that the triangle does not tell.
  struct UnfoldedCorner {
    int corner, in_front;
    double to_in_front, both[2];  // scalar products; with the ends of side k and of the one before
  };

  UnfoldedStencil stencil(int unfolded, int end) const {
    const UnfoldedCorner& c = unfolded_[unfolded];
    const int f = c.corner / 3, k = c.corner % 3;
    const double to_end = T_.length(f, end == 0 ? k : (k + 2) % 3);
    return {T_.faces(f, k), T_.faces(f, (k + 1 + end) % 3),
            c.in_front,     to_end * to_end,
            c.to_in_front,  c.both[end]};
  }

  void unfold_obtuse(const Task& task) {
    unfolds_.assign(corners_.members.size(), 0);
    EdgeSides sides;  // found where there is an obtuse corner
    for (int f = 0; f < T_.n_faces(); ++f) {
      if (f % 0x10000 == 0) task.checkpoint();
      for (int k = 0; k < 3; ++k) {
        const int k1 = (k + 1) % 3, k2 = (k + 2) % 3, v = T_.faces(f, k);
        const double slight = right_angle * T_.length(f, k) * T_.length(f, k2),
                     twice_dot =
                         law_of_cosines(T_.length(f, k), T_.length(f, k2), T_.length(f, k1));
        if (twice_dot > slight) continue;
        if (sides.begin.empty()) sides = edge_sides(T_);
        const TriangleShape t =
            triangle_shape(T_.length(f, k), T_.length(f, k1), T_.length(f, k2), false);
        const auto [d, D] = vertex_in_front(sides, f, k1, t.p[1], t.p[2]);  // v at 0
        if (d < 0 || d == v) {
          if (twice_dot < -slight) ++n_unsplit;
          continue;
        }
        unfolds_[3 * std::size_t(f) + k] = 1;
        unfolded_.push_back(
            {3 * f + k, d, std::norm(D), {plane::dot(t.p[1], D), plane::dot(t.p[2], D)}});
      }
    }
    if (unfolded_.empty()) return;
    users_ = groups_of<int>(std::size_t(T_.n_vertices), [&](const auto& put) {
      for (int u = 0; u < 2 * int_size(unfolded_); ++u) {
        const int c = unfolded_[u / 2].corner;
        put(T_.faces(c / 3, (c % 3 + 1 + u % 2) % 3), u);
        put(unfolded_[u / 2].in_front, u);
      }
    });
  }

  /// Unfolds the triangles beyond the side at A, B (counter-clockwise about 0, more than a right
  /// angle apart) until a corner lies at most a right angle from both: its vertex and position.
  std::pair<int, Complex> vertex_in_front(const EdgeSides& sides, int f, int k, Complex A,
                                          Complex B) const {
    const Complex middle = Complex(0, 1) * A / std::abs(A) - Complex(0, 1) * B / std::abs(B);
    Complex P = A, Q = B;     // ends of the edge about to be crossed
    bool starts_at_P = true;  // does side k of f?
    for (int step = 0; step < 64; ++step) {
      const auto at = sides.at(T_.side_edge(f, k));
      if (at.size() != 2) break;
      const TriangleSide next = at[0] == TriangleSide(f, k) ? at[1] : at[0];
      if (T_.along(next.face(), next.k()) != T_.along(f, k)) starts_at_P = !starts_at_P;
      if (with_sides_[f] || with_sides_[next.face()]) break;
      f = next.face();
      k = next.k();
      const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      const Complex apex =
          triangle_shape(T_.length(f, k), T_.length(f, k1), T_.length(f, k2), false).p[2];
      const double along = starts_at_P ? apex.real() : T_.length(f, k) - apex.real();
      const Complex R = P + (Q - P) / std::abs(Q - P) * Complex(along, -apex.imag());
      if (plane::dot(A, R) >= 0 && plane::dot(B, R) >= 0) return {T_.faces(f, k2), R};
      // On through the edge that the ray midway between the two right angles crosses.
      const bool through_PR = plane::cross(middle, R) > 0;
      (through_PR ? Q : P) = R;
      k = through_PR == starts_at_P ? k2 : k1;
      starts_at_P = !starts_at_P;
    }
    return {-1, 0};
  }

  const IntrinsicTriangulation& T_;
  const std::vector<char>& with_sides_;  // triangles
  Groups<int> corners_;                  // vertices
  std::vector<char> unfolds_;            // corners
  std::vector<UnfoldedCorner> unfolded_;
  Groups<int> users_;  // vertices; unfolded stencils, two of each corner
};

}  // namespace littoral
