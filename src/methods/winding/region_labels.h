#pragma once
// Step 5: integer labels for the regions that curves bound.

#include <vector>

#include "base/task.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "methods/winding/jump_laplace.h"

namespace littoral {

/// What a winding number function is somewhere on a curve, and should be up to integers: 1/2.
struct CurveSample {
  int component;
  double value, weight;
};

/// A sample for every edge of a curve, weighted by length: the mean of both sides, plus 1/2 where
/// the curve counts an even number of times.
std::vector<CurveSample> samples_on_edges(const JumpCalculus& J, const CornerFunction& w,
                                          const VecX& curve);

/// The shift, per component, that makes w halfway between integers along the curve.
VecX contour_shift(const JumpCalculus& J, const std::vector<CurveSample>& samples, Contour contour);

/// Faces by rounding the mean of w + shift over their corners. faces.
VecXi rounded_labels(const JumpCalculus& J, const CornerFunction& w, const VecX& shift);

/// Integer labels W that minimise sum_e weight_e |W_left - W_right - jump_e| for integer jumps: the
/// cheapest completion of a curve, or part of it, to one that bounds. Also across `pairs`, weighted
/// by their edges. Exact. faces.
VecXi cut_labels(const JumpCalculus& J, const VecX& jump, const std::vector<FacePair>& pairs,
                 const VecX& weight, const Task& task, Report& report);

/// Subtracts a constant on each component so that the label of the largest area (of two, the one
/// nearer zero) is 0. Reversing the curve then reverses the labels.
void label_outside_zero(const JumpCalculus& J, VecXi& region);

}  // namespace littoral
