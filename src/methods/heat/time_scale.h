#pragma once
// Is the diffusion time long enough for the mesh?
//
// On obtuse cells the discrete heat equation also has solutions that change sign from node to node.
// They die out within a cell or so; where cells are large against sqrt(t), heat does that faster,
// and far from the source what changes sign is all there is: directions there mean nothing. They
// do not integrate either, so that the distance tells.

#include <functional>
#include <string>
#include <type_traits>
#include <utility>

#include "base/report.h"
#include "base/task.h"
#include "operators/calculus.h"
#include "sources/source_terms.h"

namespace littoral {

/// Time scale used for sources on a domain where none is given: automatic_time_scale(terms), and
/// for curves on meshes of more than 50,000 triangles up to 4 times as much. At scale 1 the
/// discrete kernel is anisotropic at its own scale, so that the error grows with the distance in
/// edges, and what larger scales round off is small on fine meshes.
double automatic_time_scale(const SourceTerms& terms, const Operators& ops);

/// Name of the residual that heat methods report: see share_against.
inline constexpr const char* against_directions = "slope against directions";

/// Share of the measure of all cells where phi (nodes) falls along the directions Y (2 cells) that
/// it was integrated from. Meshes of a few thousand cells and more stay below tolerable_share, but
/// for curves with gaps; directions that mean nothing give several times as much.
double share_against(const Calculus& C, const VecX& phi, const VecX& Y);
inline constexpr double tolerable_share = 0.005;
/// What is asked for on a mesh that has shown more: half-way, directions may be smooth and wrong.
inline constexpr double settled_share = 0.001;

/// The share that a solve has put into its report.
double share_against(const Report& report);

/// The warning that the scale was raised, with the shares before and after.
std::string raised_warning(double from, double to, double share_before, double share_after);

/// Warns where a given time scale does not suit the mesh or the sources.
void warn_against(Report& report);

/// Solves with `method` and, where that leaves more than the tolerable share, with its
/// `with_time_scale` of 4, 16 and 64 times as much, as long as that makes the share 4 times
/// smaller: sources that contradict each other do not agree at larger scales. method and
/// time_scale become those of the answer; a raised scale is a warning in the report.
template <class Method>
VecX solve_raising(
    Method& method, double& time_scale,
    const std::type_identity_t<std::function<VecX(const Method&, const Task&, Report&)>>& solve,
    Task task, Report& report) {
  constexpr int most_raises = 3;
  Report best;
  VecX phi = solve(method, task.stage(0.4, "solving"), best);
  const double first = share_against(best), given = time_scale;
  double scale = given;
  for (int k = 0; k < most_raises && first > tolerable_share; ++k) {
    if (share_against(best) <= settled_share) break;
    scale *= 4;
    Task again = task.stage(0.2, "longer diffusion");
    Report other;
    Method longer = method.with_time_scale(scale, again.stage(0.5, "factoring"));
    VecX psi = solve(longer, again.stage(1, "solving"), other);
    if (!(share_against(other) < 0.25 * share_against(best))) continue;
    method = std::move(longer);
    phi = std::move(psi);
    best = std::move(other);
    time_scale = scale;
  }
  report.merge(best);
  if (time_scale > given)
    report.warn(raised_warning(given, time_scale, first, share_against(best)));
  return phi;
}

}  // namespace littoral
