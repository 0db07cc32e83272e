// Complete, then measure: the default for distance in space.

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "api/space/filling.h"
#include "api/space/space_domain.h"
#include "api/space/thin_parts.h"
#include "api/space/tori_cloud.h"
#include "littoral/error.h"
#include "methods/implicit/completed.h"
#include "methods/implicit/completed_cloud.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

constexpr double around_cloud = 0.15;  // of its longest side: what completes it may bulge
constexpr double coarsest = 1.0 / 32, finest = 1.0 / 96;  // cells of its own grid, of that side
constexpr double room = 2;  // cells about the cloud that a given grid must have

/// The grid itself where it holds the cloud, otherwise one that does, coarse where there is none.
Grid grid_about(const MatX3& points, const Grid* given, double spacing) {
  const Vec3 low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const double longest = (high - low).maxCoeff();
  if (given) {
    const double h = given->spacing.maxCoeff();
    const Vec3 far = given->point(given->n[0] - 1, given->n[1] - 1, given->n[2] - 1);
    if ((low - given->origin).minCoeff() >= room * h && (far - high).minCoeff() >= room * h &&
        h <= coarsest * longest)
      return *given;
  }
  Grid grid;
  const double h =
      given ? std::clamp(spacing, finest * longest, coarsest * longest) : coarsest * longest;
  const double margin = around_cloud * longest;
  grid.spacing.setConstant(h);
  for (int a = 0; a < 3; ++a) {
    const double side = high[a] - low[a] + 2 * margin;
    grid.n[a] = static_cast<int>(std::ceil(side / h)) + 1;
    grid.origin[a] = (low[a] + high[a] - h * (grid.n[a] - 1)) / 2;
  }
  return grid;
}

/// Throws where values differ, as what completes an input has none.
void check_complete(const SpaceInput& input, const LevelPatch* patch) {
  if (input.values.empty() || (patch && patch->faces.rows() == 0)) return;
  throw UnsupportedError(std::string(input.is_cloud() ? "clouds" : "surfaces with holes") +
                         " of different values cannot be completed: methods winding and "
                         "closest-point measure to what is there, signed-heat takes level sets of "
                         "one function");
}

std::unique_ptr<const CompletedDistance> completed(const SpaceInput& input, const Grid* grid,
                                                   double spacing, Task task, Report& report) {
  if (!input.is_cloud()) {
    auto distance = std::make_unique<const CompletedSurface>(
        input.surface.points, input.triangles(), spacing, input.flipped, task, report);
    check_complete(input, &distance->patch());
    return distance;
  }
  check_complete(input, nullptr);
  Tori fit;
  fit.noisy = true;
  auto tori = fit_tori(input, fit, task.stage(0.2, "fitting"), report);
  const Grid about = grid_about(tori->points(), grid, spacing);
  return std::make_unique<const CompletedCloud>(std::move(tori), about,
                                                task.stage(0.8, "completing"), report);
}

PolygonSoup completion_of(const CompletedDistance& distance, const Frame& frame) {
  return soup_of(frame.global(distance.patch().points), distance.patch().faces);
}

SpaceAnswer on_nodes(const Grid& grid, const SpaceSources& sources, Task& task, Report& report) {
  const Frame frame(box_on_grid(sources.soup, grid));
  const Grid local = frame.local(grid);
  const double spacing = local.spacing.minCoeff();
  const SpaceInput input = make_input(sources, frame, spacing, task, report);
  auto distance = completed(input, &local, spacing, task.stage(0.35, "preparing"), report);
  const Stopwatch watch(report, "evaluate");
  SpaceAnswer answer;
  answer.at_nodes = distance->at_nodes(local, task.stage(0.6, "distance"), report);
  if (!input.is_cloud())
    warn_of_thin_parts(*distance, input.samples, local, answer.at_nodes, report);
  answer.at_nodes *= frame.unit;
  answer.completion = completion_of(*distance, frame);
  answer.function = placed(std::move(distance), frame);
  return answer;
}

SpaceAnswer anywhere(const SpaceSources& sources, Task& task, Report& report) {
  const Frame frame(bounding_box(sources.soup));
  const SpaceInput input = make_input(sources, frame, infinity, task, report);
  auto distance =
      completed(input, nullptr, frame.query_side(), task.stage(0.95, "preparing"), report);
  SpaceAnswer answer;
  answer.completion = completion_of(*distance, frame);
  answer.function = placed(std::move(distance), frame);
  return answer;
}

/// At the vertices of the tets and, not by way of these, at the nodes of the grid.
SpaceAnswer through_tets(const Grid& grid, const TetFilling& filling, const SpaceSources& sources,
                         Task& task, Report& report) {
  const Frame frame(box_on_grid(sources.soup, grid));
  const Grid local = frame.local(grid);
  const double spacing = local.spacing.minCoeff();
  const SpaceInput input = make_input(sources, frame, spacing, task, report);
  const TetMesh mesh = filled(input, local, filling, task.stage(0.2, "building tets"), report);
  const auto distance = completed(input, &local, spacing, task.stage(0.3, "preparing"), report);
  const Stopwatch watch(report, "evaluate");
  SpaceAnswer answer;
  answer.at_nodes = distance->at_nodes(local, task.stage(0.6, "distance"), report) * frame.unit;
  answer.tets = {
      {frame.global(mesh.points), mesh.tets},
      evaluate(*distance, mesh.points, nullptr, task.stage(0.9, "distance")) * frame.unit};
  answer.completion = completion_of(*distance, frame);
  return answer;
}

}  // namespace

std::vector<Method<SpaceDomain>> automatic_space_methods() {
  static const OptionTable<SpaceAutomatic> none;
  return {make_method<SpaceDomain>(
      {SpaceAutomatic::method,
       "Distance to the input and to what closes its holes, negative inside; exact around closed "
       "surfaces.",
       {"grid", "set of points", "tet lattice", "tetgen mesh"},
       {},
       "surfaces: Barill et al.: Fast Winding Numbers for Soups and Clouds (2018); clouds: Feng: "
       "Generalized Distance and Winding (2026), chapter 5",
       true},
      none,
      [](const SpaceDomain& domain, const SpaceAutomatic&, SolveHint, const Task&, Report& report) {
        if (domain.grid) {
          check_grid(*domain.grid);
          report.sizes.emplace_back("nodes", static_cast<double>(domain.grid->n_nodes()));
        }
        return [domain](const SpaceSources& sources, SpaceAutomatic&, Task& task, Report& r) {
          if (!domain.grid) return anywhere(sources, task, r);
          return domain.tets ? through_tets(*domain.grid, *domain.tets, sources, task, r)
                             : on_nodes(*domain.grid, sources, task, r);
        };
      })};
}

}  // namespace littoral
