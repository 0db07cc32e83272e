#include "api/space/sdf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "api/space/space_problem.h"
#include "api/space/tori_cloud.h"
#include "base/error.h"
#include "base/parallel.h"
#include "domain/volume/grid_values.h"
#include "methods/tori/tori.h"
#include "spatial/morton_order.h"
#include "spatial/winding_number.h"

namespace littoral {

namespace {

/// How fine a mesh is sampled for queries that have no grid.
constexpr double query_side = 0.01;

/// A distance in a frame's units, asked in those of the input.
class Placed final : public PointwiseDistance {
 public:
  Placed(std::unique_ptr<const PointwiseDistance> distance, const Frame& frame)
      : distance_(std::move(distance)), frame_(frame) {}
  DistanceSample at(const Vec3& x) const override {
    const DistanceSample sample = distance_->at(frame_.local(x));
    return {sample.value * frame_.unit, sample.gradient};
  }
  double value(const Vec3& x) const override {
    return distance_->value(frame_.local(x)) * frame_.unit;
  }

 private:
  std::unique_ptr<const PointwiseDistance> distance_;
  Frame frame_;
};

}  // namespace

void check_queries(const MatX3& queries) {
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
    if (!queries.row(i).allFinite())
      throw InputError("query point " + std::to_string(i) + " has coordinates that are not finite");
}

void check_request(const SpaceRequest& request) {
  find_space_method(request.method).check(request.options);
}

Grid choose_grid(const PolygonSoup& input, const GridRequest& request) {
  if (request.resolution && request.spacing)
    throw InputError("only one of --resolution and --spacing can be given");
  if (request.resolution && *request.resolution < 2)
    throw InputError("option --resolution must be at least 2");
  if (request.spacing && !(*request.spacing > 0 && std::isfinite(*request.spacing)))
    throw InputError("option --spacing must be positive");
  if (!(request.padding >= 0 && request.padding <= 1e3))
    throw InputError("option --padding must be in [0, 1000]");
  Box box = bounding_box(input);
  if (request.bounds) {
    const auto& b = *request.bounds;
    const Box wanted{Vec3(b[0], b[1], b[2]), Vec3(b[3], b[4], b[5])};
    if (!(wanted.size().minCoeff() > 0) || !wanted.size().allFinite())
      throw InputError("option --bounds must be x0,y0,z0,x1,y1,z1 with x0 < x1, y0 < y1, z0 < z1");
    if ((wanted.low.array() > box.high.array()).any() ||
        (wanted.high.array() < box.low.array()).any())
      throw InputError("the box of --bounds misses the input");
    box = wanted;
  } else {
    const double longest = box.size().maxCoeff();
    if (!(longest > 0)) throw InputError("all points of the input are at one place");
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
      throw InputError("the grid would have more than a million nodes along an axis");
    const auto s = static_cast<std::size_t>(a);
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
  const SpaceMethod& method = find_space_method(request.method);
  method.check(request.options);
  const Frame frame(box_on_grid(input, grid));
  report.method = request.method;
  report.domain = "grid";
  report.sizes.emplace_back("nodes", static_cast<double>(grid.n_nodes()));
  const Grid local = frame.local(grid);
  // Errors at edges and corners are proportional to the spacing of samples: it must not exceed the
  // grid's.
  const SpaceProblem problem =
      make_problem(input, request, frame, local.spacing.minCoeff(), task, report);
  VecX phi;
  if (method.on_grid) {
    Task rest = task.stage(0.9, "distance");
    phi = method.on_grid(problem, local, request.options, rest, report);
  } else {
    const auto distance =
        method.pointwise(problem, request.options, task.stage(0.3, "preparing"), report);
    const Stopwatch watch(report, "evaluate");
    phi = evaluate(*distance, local, task.stage(0.6, "distance"));
  }
  return phi * frame.unit;
}

std::shared_ptr<const PointwiseDistance> pointwise_distance(const PolygonSoup& input,
                                                            const SpaceRequest& request, Task task,
                                                            Report& report) {
  const SpaceMethod& method = find_space_method(request.method);
  method.check(request.options);
  if (!method.pointwise) {
    std::string others;
    for (const SpaceMethod& m : space_methods())
      if (m.pointwise) others += (others.empty() ? "" : ", ") + m.info.name;
    throw UnsupportedError("method " + request.method +
                           " cannot be asked at single points; these can: " + others);
  }
  report.method = request.method;
  const Frame frame(bounding_box(input));
  const SpaceProblem problem = make_problem(input, request, frame, query_side, task, report);
  auto distance = method.pointwise(problem, request.options, task.stage(0.9, "preparing"), report);
  return std::make_shared<const Placed>(std::move(distance), frame);
}

VecX evaluate(const PointwiseDistance& distance, const Grid& grid, const Task& task) {
  return grid_values(grid, task,
                     [&](const Vec3& x, int& last) { return distance.value_after(x, last); });
}

VecX query_distance(const PolygonSoup& input, const MatX3& queries, const SpaceRequest& request,
                    MatX3* gradients, Task task, Report& report) {
  check_queries(queries);
  const auto distance = pointwise_distance(input, request, task.stage(0.4, "preparing"), report);
  report.domain = "points";
  report.sizes.emplace_back("queries", static_cast<double>(queries.rows()));
  const Stopwatch watch(report, "evaluate");
  return evaluate(*distance, queries, gradients, task.stage(0.6, "distance"));
}

VecX query_winding(const PolygonSoup& input, const MatX3& queries, const SpaceRequest& request,
                   Task task, Report& report) {
  check_queries(queries);
  report.method = "winding number";
  report.domain = "points";
  report.sizes.emplace_back("queries", static_cast<double>(queries.rows()));
  const Frame frame(bounding_box(input));
  const SpaceProblem problem =
      make_problem(input, request, frame, std::numeric_limits<double>::infinity(), task, report);
  const OrientedPoints& s = problem.samples;
  const WindingNumber winding = problem.is_cloud()
                                    ? WindingNumber(s.points, s.normals, s.areas)
                                    : WindingNumber(problem.surface.points, problem.triangles());
  const Stopwatch watch(report, "evaluate");
  const Task rest = task.stage(0.9, "winding number");
  const MatX3 local = frame.local(queries);
  VecX values(queries.rows());
  const std::vector<int> order = morton_order(local);
  parallel_for(static_cast<std::size_t>(queries.rows()), 1024,
               [&](std::size_t begin, std::size_t end) {
                 rest.checkpoint(static_cast<double>(begin) / static_cast<double>(queries.rows()));
                 for (std::size_t at = begin; at < end; ++at)
                   values[order[at]] = winding(local.row(order[at]));
               });
  return values;
}

PolygonSoup fit_tori_cloud(const PolygonSoup& input, const SpaceRequest& request, Task task,
                           Report& report) {
  const SpaceMethod& method = find_space_method("tori");
  report.method = method.info.name;
  report.domain = "points";
  const Frame frame(bounding_box(input));
  const SpaceProblem problem = make_problem(input, request, frame, query_side, task, report);
  const auto distance =
      method.pointwise(problem, request.options, task.stage(0.9, "fitting"), report);
  const Tori& fitted = dynamic_cast<const Tori&>(*distance);
  std::vector<Torus> tori = fitted.tori();
  for (Torus& t : tori) t = frame.global(t);
  return cloud_of_tori((frame.unit * fitted.points()).rowwise() + frame.centre.transpose(), tori);
}

}  // namespace littoral
