#pragma once
// Cutting a triangle mesh along segments, so that they run along edges. The surface stays the same.

#include <array>
#include <vector>

#include "domain/mesh/surface_mesh.h"
#include "littoral/surface_point.h"

namespace littoral {

/// A straight segment inside a face or along one of its sides, by barycentric coordinates in the
/// order of the face's corners; coordinates off the segment's element are exactly 0.
struct CutSegment {
  int face = 0;
  std::array<double, 3> a{}, b{};
};

/// The cut mesh and how it maps to the one it came from. Vertices of the input keep their numbers.
struct CutMesh {
  SurfaceMesh mesh;
  std::vector<int> parent_face;        // faces -> face of the input
  std::vector<SurfacePoint> point;     // vertices -> point of the input
  std::vector<std::vector<int>> path;  // segments: vertices from a to b, joined by edges
};

/// Cuts along all segments. Where segments cross inside a face they get a common vertex; ends
/// within 1e-9 of a side's length of each other, or of a vertex, are one. Faces that no segment
/// touches stay as they are, the others are triangulated without new vertices but for crossings
/// (and where a triangulation's edge cannot make way). Triangle meshes only.
CutMesh cut_mesh(const SurfaceMesh& mesh, const std::vector<CutSegment>& segments);

}  // namespace littoral
