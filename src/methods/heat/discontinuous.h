#pragma once
// Signed distance that may jump, to curves that bound nothing (Feng and Crane 2024, section 7.2).

#include <array>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "operators/jump_calculus.h"

namespace littoral {

/// A function with values at corners, and where it is split.
struct DiscontinuousField {
  MatX3 phi{0, 3};       // faces x 3, units of the triangulation
  MatX3i piece{0, 3};    // faces x 3: corners at one vertex with one number share their value
  VecX jump;             // edges, left minus right, or largest minus least, before smoothing
  double objective = 0;  // of eq. 16
  double gap = 0;        // relative, certified
};

/// A point of a face where the function should be 0.
struct HeldPoint {
  int face;
  std::array<double, 3> b;
  double weight;  // what a value of 1 costs; a jump of 1 costs the length of the edge
};

/// Where the function should be 0: at a price, and at corners that stay 0 while jumps are smoothed
/// (face, corner).
struct HeldSource {
  std::vector<HeldPoint> points;
  std::vector<std::array<int, 2>> corners;
};

/// Eq. 15: how much the unit vectors of the faces at an edge differ along it; of three or more, at
/// most. edges.
VecX edge_curl(const JumpCalculus& J, const VecX& Y);

/// Step III by eq. 16: Y (2 faces, unit vectors in the faces' frames) integrated exactly in every
/// face, with the least jumps across edges, which cost |edge| exp(-|curl|). Where three or more
/// faces meet each jumps from a value of the edge's own; faces that touch at a vertex only agree
/// there (`vertex`: faces x 3) as far as that costs nothing else. `held` may be empty. Jumps below
/// `jump_threshold` [units] are then closed by heat flow for time `t` (figure 12) on the surface
/// split at the others; t = 0: left as they are.
DiscontinuousField integrate_discontinuous(const JumpCalculus& J, const MatX3i& vertex,
                                           const VecX& Y, const HeldSource& held,
                                           double jump_threshold, double t, const Task& task,
                                           Report& report);

/// misaligned_fraction (time_scale.h) of values at corners.
double misaligned_fraction(const JumpCalculus& J, const MatX3& phi, const VecX& Y);

}  // namespace littoral
