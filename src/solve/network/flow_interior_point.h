#pragma once
// An interior point method for L1 integration: close to the optimum in few steps, whatever the
// size.

#include "base/task.h"
#include "solve/network/l1_integration.h"

namespace littoral {

/// A nearly optimal pair. `x` covers the problem's arcs; `up` and `down` are the multipliers of
/// the bounds hi and lo (0 where a bound is infinite).
struct InteriorPoint {
  VecX s;            // nodes
  VecX x, up, down;  // arcs
  int iterations = 0;
};

/// Mehrotra's predictor-corrector method on the flow problem from x = 0; each step factors the
/// grounded Laplacian of the graph with weights 1 / theta. Stops at a relative gap of `tolerance`
/// or where round-off ends progress.
InteriorPoint interior_point(const L1Integration& problem, double tolerance, const Task& task);

}  // namespace littoral
