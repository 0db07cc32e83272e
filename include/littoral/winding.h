#pragma once
// Inside and outside on surfaces: regions that (broken) curves bound.

#include <vector>

#include "littoral/context.h"
#include "littoral/mesh.h"
#include "littoral/methods.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "littoral/sources.h"

namespace littoral {

/// Regions, and the curves that do and do not bound them.
struct Regions {
  Mesh mesh;
  VecXi region;  // faces of the mesh: the winding number of the larger part of each
  /// The mesh cut along the curves and split where values jump, with the scalars "winding",
  /// "region" and "weight": within a triangle the winding number function is
  /// sum(b winding weight) / sum(b weight).
  PolygonSoup surface;
  std::vector<MatX3> bounding, nonbounding, completed;  // polylines, nodes x 3
  Sources bounding_sources;                             // the curves that bound something
  Report report;
};

/// Surface winding numbers of signed curves on a triangle mesh. Components without a curve are one
/// region, 0. The default is SurfaceWinding{}. Throws InputError and UnsupportedError for bad
/// input, SolveError, Cancelled.
Regions winding(const Mesh& mesh, const Sources& curves, const AnyMethod& method = {},
                const Context& context = {});

}  // namespace littoral
