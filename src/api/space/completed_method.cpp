// Distance to surfaces that are completed first, as an entry of the registry.

#include <memory>
#include <utility>

#include "api/space/space_domain.h"
#include "littoral/error.h"
#include "methods/implicit/completed.h"

namespace littoral {

namespace {

std::unique_ptr<const CompletedDistance> completed(const SpaceInput& input, double spacing,
                                                   const Task& task, Report& report) {
  if (input.is_cloud())
    throw UnsupportedError(
        "method completed takes faces, not clouds; signed-heat and tori take clouds");
  return std::make_unique<const CompletedDistance>(input.surface.points, input.triangles(), spacing,
                                                   input.flipped, task, report);
}

PolygonSoup completion_of(const CompletedDistance& distance, const Frame& frame) {
  PolygonSoup soup;
  soup.points = frame.global(distance.patch().points);
  for (Eigen::Index f = 0; f < distance.patch().faces.rows(); ++f) {
    const auto row = distance.patch().faces.row(f);
    const int face[3] = {row[0], row[1], row[2]};
    soup.add_face(face);
  }
  return soup;
}

SpaceAnswer on_nodes(const Grid& grid, const SpaceSources& sources, Task& task, Report& report) {
  const Frame frame(box_on_grid(sources.soup, grid));
  const Grid local = frame.local(grid);
  const double spacing = local.spacing.minCoeff();
  const SpaceInput input = make_input(sources, frame, spacing, task, report);
  const auto distance = completed(input, spacing, task.stage(0.35, "preparing"), report);
  const Stopwatch watch(report, "evaluate");
  SpaceAnswer answer;
  answer.at_nodes = distance->at_nodes(local, task.stage(0.6, "distance"), report) * frame.unit;
  answer.completion = completion_of(*distance, frame);
  return answer;
}

SpaceAnswer anywhere(const SpaceSources& sources, Task& task, Report& report) {
  const Frame frame(bounding_box(sources.soup));
  const SpaceInput input = make_input(sources, frame, query_side, task, report);
  auto distance = completed(input, query_side, task.stage(0.95, "preparing"), report);
  SpaceAnswer answer;
  answer.completion = completion_of(*distance, frame);
  answer.function = placed(std::move(distance), frame);
  return answer;
}

}  // namespace

std::vector<Method<SpaceDomain>> completed_methods() {
  static const OptionTable<Completed> none;
  return {make_method<SpaceDomain>(
      {Completed::method,
       "Distance to the nearest point of a surface and of patches over its holes, negative inside; "
       "exact around closed surfaces.",
       {"grid", "set of points"},
       {},
       "Barill et al.: Fast Winding Numbers for Soups and Clouds (2018)"},
      none,
      [](const SpaceDomain& domain, const Completed&, SolveHint, const Task&, Report& report) {
        if (domain.grid) {
          check_grid(*domain.grid);
          report.sizes.emplace_back("nodes", static_cast<double>(domain.grid->n_nodes()));
        }
        return
            [grid = domain.grid](const SpaceSources& sources, Completed&, Task& task, Report& r) {
              return grid ? on_nodes(*grid, sources, task, r) : anywhere(sources, task, r);
            };
      })};
}

}  // namespace littoral
