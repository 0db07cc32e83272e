// Exact polyhedral distance and fast marching, as entries of the registry.

#include <algorithm>
#include <type_traits>

#include "api/surface/discretization.h"
#include "base/stopwatch.h"
#include "methods/geodesic/exact_polyhedral.h"
#include "methods/geodesic/fast_marching.h"
#include "methods/heat/time_scale.h"
#include "sources/surface/source_values.h"
#include "sources/surface/triangle_sources.h"

namespace littoral {

namespace {

/// A method that solves on the triangles themselves, from sources inside them.
template <class Options, class Run>
auto solve_on_triangles(const SurfaceDomain& domain, Run run, Report& report) {
  return [domain, T = triangulation_of(domain, report), run](
             const Sources& sources, Options& options, Task& task, Report& r) {
    const PlacedSources placed =
        place_sources(domain, sources, task.stage(0.05, "placing the sources"), r);
    const TriangleSources on = triangle_sources(*domain.mesh, *T, placed);
    const Stopwatch watch(r, "solve");
    SurfaceAnswer answer{run(*T, on, options, task.stage(0.95, "walking over the mesh"), r), {}};
    if (std::is_same_v<Options, Exact> && !value_range(sources).same())
      warn_of_shadowed(*T, on, placed, placed.n_curves, answer.values / T->unit, r);
    else
      warn_of_shadowed(*domain.mesh, *T, placed, r);
    return answer;
  };
}

bool has_sides(const Sources& given) {
  const auto is_signed = [](const auto& curve) { return curve.is_signed; };
  return std::any_of(given.curves.begin(), given.curves.end(), is_signed) ||
         std::any_of(given.space_curves.begin(), given.space_curves.end(), is_signed);
}

void warn_of_signs(const Sources& given, Report& report) {
  if (has_sides(given))
    report.warn("sign-ignored", "exact distance is unsigned: signed curves count as unsigned ones");
}

}  // namespace

std::vector<Method<SurfaceDomain>> geodesic_methods() {
  static const OptionTable<Exact> exact_options = OptionTable<Exact>().number(
      &Exact::tolerance, "tolerance", "share of a distance", 0, 0.01,
      "Every distance may be off by that share of it: on meshes of hundreds of thousands of "
      "triangles 1e-6 and 1e-5 are several times as fast as 0, exact.");
  static const OptionTable<FastMarching> marching_options;
  return {
      make_method<SurfaceDomain>(
          {Exact::method,
           "Exact unsigned distance along the polyhedral surface to points and curves.",
           {"triangle mesh"},
           {},
           "Mitchell, Mount, Papadimitriou: The Discrete Geodesic Problem (1987)",
           true},
          exact_options,
          [](const SurfaceDomain& domain, const Exact&, SolveHint, const Task&, Report& report) {
            const auto distance = [](const IntrinsicTriangulation& T, const TriangleSources& on,
                                     const Exact& options, const Task& task, Report& r) {
              return exact_polyhedral(T, on, task, r, {0, options.tolerance}).distance;
            };
            return [solve = solve_on_triangles<Exact>(domain, distance, report)](
                       const Sources& sources, Exact& options, Task& task, Report& r) {
              warn_of_signs(sources, r);
              return solve(sources, options, task, r);
            };
          }),
      make_method<SurfaceDomain>(
          {FastMarching::method,
           "First-order distance to points and unbroken curves, signed or not.",
           {"triangle mesh"},
           {},
           "Kimmel, Sethian: Computing Geodesic Paths on Manifolds (1998)",
           true},
          marching_options,
          [](const SurfaceDomain& domain, const FastMarching&, SolveHint, const Task&,
             Report& report) {
            const auto march = [](const IntrinsicTriangulation& T, const TriangleSources& on,
                                  const FastMarching&, const Task& task, Report& r) {
              VecX d = fast_marching(T, on, task, r);
              r.residuals.emplace_back(off_unit_area_fraction, off_unit_share(T, d));
              warn_off_unit(
                  "the distance may be off there. Method auto measures exactly; otherwise finer or "
                  "more even triangles help",
                  r);
              return d;
            };
            return [solve = solve_on_triangles<FastMarching>(domain, march, report)](
                       const Sources& sources, FastMarching& options, Task& task, Report& r) {
              if (!value_range(sources).same() && has_sides(sources))
                throw UnsupportedError(
                    "fast-marching takes different values of points and unsigned curves alone");
              return solve(sources, options, task, r);
            };
          })};
}

}  // namespace littoral
