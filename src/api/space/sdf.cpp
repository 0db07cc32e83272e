#include "api/space/sdf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "api/space/input_queries.h"
#include "api/space/tori_cloud.h"
#include "api/space/valued_sources.h"
#include "base/index.h"
#include "base/option_table.h"
#include "base/stopwatch.h"
#include "littoral/error.h"
#include "methods/tori/tori.h"
#include "spatial/grid_values.h"

namespace littoral {

namespace {

SpaceAnswer solve(const PolygonSoup& input, const SpaceDomain& domain, const SpaceRequest& request,
                  const Task& task, Report& report) {
  return solve_from_values(request.method, domain,
                           {input, request.flip, request.estimate_normals, request.values}, task,
                           report);
}

Box box_of(const std::array<double, 6>& b) {
  return {Vec3(b[0], b[1], b[2]), Vec3(b[3], b[4], b[5])};
}

}  // namespace

void check_queries(const MatX3& queries, Eigen::Index first) {
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
    if (!queries.row(i).allFinite())
      throw InputError(
          "query point " + std::to_string(first + i) + " has coordinates that are not finite",
          "not-finite");
}

void check_grid_options(const GridOptions& request) {
  if (request.resolution && request.spacing)
    throw InputError("option resolution and option spacing both say how fine the grid is: give one",
                     "options-conflict");
  if (request.resolution && *request.resolution < 2)
    throw InputError(
        "option resolution must be at least 2, not " + std::to_string(*request.resolution),
        "option-value");
  if (request.spacing && !(*request.spacing > 0 && std::isfinite(*request.spacing)))
    throw InputError(
        "option spacing must be positive and finite, not " + number_text(*request.spacing),
        "option-value");
  if (!(request.padding >= 0 && request.padding <= 1e3))
    throw InputError("option padding must be in [0, 1000], not " + number_text(request.padding),
                     "option-value");
  if (!request.bounds) return;
  const Box wanted = box_of(*request.bounds);
  if (!(wanted.size().minCoeff() > 0) || !wanted.size().allFinite())
    throw InputError("option bounds must be x0,y0,z0,x1,y1,z1 with x0 < x1, y0 < y1, z0 < z1",
                     "option-value");
}

Grid choose_grid(const PolygonSoup& input, const GridOptions& request) {
  check_grid_options(request);
  Box box = bounding_box(input);
  if (request.bounds) {
    const Box wanted = box_of(*request.bounds);
    if ((wanted.low.array() > box.high.array()).any() ||
        (wanted.high.array() < box.low.array()).any())
      throw InputError("the box of option bounds misses the input, which fills " + box_text(box),
                       "nothing-there");
    box = wanted;
  } else {
    const double longest = box.size().maxCoeff();
    if (!(longest > 0)) throw InputError("all points of the input are at one place", "empty-input");
    // Flat inputs still get nodes on both sides.
    const double margin = std::max(request.padding, 1e-3) * longest;
    box.low.array() -= margin;
    box.high.array() += margin;
  }
  const double longest = box.size().maxCoeff();
  const double spacing =
      request.spacing ? *request.spacing : longest / (request.resolution.value_or(64) - 1);
  Grid grid;
  for (int a = 0; a < 3; ++a) {
    const double cells = box.size()[a] / spacing;
    if (!(cells < 1e6))
      throw InputError("the grid would have more than a million nodes along an axis, " +
                           number_text(spacing) +
                           " apart; take a larger option spacing or smaller option bounds",
                       "too-large");
    const auto s = std::size_t(a);
    if (request.bounds) {
      grid.n[s] = std::max(2, static_cast<int>(std::lround(cells)) + 1);
      grid.spacing[a] = box.size()[a] / (grid.n[s] - 1);
      grid.origin[a] = box.low[a];
    } else {
      grid.n[s] = std::max(2, static_cast<int>(std::ceil(cells - 1e-9)) + 1);
      grid.spacing[a] = spacing;
      grid.origin[a] = (box.low[a] + box.high[a] - spacing * (grid.n[s] - 1)) / 2;
    }
  }
  check_grid(grid);
  return grid;
}

VecX grid_distance(const PolygonSoup& input, const Grid& grid, const SpaceRequest& request,
                   Task task, Report& report) {
  return grid_answer(input, grid, request, task, report).at_nodes;
}

SpaceAnswer grid_answer(const PolygonSoup& input, const Grid& grid, const SpaceRequest& request,
                        Task task, Report& report) {
  SpaceAnswer answer = solve(input, {grid, {}}, request, task, report);
  answer.at_nodes.array() += 0.0;  // -0, of nodes on the surface that count as inside, becomes 0
  return answer;
}

SpaceAnswer tet_distance(const PolygonSoup& input, const Grid& grid, const TetFilling& filling,
                         const SpaceRequest& request, Task task, Report& report) {
  return solve(input, {grid, filling}, request, task, report);
}

std::shared_ptr<const PointwiseDistance> pointwise_distance(const PolygonSoup& input,
                                                            const SpaceRequest& request, Task task,
                                                            Report& report) {
  return solve(input, {}, request, task, report).function;
}

VecX query_distance(const PolygonSoup& input, const MatX3& queries, const SpaceRequest& request,
                    MatX3* gradients, Task task, Report& report) {
  check_queries(queries);
  const auto distance = pointwise_distance(input, request, task.stage(0.4, "preparing"), report);
  report.sizes.emplace_back("queries", static_cast<double>(queries.rows()));
  const Stopwatch watch(report, "evaluate");
  return evaluate(*distance, queries, gradients, task.stage(0.6, "distance"));
}

VecX query_winding(const PolygonSoup& input, const MatX3& queries, const SpaceRequest& request,
                   Task task, Report& report, double smoothing) {
  check_queries(queries);
  report.method = smoothing > 0 ? "regularized winding number" : "winding number";
  report.domain = "set of points";
  report.sizes.emplace_back("queries", static_cast<double>(queries.rows()));
  const Orientation orientation{request.flip, request.estimate_normals};
  if (smoothing > 0) return smoothed_winding(input, orientation, smoothing, queries, task, report);
  const WindingOfInput winding(input, orientation, task, report);
  const Stopwatch watch(report, "evaluate");
  return winding.at(queries, task.stage(0.9, "winding number"));
}

VecX grid_winding(const PolygonSoup& input, const Grid& grid, const SpaceRequest& request,
                  Task task, Report& report, double smoothing) {
  check_grid(grid);
  MatX3 nodes(index(grid.n_nodes()), 3);
  Eigen::Index row = 0;
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) nodes.row(row++) = grid.point(i, j, k);
  VecX values = query_winding(input, nodes, request, task, report, smoothing);
  report.domain = "grid";
  return values;
}

PolygonSoup fit_tori_cloud(const PolygonSoup& input, const SpaceRequest& request, Task task,
                           Report& report) {
  const AnyMethod method = request.method.name().empty()
                               ? AnyMethod::named(Tori::method, request.method.values())
                               : request.method;
  const MethodInfo& info = Registry<SpaceDomain>::instance().find(Tori::method)->info;
  if (method.name() != info.name)
    throw InputError("tori are fitted by method " + info.name + ", not by " + method.name(),
                     "options-conflict");
  const Tori options = typed_options(info, tori_options(), method);
  report.method = info.name;
  report.domain = "set of points";
  const Frame frame(bounding_box(input));
  const SpaceInput local = make_input({input, request.flip, request.estimate_normals}, frame,
                                      frame.query_side(), task, report);
  const auto fitted = fit_tori(local, options, task.stage(0.9, "fitting"), report);
  report_options(tori_options(), options, report);
  std::vector<Torus> tori = fitted->tori();
  for (Torus& t : tori) t = frame.global(t);
  return cloud_of_tori(frame.global(fitted->points()), tori);
}

}  // namespace littoral
