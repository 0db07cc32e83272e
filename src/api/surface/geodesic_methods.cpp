// Exact polyhedral distance and fast marching, as entries of the registry.

#include <algorithm>

#include "api/surface/surface_method.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/geodesic/exact_polyhedral.h"
#include "methods/geodesic/fast_marching.h"
#include "sources/triangle_sources.h"

namespace littoral {

namespace {

struct NoOptions {};

const OptionTable<NoOptions>& no_options() {
  static const OptionTable<NoOptions> table;
  return table;
}

template <class Method>
SurfaceResult walk(Method method, const SurfaceProblem& problem, Task& task, Report& report) {
  const PreparedSources prepared = prepared_sources(problem, task, report);
  task.checkpoint();
  const auto [T, sources] = [&] {
    const Stopwatch watch(report, "triangulation");
    IntrinsicTriangulation made = intrinsic_triangulation(problem.mesh, report);
    TriangleSources placed = triangle_sources(problem.mesh, made, prepared);
    return std::pair(std::move(made), std::move(placed));
  }();
  task.stage(0.08, "triangulation").checkpoint();
  const Stopwatch watch(report, "solve");
  return {method(T, sources, task.stage(0.9, "walking over the mesh"), report), {}};
}

SurfaceResult exact(const SurfaceProblem& problem, NoOptions&, Task& task, Report& report) {
  const SurfaceSources& given = problem.sources;
  auto is_signed = [](const auto& curve) { return curve.is_signed; };
  if (std::any_of(given.curves.begin(), given.curves.end(), is_signed) ||
      std::any_of(given.space_curves.begin(), given.space_curves.end(), is_signed))
    report.warn("exact distance is unsigned: signed curves count as unsigned ones");
  return walk(exact_polyhedral, problem, task, report);
}

SurfaceResult marching(const SurfaceProblem& problem, NoOptions&, Task& task, Report& report) {
  return walk(fast_marching, problem, task, report);
}

}  // namespace

std::vector<SurfaceMethod> geodesic_methods() {
  return {surface_method({"exact",
                          "Exact unsigned distance along the polyhedral surface to points and "
                          "curves.",
                          {"triangle mesh"},
                          {},
                          "Mitchell, Mount, Papadimitriou: The Discrete Geodesic Problem (1987)"},
                         no_options(), exact),
          surface_method({"fast-marching",
                          "First-order distance to points and unbroken curves, signed or not.",
                          {"triangle mesh"},
                          {},
                          "Kimmel, Sethian: Computing Geodesic Paths on Manifolds (1998)"},
                         no_options(), marching)};
}

}  // namespace littoral
