#pragma once
// How rays of sources inside a triangle leave it.

#include <array>
#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/geodesic/polyhedral_window.h"
#include "sources/surface/triangle_sources.h"

namespace littoral {

/// What a source inside a triangle reaches of it.
struct TriangleRays {
  struct Leaving {
    int side;  // 3 triangle + k
    Window w;  // in the side's own coordinates, with the triangle and the image above it
  };
  std::array<double, 3> corners{};  // distance
  std::vector<Leaving> leaving;
};

/// A source as the front meets it: a vertex, a point inside a triangle or a segment.
struct PolyhedralStart {
  double value;  // where the front is when it starts, >= 0
  int source;
  int vertex = -1;
  const PointInFace* point = nullptr;
  const TriangleSources::Segment* segment = nullptr;
};

/// All sources by their values less the least, which `least` is set to.
std::vector<PolyhedralStart> starts_of(const TriangleSources& sources, double& least);

/// Rays in every direction from a point, which lies on no side they leave through.
TriangleRays rays_of_point(const IntrinsicTriangulation& T, const PointInFace& where);

/// Rays perpendicular to a segment, to both sides, and distance to all of it. Its ends are points.
TriangleRays rays_of_segment(const IntrinsicTriangulation& T, const TriangleSources::Segment& s);

/// A window whose image (parallel: direction) and distance behind are given in a plane, in the
/// coordinates of a side that starts at `start` and runs along the unit vector `along`.
inline Window seen_from(const Window& w, Complex image, Complex start, Complex along) {
  Window v = w;
  const Complex z = (w.parallel ? image : image - start) * std::conj(along);
  if (w.parallel) v.behind += (std::conj(image) * start).real();
  v.x = z.real();
  v.y = z.imag();
  return v;
}

}  // namespace littoral
