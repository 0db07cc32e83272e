#include "api/surface/quadratic_method.h"

#include "api/surface/discretization.h"
#include "api/surface/subdivided.h"
#include "sources/curves/completed_curves.h"
#include "sources/surface/p2_sources.h"

namespace littoral {

QuadraticOnSurface::QuadraticOnSurface(SurfaceDomain domain, Report& report)
    : domain_(std::move(domain)),
      T_(triangulation_of(domain_, report)),
      method_(std::make_shared<const QuadraticSolver<2>>(
          std::make_shared<const P2Elements<2>>(p2_elements(*T_)))) {}

SurfaceAnswer QuadraticOnSurface::solved(const PlacedSources& placed, const Quadratic& options,
                                         const VecX& signs, const SignAt& sign_at, const Task& task,
                                         Report& report) const {
  const SurfaceMesh& mesh = *domain_.mesh;
  const QuadraticField<2> field =
      method_->solve(p2_sources(mesh, *T_, placed, options.spacing), options, task, report);
  SurfaceAnswer answer{field.at_vertices().cwiseProduct(signs), {}};
  if (options.subdivide > 1)
    answer.shown =
        subdivided(mesh, *T_, options.subdivide, answer.values, [&](int triangle, const Vec3& b) {
          return sign_at(triangle, b) * field.distance(triangle, b);
        });
  return answer;
}

SurfaceAnswer QuadraticOnSurface::solve(const Sources& sources, const Quadratic& options, Task task,
                                        Report& report) const {
  const PlacedSources placed =
      place_sources(domain_, sources, task.stage(0.05, "placing the sources"), report);
  return solved(
      placed, options, VecX::Ones(domain_.mesh->n_vertices()), [](int, const Vec3&) { return 1.0; },
      task.stage(0.95, "squared distance"), report);
}

SurfaceAnswer QuadraticOnSurface::solve_signed(const Sources& sources, const VecX& phi,
                                               const Quadratic& options, Task task,
                                               Report& report) const {
  const SurfaceMesh& mesh = *domain_.mesh;
  Report again;  // what can be said of mesh and sources was said when phi was made
  report.unreachable_components.clear();
  const PlacedSources given =
      place_sources(mesh, sources, again, task.stage(0.02, "placing the sources"));
  const PlacedSources completed = completed_curves(mesh, given, phi);
  report.sizes.emplace_back("completing_pieces",
                            static_cast<double>(completed.pieces.size() - given.pieces.size()));
  const CurveSides sides(mesh, *T_, given, phi);
  return solved(
      completed, options, sides.at_vertices(),
      [&](int triangle, const Vec3& b) { return sides.at(triangle, b); },
      task.stage(0.98, "squared distance"), report);
}

namespace {

std::function<SurfaceAnswer(const Sources&, Quadratic&, Task&, Report&)> quadratic(
    const SurfaceDomain& domain, const Quadratic& given, SolveHint hint, const Task& task,
    Report& report) {
  const auto elements = std::make_shared<const QuadraticOnSurface>(domain, report);
  if (!given.is_signed)
    return [elements](const Sources& sources, Quadratic& options, Task& t, Report& r) {
      return elements->solve(sources, options, t, r);
    };
  Report again;  // the mesh has been spoken of
  const auto heat = prepare<SurfaceDomain>(SignedHeat{}, domain, hint, task, again);
  return [elements, heat](const Sources& sources, Quadratic& options, Task& t, Report& r) {
    const std::string name = r.method;
    const VecX phi = heat->solve(sources, t.stage(0.3, "signed heat"), r).values;
    r.method = name;
    r.options.clear();  // those of signed heat
    return elements->solve_signed(sources, phi, options, t.stage(0.7, "squared distance"), r);
  };
}

}  // namespace

std::vector<Method<SurfaceDomain>> quadratic_methods() {
  return {make_method<SurfaceDomain>(
      {Quadratic::method,
       "Distance to points anywhere and curves, signed on request, of quadratic order: the most "
       "accurate on coarse and badly shaped meshes.",
       {"triangle mesh"},
       {},
       "Ruan, Chern, Li, Subr, Vaxman: Quadratic-Order Geodesics on Meshes"},
      quadratic_options(), quadratic)};
}

}  // namespace littoral
