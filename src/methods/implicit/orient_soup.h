#pragma once
// Faces turned so that they bound something, whatever their own orientation says.

#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// What becomes of a soup of faces.
struct OrientedSoup {
  MatX3i faces{0, 3};        // those that bound, turned outward; each once
  double turned = 0;         // share of the area whose faces were turned
  double surely_turned = 0;  // of that, where hardly a line disagrees
  double left_out = 0;       // share of the area that bounds nothing: sheets, walls within
  double certainty = 0;      // mean over the area of what bounds: 1 where all lines agree
};

/// Orients a soup by the parity of lines, which takes no notice of the orientation that is there.
///
/// Faces with the same corners become one. Faces joined by edges of two faces are a part, turned to
/// agree within it. Lines in fixed directions through places on a part tell on which side it has
/// the inside: the one towards which an odd number of faces is passed. Lines that pass an odd
/// number on both sides or on none have passed a hole, or the part does not bound; parts of which
/// that is so for most lines, or whose lines disagree, are left out. (The idea of voting by parity:
/// Takayama et al., "A Simple Method for Correcting Facet Orientations", 2014.) points: n x 3,
/// about unit size; faces: m x 3, finite corners.
OrientedSoup orient_soup(const MatX3& points, const MatX3i& faces, const Task& task);

}  // namespace littoral
