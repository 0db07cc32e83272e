// The heat methods, signed and unsigned, as entries of the registry.

#include <memory>
#include <optional>
#include <utility>

#include "littoral/api/discontinuous.h"
#include "littoral/api/surface_method.h"
#include "littoral/api/translated.h"
#include "littoral/base/error.h"
#include "littoral/domain/intrinsic_triangulation.h"
#include "littoral/methods/sharpen.h"
#include "littoral/methods/signed_heat.h"
#include "littoral/methods/unsigned_heat.h"
#include "littoral/operators/triangles.h"
#include "littoral/sources/carried_sources.h"
#include "littoral/sources/triangle_source_terms.h"

namespace littoral {

namespace {

void needs_triangles(const SurfaceProblem& problem, const std::string& option) {
  if (problem.domain() != "triangle mesh")
    throw UnsupportedError("option " + option + " works on triangle meshes, not on a " +
                           problem.domain());
}

/// Throws unless the options go with the domain and with each other.
void check_options(const SurfaceProblem& problem, const SignedHeatOptions& options) {
  if (options.discontinuous) needs_triangles(problem, "discontinuous");
  if (options.bounding_only) needs_triangles(problem, "bounding-only");
  if (options.discontinuous && options.intrinsic_delaunay)
    throw UnsupportedError(
        "options discontinuous and intrinsic-delaunay exclude each other: the surface is torn "
        "along its own edges");
}

Translated translate_triangles(const SurfaceProblem& problem, bool retriangulate, Task& task,
                               Report& report) {
  const PreparedSources prepared = prepared_sources(problem, task, report);
  task.checkpoint();
  IntrinsicTriangulation triangulation = [&] {
    const Stopwatch watch(report, "triangulation");
    return intrinsic_triangulation(problem.mesh, report);
  }();
  const Task stage = task.stage(0.03, "operators");
  stage.checkpoint();
  if (!retriangulate) {
    const Stopwatch watch(report, "operators");
    auto ops = std::make_shared<const Operators>(triangle_operators(triangulation));
    SourceTerms terms = source_terms(problem.mesh, triangulation, prepared);
    return {std::move(ops), std::move(terms), std::move(triangulation), nullptr};
  }
  const Retriangulated fine = [&] {
    const Stopwatch watch(report, "retriangulation");
    return retriangulated(problem.mesh, triangulation, prepared, {}, report, stage);
  }();
  const Stopwatch watch(report, "operators");
  auto ops = std::make_shared<const Operators>(triangle_operators(fine.T));
  return {std::move(ops), source_terms(fine.mesh, fine.T, fine.sources), std::nullopt, nullptr};
}

/// The problem as operators and source terms: the first 10 % of a task.
Translated translate(const SurfaceProblem& problem, bool retriangulate, Task& task,
                     Report& report) {
  const bool triangles = problem.domain() == "triangle mesh";
  if (retriangulate) needs_triangles(problem, "intrinsic-delaunay");
  Translated out = triangles ? translate_triangles(problem, retriangulate, task, report)
                             : translate_nodes(problem, task, report);
  task.stage(0.05, "heat method").checkpoint();
  return out;
}

SurfaceResult signed_heat(const SurfaceProblem& problem, SignedHeatOptions& options, Task& task,
                          Report& report) {
  check_options(problem, options);
  if (options.bounding_only) {
    const SurfaceSources kept =
        without_nonbounding(problem, task.stage(0.3, "bounding curves"), report);
    SignedHeatOptions all = options;
    all.bounding_only = false;
    SurfaceResult result = signed_heat({problem.mesh, kept}, all, task, report);
    options.time_scale = all.time_scale;
    return result;
  }
  if (options.sharpen && options.discontinuous)
    throw InputError("--sharpen makes a continuous distance; leave out --discontinuous");
  const auto [ops, terms, T, faces] = translate(problem, options.intrinsic_delaunay, task, report);
  if (options.time_scale == 0) options.time_scale = automatic_time_scale(terms);
  const auto method = [&, &operators = ops, &source = terms] {
    const Stopwatch watch(report, "factor");
    return SignedHeat(operators, options.time_scale, task.stage(0.65, "factoring"),
                      needed_diffusions(source, options), Expect::one_solve);
  }();
  if (options.discontinuous)
    return discontinuous_distance(problem.mesh, *T, *ops, terms, method, options, task, report);
  VecX phi = method.solve(terms, options, task.stage(0.25, "solving"), report);
  if (options.sharpen) {
    SharpenOptions how;
    how.solver = static_cast<SharpenSolver>(options.sharpen_solver);
    phi = sharpen(*ops, terms, phi, how, task.stage(1, "sharpening"), report);
  }
  return at_input(problem, faces.get(), phi);
}

SurfaceResult unsigned_heat(const SurfaceProblem& problem, UnsignedHeatOptions& options, Task& task,
                            Report& report) {
  const auto [ops, terms, T, faces] = translate(problem, options.intrinsic_delaunay, task, report);
  const auto method = [&, &operators = ops] {
    const Stopwatch watch(report, "factor");
    return UnsignedHeat(operators, options, task.stage(0.65, "factoring"), Expect::one_solve);
  }();
  const Stopwatch watch(report, "solve");
  return at_input(problem, faces.get(), method.solve(terms, task.stage(0.25, "solving"), report));
}

}  // namespace

std::vector<SurfaceMethod> heat_methods() {
  return {surface_method(
              {"signed-heat",
               "Signed distance to curves that may be broken, unsigned to points and unsigned "
               "curves.",
               all_surfaces(),
               {},
               "Feng, Crane: A Heat Method for Generalized Signed Distance (2024)"},
              signed_heat_options(), signed_heat),
          surface_method({"unsigned-heat",
                          "Unsigned distance to curves and points.",
                          all_surfaces(),
                          {},
                          "Crane, Weischedel, Wardetzky: Geodesics in Heat (2013)"},
                         unsigned_heat_options(), unsigned_heat)};
}

}  // namespace littoral
