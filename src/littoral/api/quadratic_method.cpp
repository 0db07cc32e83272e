// Quadratic-order geodesics as an entry of the registry.

#include <memory>

#include "littoral/api/subdivided.h"
#include "littoral/api/surface_method.h"
#include "littoral/domain/intrinsic_triangulation.h"
#include "littoral/methods/quadratic.h"
#include "littoral/sources/p2_sources.h"

namespace littoral {

namespace {

SurfaceResult quadratic(const SurfaceProblem& problem, QuadraticOptions& options, Task& task,
                        Report& report) {
  const PreparedSources prepared = prepared_sources(problem, task, report);
  const IntrinsicTriangulation T = [&] {
    const Stopwatch watch(report, "triangulation");
    return intrinsic_triangulation(problem.mesh, report);
  }();
  task.stage(0.03, "elements").checkpoint();
  const auto sources = p2_sources(problem.mesh, T, prepared, options.spacing);
  const Quadratic<2> method(std::make_shared<const P2Elements<2>>(p2_elements(T)));
  const QuadraticField<2> field =
      method.solve(sources, options, task.stage(0.92, "squared distance"), report);
  SurfaceResult result{field.at_vertices(), {}};
  const int n = static_cast<int>(options.subdivide);
  if (n > 1)
    result.shown = subdivided(problem.mesh, T, n, result.values, [&](int triangle, const Vec3& b) {
      return field.distance(triangle, b);
    });
  return result;
}

}  // namespace

std::vector<SurfaceMethod> quadratic_methods() {
  return {
      surface_method({"quadratic",
                      "Unsigned distance to points anywhere and curves, of quadratic order: the "
                      "most accurate on coarse and badly shaped meshes.",
                      {"triangle mesh"},
                      {},
                      "Ruan, Chern, Li, Subr, Vaxman: Quadratic-Order Geodesics on Meshes"},
                     quadratic_options(), quadratic)};
}

}  // namespace littoral
