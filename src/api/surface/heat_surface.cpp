#include "api/surface/heat_surface.h"

#include <algorithm>
#include <string>

#include "base/stopwatch.h"
#include "domain/mesh/covering_mesh.h"
#include "methods/heat/time_scale.h"
#include "operators/triangles.h"
#include "sources/curves/conform.h"
#include "sources/surface/retriangulate_sources.h"
#include "sources/surface/source_values.h"
#include "sources/systems/triangle_source_system.h"

namespace littoral {

struct RetriangulatedSurface::Made {
  SurfaceMesh mesh;
  IntrinsicTriangulation T;
  PlacedSources sources;
  std::shared_ptr<const Operators> ops;
};

HeatProblem RetriangulatedSurface::problem(
    const Sources& sources, const std::function<Diffused(const PlacedSources&)>& needs,
    bool& shared, Task& task, Report& report) const {
  const PlacedSources placed =
      place_sources(domain_, sources, task.stage(0.02, "placing the sources"), report);
  warn_of_shadowed(*domain_.mesh, *T_, placed, report);
  const Diffused diffused = needs(placed);
  const Task stage = task.stage(0.08, "operators");
  stage.checkpoint();
  shared = placed.pieces.empty() &&
           std::all_of(placed.points.begin(), placed.points.end(),
                       [](const SurfacePoint& p) { return p.on == SurfacePoint::On::vertex; });
  if (shared) {
    const auto made = [&] { return made_for(PlacedSources{}, diffused, report, stage); };
    const auto fine = (diffused == Diffused::vectors ? for_vectors_ : for_functions_).get(made);
    return {fine->ops, source_system(fine->mesh, fine->T, placed)};
  }
  const Made fine = made_for(placed, diffused, report, stage);
  return {fine.ops, source_system(fine.mesh, fine.T, fine.sources)};
}

RetriangulatedSurface::Made RetriangulatedSurface::made_for(const PlacedSources& placed,
                                                            Diffused diffused, Report& report,
                                                            const Task& task) const {
  Retriangulated fine = [&] {
    const Stopwatch watch(report, "retriangulation");
    const bool nonmanifold =
        std::any_of(T_->edge_use.begin(), T_->edge_use.end(), [](int n) { return n > 2; });
    if (diffused == Diffused::vectors || !nonmanifold)
      return retriangulated(*domain_.mesh, *T_, placed, {}, report, task);
    const CoveringMesh cover = covering_mesh(*domain_.mesh, *T_);
    return retriangulated(cover.mesh, cover.T, covering_sources(*domain_.mesh, *T_, cover, placed),
                          {}, report, task);
  }();
  const Stopwatch watch(report, "operators");
  auto ops = std::make_shared<const Operators>(triangle_operators(fine.T));
  return {std::move(fine.mesh), std::move(fine.T), std::move(fine.sources), std::move(ops)};
}

std::unique_ptr<BesideMarching> HeatSurface::marching(const Sources& sources, SolveHint hint,
                                                      const Task& task) const {
  const auto& T = plain_ ? plain_->triangulation() : fine_->given();
  if (!T || hint != SolveHint::single_rhs || domain_.kind() != "triangle mesh") return nullptr;
  Report quiet;  // they have been placed before
  PlacedSources placed = place_sources(domain_, sources, task, quiet);
  if (!value_range(sources).same() && !pieces_with_sides(placed).empty()) return nullptr;
  return std::make_unique<BesideMarching>(*domain_.mesh, *T, std::move(placed));
}

void HeatSurface::check(BesideMarching* marching, const VecX& phi, const Task& task,
                        Report& report) const {
  const std::size_t before = report.warnings.size();
  const bool triangles = domain_.kind() == "triangle mesh" || domain_.kind() == "polygon mesh";
  warn_off_unit(
      "the distance is not right there. " +
          std::string(triangles ? "Method auto measures exactly; otherwise finer or more even "
                                  "triangles help, as by option intrinsic-delaunay"
                                : "A finer surface helps"),
      report);
  if (!marching) return;
  const double mean = marching->report(at_input(phi).values, task, report);
  if (report.warnings.size() == before) warn_beside_marching(mean, report);
}

}  // namespace littoral
