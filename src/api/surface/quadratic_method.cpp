// Quadratic-order geodesics as an entry of the registry, without and with sign.

#include <functional>
#include <memory>

#include "api/surface/signed_quadratic.h"
#include "api/surface/subdivided.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/quadratic/quadratic.h"
#include "sources/completed_curves.h"
#include "sources/p2_sources.h"

namespace littoral {

namespace {

/// Distance from sources on a mesh, times `sign_at` (triangle, point) and `signs` (vertices).
using SignAt = std::function<double(int triangle, const Vec3& b)>;

SurfaceResult solved(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                     const PreparedSources& prepared, const QuadraticOptions& options,
                     const VecX& signs, const SignAt& sign_at, const Task& task, Report& report) {
  const auto sources = p2_sources(mesh, T, prepared, options.spacing);
  const Quadratic<2> method(std::make_shared<const P2Elements<2>>(p2_elements(T)));
  const QuadraticField<2> field = method.solve(sources, options, task, report);
  SurfaceResult result{field.at_vertices().cwiseProduct(signs), {}};
  const int n = static_cast<int>(options.subdivide);
  if (n > 1)
    result.shown = subdivided(mesh, T, n, result.values, [&](int triangle, const Vec3& b) {
      return sign_at(triangle, b) * field.distance(triangle, b);
    });
  return result;
}

SurfaceResult quadratic(const SurfaceProblem& problem, QuadraticOptions& options, Task& task,
                        Report& report) {
  if (options.is_signed) {
    Task heat_task = task.stage(0.3, "signed heat");
    const VecX phi = heat_methods().front().run(problem, {}, heat_task, report).values;
    report.options.clear();
    return signed_quadratic(problem, phi, options, task.stage(0.7, "squared distance"), report);
  }
  const PreparedSources prepared = prepared_sources(problem, task, report);
  const IntrinsicTriangulation T = [&] {
    const Stopwatch watch(report, "triangulation");
    return intrinsic_triangulation(problem.mesh, report);
  }();
  task.stage(0.03, "elements").checkpoint();
  return solved(
      problem.mesh, T, prepared, options, VecX::Ones(problem.mesh.n_vertices()),
      [](int, const Vec3&) { return 1.0; }, task.stage(0.92, "squared distance"), report);
}

}  // namespace

SurfaceResult signed_quadratic(const SurfaceProblem& problem, const VecX& phi,
                               const QuadraticOptions& options, Task task, Report& report) {
  const SurfaceMesh& mesh = problem.mesh;
  Report again;  // what can be said of mesh and sources was said when phi was made
  report.unreachable_components.clear();
  const PreparedSources given =
      prepare(mesh, problem.sources, problem.flip, again, task.stage(0.02, "placing the sources"));
  const PreparedSources completed = completed_curves(mesh, given, phi);
  report.sizes.emplace_back("completing_pieces",
                            static_cast<double>(completed.pieces.size() - given.pieces.size()));
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, again);
  const CurveSides sides(mesh, T, given, phi);
  return solved(
      mesh, T, completed, options, sides.at_vertices(),
      [&](int triangle, const Vec3& b) { return sides.at(triangle, b); },
      task.stage(0.98, "squared distance"), report);
}

std::vector<SurfaceMethod> quadratic_methods() {
  return {surface_method({"quadratic",
                          "Distance to points anywhere and curves, signed on request, of quadratic "
                          "order: the most accurate on coarse and badly shaped meshes.",
                          {"triangle mesh"},
                          {},
                          "Ruan, Chern, Li, Subr, Vaxman: Quadratic-Order Geodesics on Meshes"},
                         quadratic_options(), quadratic)};
}

}  // namespace littoral
