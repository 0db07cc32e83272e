#include "api/space/csg.h"

#include <utility>

#include "api/space/beside_automatic.h"
#include "api/space/sampled_distance.h"
#include "api/space/valued_sources.h"
#include "base/index.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "littoral/error.h"
#include "sources/space/level_points.h"

namespace littoral {

namespace {

/// The other side is positive.
class Flipped final : public PointwiseDistance {
 public:
  explicit Flipped(std::shared_ptr<const PointwiseDistance> field) : field_(std::move(field)) {}
  DistanceSample at(const Vec3& x) const override {
    const DistanceSample sample = field_->at(x);
    return {-sample.value, -sample.gradient};
  }
  double value(const Vec3& x) const override { return -field_->value(x); }

 private:
  std::shared_ptr<const PointwiseDistance> field_;
};

std::shared_ptr<const PointwiseDistance> field_of(const Shape& shape) {
  auto sampled = std::make_shared<const SampledDistance>(*shape.field);
  if (shape.request.flip) return std::make_shared<const Flipped>(std::move(sampled));
  return sampled;
}

void add_box(const Shape& shape, Box& box) {
  if (shape.field) {
    const Grid& grid = shape.field->grid;
    box.add(grid.origin);
    box.add(grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1));
  } else {
    const Box one = bounding_box(shape.surface);
    const double reach = reach_of_values(shape.request.values);
    box.add(one.low.array() - reach);
    box.add(one.high.array() + reach);
  }
}

/// What all shapes say goes into one report: the first one's, and the warnings of the others.
Report& part_of(Report& report, Report& spare, std::size_t shape) {
  return shape == 0 ? report : spare;
}

void describe(const CsgShapes& shapes, Report& report) {
  if (shapes.all.front().field) report.method = "volume";
  if (shapes.plain()) return;
  report.sizes.emplace_back("shapes", static_cast<double>(shapes.all.size()));
}

}  // namespace

Shape shape_at_level(const Volume& volume, double level) {
  Shape shape;
  shape.surface = level_points(volume, level, {});
  shape.request.method = Tori{};
  return shape;
}

void add_report_of(std::size_t shape, const Report& its, Report& report) {
  if (shape == 0) return;
  for (const auto& [code, text] : its.warnings)
    report.warn(code, "shape " + std::to_string(shape + 1) + ": " + text);
  report.timings.insert(report.timings.end(), its.timings.begin(), its.timings.end());
  if (its.status != "converged") report.status = its.status;
}

Box bounding_box(const CsgShapes& shapes) {
  Box box;
  for (const Shape& shape : shapes.all) add_box(shape, box);
  return box;
}

double longest_side(const CsgShapes& shapes) {
  const double longest = bounding_box(shapes).size().maxCoeff();
  if (!(longest > 0)) throw InputError("all points of the input are at one place", "empty-input");
  return longest;
}

Grid choose_grid(const CsgShapes& shapes, const GridOptions& request) {
  check_combination(shapes.csg, shapes.all.size());
  if (shapes.plain() && reach_of_values(shapes.all.front().request.values) == 0)
    return choose_grid(shapes.all.front().surface, request);
  const bool anything = request.resolution || request.spacing || request.bounds;
  if (shapes.all.size() == 1 && shapes.all.front().field && !anything)
    return shapes.all.front().field->grid;
  const Box box = bounding_box(shapes);
  const double margin = std::max(0.0, shapes.csg.offset);
  PolygonSoup corners;
  corners.points.resize(2, 3);
  corners.points.row(0) = box.low.array() - margin;
  corners.points.row(1) = box.high.array() + margin;
  return choose_grid(corners, request);
}

VecX grid_distance(const CsgShapes& shapes, const Grid& grid, Task task, Report& report) {
  return grid_answer(shapes, grid, task, report).at_nodes;
}

SpaceAnswer grid_answer(const CsgShapes& shapes, const Grid& grid, Task task, Report& report) {
  check_combination(shapes.csg, shapes.all.size());
  const std::size_t n = shapes.all.size();
  if (shapes.plain()) {
    const auto& [surface, field, request] = shapes.all.front();
    if (!has_automatic(surface, request)) return grid_answer(surface, grid, request, task, report);
    SpaceAnswer answer = grid_answer(surface, grid, request, task.stage(0.9, "distance"), report);
    const std::vector<Eigen::Index> nodes = compared_nodes(grid);
    check_beside_automatic(surface, grid, nodes, answer.at_nodes(nodes), request,
                           task.stage(0.1, "checking"), report);
    return answer;
  }
  check_grid(grid);
  std::vector<VecX> values(n);
  for (std::size_t s = 0; s < n; ++s) {
    const Shape& shape = shapes.all[s];
    Task part = task.stage(0.9 / static_cast<double>(n), "distance");
    Report spare;
    if (!shape.field) {
      values[s] =
          grid_distance(shape.surface, grid, shape.request, part, part_of(report, spare, s));
    } else {
      values[s] = evaluate(*field_of(shape), grid, part);
    }
    add_report_of(s, spare, report);
  }
  describe(shapes, report);
  const Task rest = task.stage(0.1, "combining");
  VecX combined(values.front().size());
  parallel_for(std::size_t(combined.size()), 4096, [&](std::size_t begin, std::size_t end) {
    rest.checkpoint(static_cast<double>(begin) / static_cast<double>(combined.size()));
    std::vector<DistanceSample> samples(n);
    for (auto i = index(begin); i < index(end); ++i) {
      for (std::size_t s = 0; s < n; ++s) samples[s].value = values[s][i];
      combined[i] = combine(shapes.csg, samples).value + 0.0;  // no -0
    }
  });
  return {std::move(combined), {}, {}, {}};
}

std::shared_ptr<const PointwiseDistance> pointwise_distance(const CsgShapes& shapes, Task task,
                                                            Report& report) {
  check_combination(shapes.csg, shapes.all.size());
  std::vector<std::shared_ptr<const PointwiseDistance>> fields;
  for (std::size_t s = 0; s < shapes.all.size(); ++s) {
    const Shape& shape = shapes.all[s];
    Task part = task.stage(1 / static_cast<double>(shapes.all.size()), "preparing");
    Report spare;
    fields.push_back(shape.field ? field_of(shape)
                                 : pointwise_distance(shape.surface, shape.request, part,
                                                      part_of(report, spare, s)));
    add_report_of(s, spare, report);
  }
  describe(shapes, report);
  if (shapes.plain()) {
    const auto& [surface, field, request] = shapes.all.front();
    if (has_automatic(surface, request)) {
      const Grid grid = choose_grid(shapes, {.resolution = 32});
      const std::vector<Eigen::Index> nodes = compared_nodes(grid);
      const Task part = task.stage(0.1, "checking");
      check_beside_automatic(surface, grid, nodes,
                             evaluate(*fields.front(), positions(grid, nodes), nullptr, part),
                             request, part, report);
    }
  }
  if (fields.size() == 1 && shapes.csg.offset == 0) return fields.front();
  return std::make_shared<const Combined>(std::move(fields), shapes.csg);
}

VecX query_distance(const CsgShapes& shapes, const MatX3& queries, MatX3* gradients, Task task,
                    Report& report) {
  check_queries(queries);
  const auto field = pointwise_distance(shapes, task.stage(0.4, "preparing"), report);
  report.domain = "points";
  report.sizes.emplace_back("queries", static_cast<double>(queries.rows()));
  const Stopwatch watch(report, "evaluate");
  return evaluate(*field, queries, gradients, task.stage(0.6, "distance"));
}

}  // namespace littoral
