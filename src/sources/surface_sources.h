#pragma once
// What distance on a surface is measured from, as a person wrote it down.

#include <string>
#include <vector>

#include "base/types.h"
#include "domain/mesh/surface_point.h"

namespace littoral {

/// One drawn curve: nodes in the direction of travel. Consecutive nodes need not share a face (the
/// gap is traced). A closed curve repeats its first node at the end.
struct SurfaceCurve {
  std::vector<SurfacePoint> nodes;
  bool is_signed = true;  // signed: phi > 0 to the left of travel; unsigned: distance to both sides
  std::string origin;     // "file:line" of its first node, for messages
};

/// A curve in space, to be carried onto the surface by closest points.
struct SpaceCurve {
  MatX3 points{0, 3};  // nodes x 3
  bool is_signed = true;
  std::string origin;
};

/// A dual chain: faces, neighbours in this order; a winding number is larger by one on every face
/// than on the one before it.
struct FaceChain {
  std::vector<int> faces;
  std::string origin;
};

/// All sources of one problem, in any mixture.
struct SurfaceSources {
  std::vector<SurfaceCurve> curves;
  std::vector<SurfacePoint> points;  // unsigned isolated points
  std::vector<SpaceCurve> space_curves;
  std::vector<FaceChain> chains;  // for winding numbers only

  bool empty() const {
    return curves.empty() && points.empty() && space_curves.empty() && chains.empty();
  }
};

}  // namespace littoral
