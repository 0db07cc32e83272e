#pragma once
// Steps 3 and 4 of surface winding numbers: the harmonic part of a 1-form, and the function whose
// jumps it takes.

#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "operators/jump_calculus.h"
#include "solve/network/l1_integration.h"

namespace littoral {

/// gamma = omega - delta beta with Delta_2 beta = d omega: the closed part of omega (which has no
/// exact part if it is the Darboux derivative of a jump harmonic function). edges.
VecX harmonic_part(const JumpCalculus& J, const VecX& omega, const Task& task);

/// A function that is right up to jumps, and what the jumps cost.
struct ResidualFunction {
  MatX3 v{0, 3};         // faces x 3, values at corners
  VecX jump;             // edges, left minus right
  double objective = 0;  // sum of weight |jump|, weights as given
  double gap = 0;        // relative
  bool bounded = true;   // false: no function satisfies the bounds, and they were given up
};

/// A closed 1-form integrated inside every face, from 0 at its corner 0. faces x 3.
MatX3 integrate_locally(const JumpCalculus& J, const VecX& gamma);

/// min sum_e weight_e |jump_e| over functions that differ from `local` (faces x 3, corners) by one
/// constant per face, or per `part` if that is not empty (faces), lo <= jump <= hi (edges; or both
/// empty). Only faces with take[component] are shifted.
ResidualFunction integrate_jumps(const JumpCalculus& J, const MatX3& local, const VecX& weight,
                                 const VecX& lo, const VecX& hi, const std::vector<char>& take,
                                 const std::vector<int>& part, const L1Options& options,
                                 const Task& task, Report& report);

// The reduced-size integration of thesis 6.3: curves are completed by shortest paths first, and the
// residual function may jump across these and nowhere else.

/// Shortest paths along edges from ends of a chain (edges) to its starts, nearest pairs first; ends
/// on the boundary of the surface are left alone. 1 for every edge of a path. edges.
std::vector<char> completing_paths(const JumpCalculus& J, const VecX& curve, const Task& task);

/// A residual function whose jumps minimise sum_e weight_e |jump_e| among those that differ by one
/// constant per part of the surface between the completed curves. In each part gamma is integrated
/// from face to face outward from the curves, so that where it cannot be the jumps are far from
/// them.
ResidualFunction integrate_between_paths(const JumpCalculus& J, const VecX& gamma,
                                         const VecX& curve, const VecX& weight,
                                         const std::vector<char>& take, const Task& task,
                                         Report& report);

}  // namespace littoral
