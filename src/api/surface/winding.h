#pragma once
// Winding numbers on a surface in one call: from a mesh and curves to regions.

#include <string>
#include <vector>

#include "api/registry.h"
#include "api/surface/surface_method.h"
#include "base/report.h"
#include "base/task.h"
#include "domain/mesh/cut_mesh.h"
#include "domain/mesh/polygon_soup.h"
#include "domain/mesh/surface_mesh.h"
#include "methods/winding/surface_winding.h"
#include "sources/surface_sources.h"

namespace littoral {

/// What to compute, in words.
struct WindingRequest {
  OptionTexts options;  // name, value as text; others default
  bool flip = false;    // reverse every curve
};

/// Polylines on the surface, in space, each in its direction of travel.
using Polylines = std::vector<MatX3>;

/// Regions, and the curves that do and do not bound them.
struct WindingAnswer {
  VecXi region;            // faces of the input: winding number of the larger part of each
  CutMesh cut;             // the mesh on which the curves run along edges
  WindingNumbers numbers;  // on the triangles of the cut mesh
  std::vector<int> triangle_of_face;  // faces of the cut mesh -> triangle of `numbers`, or -1
  /// The cut mesh torn where values jump. Scalars at vertices: "winding", "region" and "weight":
  /// within a triangle the winding number function is sum(b winding weight) / sum(b weight), which
  /// at the ends of curves, of weight 0, takes every value (projective interpolation).
  PolygonSoup shown;
  Polylines bounding, nonbounding, completed;
};

/// What the world may know about the method and its options.
const MethodInfo& winding_method();

/// Throws InputError if an option is unknown or out of range.
void check_request(const WindingRequest& request);

/// Surface winding numbers of signed curves. Components of the mesh without a curve are one region,
/// 0. The report gets the sizes, seconds, the residual's gap, and the lengths of the curves found.
/// Throws InputError and UnsupportedError for bad input, SolveError, Cancelled.
WindingAnswer surface_winding(const SurfaceMesh& mesh, const SurfaceSources& sources,
                              const WindingRequest& request, Task task, Report& report);

/// The curves that bound regions, on the input mesh: sources without what has no inside (6.4.1).
SurfaceSources bounding_sources(const WindingAnswer& answer);

}  // namespace littoral
