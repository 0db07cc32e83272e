// The heat methods, signed and unsigned, as entries of the registry.

#include <memory>

#include "littoral/api/discontinuous.h"
#include "littoral/api/surface_method.h"
#include "littoral/domain/intrinsic_triangulation.h"
#include "littoral/methods/signed_heat.h"
#include "littoral/methods/unsigned_heat.h"
#include "littoral/operators/triangles.h"
#include "littoral/sources/triangle_source_terms.h"

namespace littoral {

namespace {

struct Translated {
  IntrinsicTriangulation triangulation;
  std::shared_ptr<const Operators> ops;
  SourceTerms terms;
};

/// The problem as operators and source terms: the first 10 % of a task.
Translated translate(const SurfaceProblem& problem, Task& task, Report& report) {
  const PreparedSources prepared = prepared_sources(problem, task, report);
  task.checkpoint();
  IntrinsicTriangulation triangulation = [&] {
    const Stopwatch watch(report, "triangulation");
    return intrinsic_triangulation(problem.mesh, report);
  }();
  task.stage(0.03, "operators").checkpoint();
  const Stopwatch watch(report, "operators");
  auto ops = std::make_shared<const Operators>(triangle_operators(triangulation));
  SourceTerms terms = source_terms(problem.mesh, triangulation, prepared);
  Translated out{std::move(triangulation), std::move(ops), std::move(terms)};
  task.stage(0.05, "heat method").checkpoint();
  return out;
}

SurfaceResult signed_heat(const SurfaceProblem& problem, SignedHeatOptions& options, Task& task,
                          Report& report) {
  if (options.bounding_only) {
    const SurfaceSources kept =
        without_nonbounding(problem, task.stage(0.3, "bounding curves"), report);
    SignedHeatOptions all = options;
    all.bounding_only = false;
    SurfaceResult result = signed_heat({problem.mesh, kept, false}, all, task, report);
    options.time_scale = all.time_scale;
    return result;
  }
  const auto [T, ops, terms] = translate(problem, task, report);
  if (options.time_scale == 0) options.time_scale = automatic_time_scale(terms);
  const auto method = [&, &operators = ops, &source = terms] {
    const Stopwatch watch(report, "factor");
    return SignedHeat(operators, options.time_scale, task.stage(0.65, "factoring"),
                      needed_diffusions(source, options), Expect::one_solve);
  }();
  if (options.discontinuous)
    return discontinuous_distance(problem.mesh, T, *ops, terms, method, options, task, report);
  return {method.solve(terms, options, task.stage(0.25, "solving"), report), {}};
}

SurfaceResult unsigned_heat(const SurfaceProblem& problem, UnsignedHeatOptions& options, Task& task,
                            Report& report) {
  const auto [T, ops, terms] = translate(problem, task, report);
  const auto method = [&, &operators = ops] {
    const Stopwatch watch(report, "factor");
    return UnsignedHeat(operators, options, task.stage(0.65, "factoring"), Expect::one_solve);
  }();
  const Stopwatch watch(report, "solve");
  return {method.solve(terms, task.stage(0.25, "solving"), report), {}};
}

}  // namespace

std::vector<SurfaceMethod> heat_methods() {
  return {surface_method(
              {"signed-heat",
               "Signed distance to curves that may be broken, unsigned to points and unsigned "
               "curves.",
               {"triangle mesh"},
               {},
               "Feng, Crane: A Heat Method for Generalized Signed Distance (2024)"},
              signed_heat_options(), signed_heat),
          surface_method({"unsigned-heat",
                          "Unsigned distance to curves and points.",
                          {"triangle mesh"},
                          {},
                          "Crane, Weischedel, Wardetzky: Geodesics in Heat (2013)"},
                         unsigned_heat_options(), unsigned_heat)};
}

}  // namespace littoral
