#pragma once
// Where curves end inside a surface, found without cutting it along them.

#include <cstddef>
#include <optional>
#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "domain/mesh/surface_mesh.h"
#include "sources/surface/pieces.h"

namespace littoral {

/// An end of a curve that no other goes on from: an odd number of curves share it.
struct OpenEnd {
  SurfacePoint at;  // as the curve has it
  int chain;        // the same for all that are joined at ends
};

/// More than these are not compared with one another.
constexpr std::size_t most_ends = 2000;

/// Ends of the curves that are marked (per curve), in an order that does not depend on theirs.
std::vector<OpenEnd> open_ends(const PlacedSources& sources, const std::vector<char>& marked);

/// Ends of signed curves that no other curve goes on from and that do not lie on the boundary of
/// the surface: a curve with one bounds nothing.
struct CurveEnds {
  std::vector<int> of_component;  // of the mesh
  double length = 0;              // of the curves [length]
};

/// None where cutting alone can tell: ends nearly at one place or beside a boundary or an edge of
/// three faces, and pieces along such an edge or in faces that were left out.
std::optional<CurveEnds> curve_ends(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                    const PlacedSources& sources);

}  // namespace littoral
