#pragma once
// Broken curves, completed by the zero set of a function that is positive to their left; and on
// which side of all of that a point lies.

#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "operators/p2.h"
#include "sources/surface/pieces.h"
#include "sources/surface/triangle_sources.h"

namespace littoral {

/// The sources with the zero set of phi (vertices; linear on triangles, +inf where undefined) where
/// it fills gaps: pieces beside a curve are left out, those beyond its ends and far from all curves
/// stay. They follow the given pieces, as curves of their own. Nothing is added if no curve is
/// signed.
PlacedSources completed_curves(const SurfaceMesh& mesh, const PlacedSources& sources,
                               const VecX& phi);

/// Appends the straight step between two points of one face (in their simplest form) as part of an
/// unsigned curve: of the last one if `goes_on`, else of a new one. False, and nothing appended,
/// where no face holds both or they coincide.
bool append_step(const SurfaceMesh& mesh, const SurfacePoint& p, const SurfacePoint& q,
                 bool goes_on, PlacedSources& to);

/// Signs: to the left (+1) or right (-1) of the nearest signed piece in triangles that hold one, of
/// phi elsewhere, and +1 everywhere if no curve is signed.
class CurveSides {
 public:
  /// `sources` as given, without completions.
  CurveSides(const SurfaceMesh& mesh, const IntrinsicTriangulation& T, const PlacedSources& sources,
             const VecX& phi);

  /// At a point of a triangle.
  double at(int triangle, const P2Shape<2>::Point& b) const;
  /// At the vertices (vertices).
  VecX at_vertices() const;

 private:
  struct Side {
    double distance;  // to the nearest piece
    double sign;
  };
  Side nearest(int triangle, const P2Shape<2>::Point& b) const;

  const IntrinsicTriangulation& T_;
  const VecX& phi_;
  std::vector<TriangleSources::Segment> segments_;  // by triangle
  std::vector<std::size_t> first_;                  // triangles + 1
};

}  // namespace littoral
