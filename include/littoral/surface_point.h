#pragma once
// A point on a surface, named by the element it lies in.

#include <array>
#include <vector>

namespace littoral {

/// A vertex, a point (1-t) A + t B of edge AB, or a barycentric point of a triangle.
struct SurfacePoint {
  enum class On { vertex, edge, face };
  On on = On::vertex;
  int element = 0;                   // vertex, edge or face number (0-based)
  std::array<double, 3> b{1, 0, 0};  // edge: {1-t, t} along the edge's direction; face: per corner

  static SurfacePoint at_vertex(int v) { return {On::vertex, v, {1, 0, 0}}; }
  static SurfacePoint on_edge(int e, double t) { return {On::edge, e, {1 - t, t, 0}}; }
  static SurfacePoint in_face(int f, double a, double b, double c) {
    return {On::face, f, {a, b, c}};
  }
};

}  // namespace littoral
