#include "methods/winding/surface_winding.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/stopwatch.h"
#include "methods/winding/residual.h"

namespace littoral {

const OptionTable<SurfaceWinding>& winding_options() {
  using O = SurfaceWinding;
  static const OptionTable<O> table =
      OptionTable<O>()
          .choice(&O::formulation, "formulation", {"primal", "dual", "nonconforming"},
                  "Values at corners of the mesh cut along the curve; one per face, which also "
                  "works where three or more faces meet (chains of faces among the sources imply "
                  "it); or one per vertex of the mesh as it is, smeared across the curve.")
          .choice(&O::boundary_condition, "boundary-condition", {"natural", "free"},
                  "At the boundary of the surface the function is level across it, or goes on as "
                  "if there were no boundary.")
          .choice(&O::residual, "residual", {"faces", "paths"},
                  "Parts of the curve that bound nothing are found with one constant per face, "
                  "exactly, or one per part between curves completed by shortest paths.")
          .choice(&O::labels, "labels", {"round", "cut"},
                  "Labels by rounding the winding number function, or by the shortest integer "
                  "completion of the curve.")
          .choice(&O::contour, "contour", {"curve", "frequent", "mean"},
                  "Which value counts as halfway between integers: the circular mean along the "
                  "curve, the most frequent one, or the plain mean.")
          .number(&O::curve_weight, "curve-weight", "relative to elsewhere", 1e-6, 1,
                  "What a jump of the residual function along the curve costs; smaller values "
                  "make nonbounding parts follow the curve more closely.")
          .toggle(&O::keep_nonbounding, "keep-nonbounding",
                  "Leaves parts of the curve that bound nothing in: rounds the solution of the "
                  "jump Laplace equation as it is.")
          .toggle(&O::intrinsic_delaunay, "intrinsic-delaunay",
                  "Solves the jump Laplace equation on Delaunay triangles of the same surface, "
                  "got by flipping edges that the curve does not run along.");
  return table;
}

VecX bounding_part(const WindingNumbers& numbers) {
  VecX times = numbers.curve;
  for (Eigen::Index e = 0; e < times.size(); ++e)
    if (std::abs(numbers.nonbounding[e]) > 0.5 * std::abs(times[e])) times[e] = 0;
  return times;
}

void settle_labels(const JumpCalculus& J, const VecX& shift, VecXi region, WindingNumbers& result) {
  VecXi shifted = region;
  label_outside_zero(J, shifted);
  MatX3 label(J.n_faces, 3);
  for (int f = 0; f < J.n_faces; ++f) {
    result.w.u.row(f).array() += shift[J.component[f]] + shifted[f] - region[f];
    label.row(f).setConstant(shifted[f]);
  }
  result.region = std::move(shifted);
  result.completed = jump_derivative(J, label);
}

void label_regions(const JumpCalculus& J, const std::vector<FacePair>& pairs,
                   const SurfaceWinding& options, const Task& task, WindingNumbers& result,
                   Report& report) {
  const Stopwatch watch(report, "labels");
  const VecX shift =
      contour_shift(J, samples_on_edges(J, result.w, result.bounding), options.contour);
  const bool cut = options.labels == Labels::cut;
  settle_labels(J, shift,
                cut ? cut_labels(J, result.bounding, pairs, J.length, task, report)
                    : rounded_labels(J, result.w, shift),
                result);
}

CornerFunction WindingSolver::harmonic(const VecX& jump, Boundary boundary, const Task& task,
                                       Report& report) const {
  return fine_ ? solve_jump_laplace(*J_, *fine_, jump, boundary, task, report)
               : solve_jump_laplace(*J_, jump, {}, boundary, task, report);
}

WindingNumbers WindingSolver::solve(const VecX& curve, const SurfaceWinding& options, Task task,
                                    Report& report) const {
  const JumpCalculus& J = *J_;
  WindingNumbers result;
  result.curve = curve;
  for (int e = 0; e < J.n_edges; ++e)
    if (!J.interior(e)) result.curve[e] = 0;  // along the boundary nothing is on the other side
  result.nonbounding = VecX::Zero(J.n_edges);
  result.v = MatX3::Zero(J.n_faces, 3);

  // Step 1: u, eq. 6.2.
  {
    const Stopwatch watch(report, "jump Laplace");
    result.u = harmonic(result.curve, Boundary::natural, task.stage(0.2, "jump Laplace"), report);
  }
  // Steps 2 to 4, where there are curves that bound nothing.
  const bool simple = std::all_of(J.simply_connected.begin(), J.simply_connected.end(),
                                  [](char yes) { return yes; });
  result.bounding = result.curve;
  result.w = result.u;
  if (!options.keep_nonbounding && !simple) {
    decompose(result, options, task, report);
    result.bounding = bounding_part(result);
    // Step 5: w, eq. 6.2 with what is left of the curve.
    const Stopwatch watch(report, "winding function");
    result.w =
        harmonic(result.bounding, Boundary::natural, task.stage(0.6, "jump Laplace"), report);
  }

  if (options.boundary_condition == BoundaryCondition::free) {
    // At a straight or round boundary the image of the curve has one sign here, the other there.
    const Stopwatch watch(report, "level boundary");
    const CornerFunction level =
        harmonic(result.bounding, Boundary::level, task.stage(0.8, "jump Laplace"), report);
    result.w.u = 0.5 * (result.w.u + level.u);
  }
  label_regions(J, {}, options, task.stage(1, "labels"), result, report);
  return result;
}

void WindingSolver::decompose(WindingNumbers& result, const SurfaceWinding& options, Task& task,
                              Report& report) const {
  const JumpCalculus& J = *J_;
  // Step 2: omega = D u, and of it the harmonic part (6.1.2).
  const VecX omega = darboux_derivative(J, result.u);
  {
    const Stopwatch watch(report, "harmonic part");
    const bool closed = J.d1(omega).cwiseAbs().maxCoeff() < 1e-9;
    result.gamma = closed ? omega : harmonic_part(J, omega, task.stage(0.2, "harmonic part"));
  }
  if (result.gamma.cwiseAbs().maxCoeff() < 1e-9) return;  // u is of order 1: all curves bound
  // Step 3: v with the shortest jumps, least of all on the curve, and there at most those of u.
  const Stopwatch watch(report, "residual function");
  VecX weight = J.length;
  VecX lo = VecX::Constant(J.n_edges, -infinity), hi = -lo;
  for (int e = 0; e < J.n_edges; ++e) {
    if (result.curve[e] == 0) continue;
    weight[e] *= options.curve_weight;
    lo[e] = std::min(0.0, result.curve[e]);
    hi[e] = std::max(0.0, result.curve[e]);
  }
  std::vector<char> take(J.n_components);
  for (int c = 0; c < J.n_components; ++c) take[c] = !J.simply_connected[c];
  const Task integration = task.stage(0.7, "residual function");
  const ResidualFunction residual =
      options.residual == Residual::paths
          ? integrate_between_paths(J, result.gamma, result.curve, weight, take, integration,
                                    report)
          : integrate_jumps(J, integrate_locally(J, result.gamma), weight, lo, hi, take, {}, {},
                            integration, report);
  if (!residual.bounded) report.warn("curve-crosses-itself", unbounded_warning);
  for (int f = 0; f < J.n_faces; ++f)
    if (take[J.component[f]]) result.v.row(f) = residual.v.row(f);
  result.objective = residual.objective;
  result.gap = residual.gap;
  // Step 4: the part of the curve on which v jumps bounds nothing.
  for (int e = 0; e < J.n_edges; ++e)
    if (result.curve[e] != 0 && take[J.component[J.sides[e][0].face]] &&
        std::abs(residual.jump[e]) > 1e-7)
      result.nonbounding[e] = std::clamp(residual.jump[e], lo[e], hi[e]);
}

}  // namespace littoral
