#include "methods/winding/nonconforming_winding.h"

#include <cmath>

#include "base/stopwatch.h"

namespace littoral {

namespace {

/// +1 at corners on the left of a segment, -1 on its right, 0 on its line.
int side(const JumpCalculus& J, const SegmentInFace& s, int corner) {
  const std::array<Complex, 3> p = {0, J.side[s.face][0], -J.side[s.face][2]};
  Complex from = p[corner];
  for (int k = 0; k < 3; ++k) from -= s.middle[k] * p[k];
  const double turn = (std::conj(s.vector) * from).imag();
  if (std::abs(turn) < 1e-9 * J.area[s.face]) return 0;
  return turn > 0 ? 1 : -1;
}

}  // namespace

WindingNumbers nonconforming_winding(const JumpCalculus& J,
                                     const std::vector<SegmentInFace>& segments,
                                     const SurfaceWinding& options, Task task, Report& report) {
  WindingNumbers result;
  result.curve = result.nonbounding = result.bounding = VecX::Zero(J.n_edges);
  result.v = MatX3::Zero(J.n_faces, 3);

  // N mu_Gamma, a density on faces; u grows to the left of the curve.
  VecXc density = VecXc::Zero(J.n_faces);
  bool may_not_bound = false;
  for (const SegmentInFace& s : segments) {
    density[s.face] += Complex(0, 1) * s.vector / J.area[s.face];
    may_not_bound = may_not_bound || !J.simply_connected[J.component[s.face]];
  }
  if (may_not_bound && !options.keep_nonbounding)
    report.warn("nonbounding-kept",
                "formulation nonconforming: parts of curves that bound nothing are kept");
  {
    const Stopwatch watch(report, "Poisson");
    result.u = solve_jump_laplace(J, result.curve, density, Boundary::natural,
                                  task.stage(0.8, "Poisson"), report);
  }

  result.w = result.u;
  // On the curve u is anywhere between both sides, depending on where the curve passes the faces;
  // at their corners it is that of their side.
  std::vector<CurveSample> samples;
  for (const SegmentInFace& s : segments)
    for (int k = 0; k < 3; ++k)
      samples.push_back({J.component[s.face], result.w.u(s.face, k) - 0.5 * side(J, s, k),
                         std::abs(s.vector) / 3});
  const VecX shift = contour_shift(J, samples, options.contour);
  settle_labels(J, shift, rounded_labels(J, result.w, shift), result);
  return result;
}

}  // namespace littoral
