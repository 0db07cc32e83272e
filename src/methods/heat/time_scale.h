#pragma once
// Is the diffusion time long enough for the mesh?
//
// On obtuse cells the discrete heat equation also has solutions that change sign from node to node.
// They die out within a cell or so; where cells are large against sqrt(t), heat does that faster,
// and far from the source what changes sign is all there is: directions there mean nothing. They
// do not integrate either, so that the distance tells.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "base/task.h"
#include "littoral/report.h"
#include "operators/calculus.h"
#include "sources/systems/source_system.h"

namespace littoral {

/// Time scale used for sources on a domain where none is given: automatic_time_scale(system), and
/// for curves on meshes of more than 50,000 triangles up to 4 times as much. At scale 1 the
/// discrete kernel is anisotropic at its own scale, so that the error grows with the distance in
/// edges, and what larger scales round off is small on fine meshes.
double automatic_time_scale(const SourceSystem& system, const Operators& ops);
/// The same for curves on a mesh of so many triangles.
double automatic_time_scale_of_curves(double n_triangles);

/// Name of the residual that heat methods report: see misaligned_fraction.
inline constexpr const char* misaligned_area_fraction = "misaligned area fraction";

/// Share of the measure of all cells where phi (nodes) falls along the directions Y (2 cells) that
/// it was integrated from. Meshes of a few thousand cells and more stay below tolerable_share, but
/// for curves with gaps; directions that mean nothing give several times as much.
double misaligned_fraction(const Calculus& C, const VecX& phi, const VecX& Y);

/// The other measure of how good an answer is, which needs no other answer: the share of the
/// measure of the same cells where the gradient's length is more than a quarter off 1.
inline constexpr const char* off_unit_area_fraction = "area fraction with gradient off unit length";
inline constexpr double off_unit_by = 0.25;
/// Reports both.
void report_gradient(const Calculus& C, const VecX& phi, const VecX& Y, Report& report);
/// The same share of all cells that a source reaches, of any dimension.
double off_unit_fraction(const Calculus& C, const VecX& phi);
/// Warns, with what that means and what helps (without a stop), where the gradient of an answer is
/// off unit length on more of the surface than meshes and sources for which the method is right
/// have shown.
void warn_off_unit(const std::string& meaning, Report& report);
inline constexpr double tolerable_share = 0.005;
/// What is asked for on a mesh that has shown more: half-way, directions may be smooth and wrong.
inline constexpr double settled_share = 0.001;

/// May a scale that was not given (0) be raised? Vectors at nodes do not show what makes it rise
/// elsewhere, and unsigned curves are wrong there at larger ones.
inline bool may_rise(double given_scale, const Operators& ops) {
  return given_scale == 0 && !ops.vector.at_nodes;
}

/// How often the scale is raised, and what share of the share a raise must leave no more of.
inline constexpr int most_raises = 3;
inline constexpr double least_gain = 0.25;

/// The share that a solve has put into its report.
double misaligned_fraction(const Report& report);

/// The warning that the scale was raised, with the shares before and after.
std::string raised_warning(double from, double to, double share_before, double share_after);

/// Warns where a given time scale does not suit the mesh or the sources.
void warn_misaligned(Report& report);

/// Solves with `method` and, where that leaves more than the tolerable share, with what `longer`
/// gives for 4, 16 and 64 times the time scale, as long as that makes the share 4 times smaller:
/// sources that contradict each other do not agree at larger scales. time_scale becomes that of the
/// answer; a raised scale is a warning in the report.
template <class Method>
VecX solve_raising(
    std::shared_ptr<const Method> method,
    const std::function<std::shared_ptr<const Method>(double scale, const Task&)>& longer,
    double& time_scale, const std::function<VecX(const Method&, const Task&, Report&)>& solve,
    Task task, Report& report) {
  Report best;
  VecX phi = solve(*method, task.stage(0.4, "solving"), best);
  const double first = misaligned_fraction(best), given = time_scale;
  double scale = given;
  for (int k = 0; k < most_raises && first > tolerable_share; ++k) {
    if (misaligned_fraction(best) <= settled_share) break;
    scale *= 4;
    Task again = task.stage(0.2, "longer diffusion");
    Report other;
    method = longer(scale, again.stage(0.5, "factoring"));
    VecX psi = solve(*method, again.stage(1, "solving"), other);
    if (!(misaligned_fraction(other) < least_gain * misaligned_fraction(best))) continue;
    phi = std::move(psi);
    best = std::move(other);
    time_scale = scale;
  }
  report.merge(best);
  if (time_scale > given)
    report.warn("time-scale-raised",
                raised_warning(given, time_scale, first, misaligned_fraction(best)));
  return phi;
}

}  // namespace littoral
