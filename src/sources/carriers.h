#pragma once
// How the vectors of a source get onto the carriers of a discretization; the rest of a source's
// terms is the same for all of them.

#include <span>
#include <utility>
#include <vector>

#include "operators/triangles.h"
#include "sources/pieces.h"
#include "sources/source_terms.h"

namespace littoral {

/// A vector for one carrier, in its frame.
using CarrierVector = std::pair<int, Complex>;

/// A contribution of an unsigned curve, and the side of the curve to which it points.
struct Push {
  int carrier;
  Complex z;
  bool left;
};

/// The vectors of sources on a triangle mesh, for carriers of some kind. Lengths in T.unit.
class Carriers {
 public:
  virtual ~Carriers() = default;
  virtual int count() const = 0;
  /// Length times normal of a signed piece, integrated against the carriers' functions (eq. 11).
  virtual void add_signed(const CurvePiece& piece, std::vector<CarrierVector>& out) const = 0;
  /// Length times the direction away from the piece, for carriers beside it (A.2, type A).
  virtual void add_unsigned(const CurvePiece& piece, std::vector<Push>& out) const = 0;
  /// Radial vectors of total mass `weight` around a point, restricted to the listed triangles
  /// (eq. 19).
  virtual void add_radial(std::span<const PointInFace> where, double weight,
                          std::vector<CarrierVector>& out) const = 0;
};

/// Terms of curves and points placed on a triangle mesh, with nodes at its vertices. Throws
/// InputError if no source lies on a face with three different vertices.
SourceTerms source_terms(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                         const PreparedSources& sources, const Carriers& carriers);

}  // namespace littoral
