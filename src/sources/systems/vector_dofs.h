#pragma once
// How the vectors of a source get onto the dofs of a discretization; the rest of a source system
// is the same for all of them.

#include <span>
#include <utility>
#include <vector>

#include "operators/triangles.h"
#include "sources/surface/pieces.h"
#include "sources/systems/source_system.h"

namespace littoral {

/// A contribution of an unsigned curve, and the side of the curve to which it points.
struct SidedContribution {
  int dof;
  Complex z;
  bool left;
};

/// The vectors of sources on a triangle mesh, for dofs of some kind. Lengths in T.unit.
class VectorDofs {
 public:
  virtual ~VectorDofs() = default;
  /// Length times normal of a signed piece, integrated against the dofs' functions (eq. 11).
  virtual void add_signed(const CurvePiece& piece, std::vector<DofVector>& out) const = 0;
  /// Length times the direction away from the piece, for dofs beside it (A.2, type A).
  virtual void add_unsigned(const CurvePiece& piece, std::vector<SidedContribution>& out) const = 0;
  /// Radial vectors of total mass `weight` around a point, restricted to the listed triangles
  /// (eq. 19).
  virtual void add_radial(std::span<const PointInFace> where, double weight,
                          std::vector<DofVector>& out) const = 0;
};

/// The system of curves and points placed on a triangle mesh, with nodes at its vertices. `d0` and
/// `near` are left empty unless asked for. Throws InputError if no source lies on a face with three
/// different vertices.
SourceSystem source_system(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                           const PlacedSources& sources, const VectorDofs& dofs,
                           bool exact_near_points = true);

}  // namespace littoral
