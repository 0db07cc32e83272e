#pragma once
// Curves that run along edges, on a mesh cut so that they do.

#include "domain/mesh/cut_mesh.h"
#include "sources/surface/pieces.h"

namespace littoral {

/// The mesh, cut where curves cross faces, and how often the curves run along each of its edges
/// (against them: negative).
struct ConformingCurves {
  CutMesh cut;
  VecX times;           // edges of the cut mesh
  bool is_cut = false;  // false: the mesh is the given one
};

/// The pieces that have sides: of signed curves.
std::vector<CurvePiece> pieces_with_sides(const PlacedSources& sources);

/// The same, with a warning that counts the others. Throws InputError if none remains.
std::vector<CurvePiece> signed_pieces(const PlacedSources& sources, Report& report);

/// Signed curves as a chain of edges, each to the right of where phi > 0 as its first face lies.
/// Parts of one edge that no other follows are halved, because ends of curves carry no jump.
ConformingCurves conform(const SurfaceMesh& mesh, const std::vector<CurvePiece>& pieces);

}  // namespace littoral
