#pragma once
// Winding numbers on a surface: from a mesh and curves to regions.

#include <memory>
#include <string>
#include <vector>

#include "api/method.h"
#include "base/task.h"
#include "domain/mesh/cut_mesh.h"
#include "domain/mesh/surface_mesh.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/sources.h"
#include "methods/winding/surface_winding.h"

namespace littoral {

/// Polylines on the surface, in space, each in its direction of travel.
using Polylines = std::vector<MatX3>;

/// Regions, and the curves that do and do not bound them.
struct WindingAnswer {
  VecXi region;                    // faces of the input: winding number of the larger part of each
  CutMesh cut;                     // the mesh on which the curves run along edges
  WindingNumbers numbers;          // on the triangles of the cut mesh
  FaceTriangles triangle_of_face;  // faces of the cut mesh -> triangle of `numbers`, or -1
  /// The cut mesh split where values jump. Scalars at vertices: "winding", "region" and "weight":
  /// within a triangle the winding number function is sum(b winding weight) / sum(b weight), which
  /// at the ends of curves, of weight 0, takes every value (projective interpolation).
  PolygonSoup shown;
  Polylines bounding, nonbounding, completed;
};

/// Triangle meshes as the domain of surface winding numbers. Components without a curve are one
/// region, 0. A solve reports sizes, seconds, the residual's gap, and the lengths of the curves
/// found.
struct WindingDomain {
  using Sources = littoral::Sources;
  using Answer = WindingAnswer;
  static constexpr const char* title = "Inside and outside on surfaces";

  std::shared_ptr<const SurfaceMesh> mesh;

  std::string kind() const;
};

template <>
std::vector<Method<WindingDomain>> library_methods();

/// The curves that bound regions, on the input mesh: sources without what has no inside (6.4.1).
Sources bounding_sources(const WindingAnswer& answer);

}  // namespace littoral
