#pragma once
// Surface winding numbers (Feng, Gillespie and Crane 2023; thesis chapter 6): which regions a messy
// set of curves bounds on a surface of any topology, and which curves bound nothing.

#include <memory>
#include <vector>

#include "base/option_table.h"
#include "base/task.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "methods/winding/jump_laplace.h"
#include "operators/jump_calculus.h"

namespace littoral {

/// Names, ranges, defaults and one sentence for each of the above.
const OptionTable<SurfaceWinding>& winding_options();

/// Everything the five steps find. Edge vectors are jumps, left minus right.
struct WindingNumbers {
  CornerFunction u;      // solution of the jump Laplace equation, faces x 3
  VecX gamma;            // edges, harmonic part of its Darboux derivative; empty: not needed
  MatX3 v{0, 3};         // residual function, faces x 3; 0 on simply connected components
  CornerFunction w;      // winding number function, faces x 3, shifted so that rounding it labels
  VecXi region;          // faces, integer winding number; 0 covers most of each component
  VecX curve;            // edges, the input
  VecX nonbounding;      // edges, share of the curve that bounds nothing
  VecX bounding;         // edges, the curve where less than half of it bounds nothing
  VecX completed;        // edges, jumps of `region`: the closed curve that bounds the regions
  double objective = 0;  // of the residual function, in units of length
  double gap = 0;
};

inline constexpr const char* unbounded_warning =
    "the curve crosses itself so that jumps of the residual function could not be bounded by the "
    "curve's";

/// Step 4: the edges of the curve, whole, that are not rather nonbounding than bounding.
VecX bounding_part(const WindingNumbers& numbers);

/// Labels w shifted by `shift` (components) as `region` says, and all that follows from it; 0 is
/// made the outside.
void settle_labels(const JumpCalculus& J, const VecX& shift, VecXi region, WindingNumbers& result);

/// Step 5: labels for given `w` and `bounding`. `pairs`: of the dual formulation, or none.
void label_regions(const JumpCalculus& J, const std::vector<FacePair>& pairs,
                   const SurfaceWinding& options, const Task& task, WindingNumbers& result,
                   Report& report);

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

/// One surface's winding numbers; const and usable from several threads.
class WindingSolver {
 public:
  /// fine: triangles on which the jump Laplace equation is solved instead, with edges of the
  /// curves that will be given kept; or none.
  explicit WindingSolver(std::shared_ptr<const JumpCalculus> J,
                         std::shared_ptr<const DelaunayJumps> fine = nullptr)
      : J_(std::move(J)), fine_(std::move(fine)) {}

  /// `curve` (edges): how often the curve runs along each edge, against counted negative; so the
  /// winding number is larger by that on the left. The report gets residuals and iterations, and
  /// the components without a curve; labels there are 0.
  WindingNumbers solve(const VecX& curve, const SurfaceWinding& options, Task task,
                       Report& report) const;

 private:
  void decompose(WindingNumbers& result, const SurfaceWinding& options, Task& task,
                 Report& report) const;

  CornerFunction harmonic(const VecX& jump, Boundary boundary, const Task& task,
                          Report& report) const;

  std::shared_ptr<const JumpCalculus> J_;
  std::shared_ptr<const DelaunayJumps> fine_;
};

}  // namespace littoral
