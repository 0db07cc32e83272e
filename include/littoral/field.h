#pragma once
// Distance on a surface, as it is answered.

#include <optional>
#include <vector>

#include "littoral/mesh.h"
#include "littoral/report.h"
#include "littoral/sources.h"

namespace littoral {

/// Distance on a surface, and what the computation says about itself.
struct Field {
  Mesh mesh;
  Sources sources;
  VecX values;  // vertices of the mesh [length], +inf where no source reaches
  /// The surface that the field lives on where that is not the mesh itself: a finer one (quadratic
  /// elements), one split where values jump, or a cloud's triangles; with the scalar "distance".
  /// `values` are those at the mesh's own vertices all the same.
  std::optional<PolygonSoup> refined{};
  Report report;
  VecX confidence{};  // vertices of the mesh, 0 to 1: how sure the sign is; empty unless asked for

  /// Linear between the mesh's vertices [length].
  double at(const SurfacePoint& point) const { return mesh.interpolate(values, point); }

  /// The lines on which the field takes the value `level` [length]: nodes x 3, a closed line's
  /// first node repeated at the end; larger values on the left, seen from the face normals.
  std::vector<MatX3> isolines(double level) const;
};

}  // namespace littoral
