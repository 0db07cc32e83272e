#pragma once
// Winding numbers of curves through faces on the mesh as it is (thesis 6.4, eq. 6.3).

#include <array>
#include <vector>

#include "methods/winding/surface_winding.h"

namespace littoral {

/// A straight part of a curve in a face of a JumpCalculus, in its direction of travel. Parts along
/// an edge come once for every face there, each with its share of the length.
struct SegmentInFace {
  int face = 0;
  Complex vector;                  // from its start to its end, in the face's frame; shared length
  std::array<double, 3> middle{};  // barycentric
};

/// Delta u = div (N mu_Gamma): u is continuous, so the jump is smeared over the faces that the
/// curve passes. Labels are for faces, by rounding; curves that bound nothing are left in, with a
/// warning where there may be any. `u` and `w` are the same but for a constant. Throws SolveError,
/// Cancelled.
WindingNumbers nonconforming_winding(const JumpCalculus& J,
                                     const std::vector<SegmentInFace>& segments,
                                     const SurfaceWinding& options, Task task, Report& report);

}  // namespace littoral
