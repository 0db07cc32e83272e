#include "api/space/valued_sources.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "base/index.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "littoral/error.h"
#include "sources/space/tet_source_values.h"
#include "sources/surface/source_values.h"
#include "spatial/grid_values.h"
#include "spatial/triangulate.h"
#include "spatial/valued_nearest.h"

namespace littoral {

namespace {

/// Faces, or points of a cloud.
std::size_t n_sources(const PolygonSoup& input) {
  return std::size_t(input.n_faces() > 0 ? input.n_faces() : input.n_vertices());
}

/// The input with its values, in a frame's units.
struct ValuedInput {
  Frame frame;
  PolygonSoup surface;  // triangles or points
  std::vector<double> values;
  ValuedNearest nearest;

  ValuedInput(const PolygonSoup& input, const std::vector<double>& given)
      : frame(bounding_box(input)),
        surface(local(input)),
        values(own_values(input, given)),
        nearest(surface.points, triangles_of(surface), values) {}

 private:
  PolygonSoup local(const PolygonSoup& input) const {
    PolygonSoup out;
    out.points = frame.local(input.points);
    out.face_offsets = input.face_offsets;
    out.corners = input.corners;
    return input.n_faces() > 0 ? triangulate(out) : out;
  }
  std::vector<double> own_values(const PolygonSoup& input, const std::vector<double>& given) const {
    const std::size_t n = n_sources(input);
    const std::vector<double> each =
        frame.local(given.size() == n ? given : std::vector<double>(n, given.front()));
    if (!std::all_of(each.begin(), each.end(), [](double c) { return std::isfinite(c); }))
      throw InputError("the values are too large for an input of this size", "too-large");
    return input.n_faces() > 0 ? values_of_triangles(input, each) : each;
  }
};

/// Distance counted from values, with the sides that a method tells.
class CountedFromValues final : public PointwiseDistance {
 public:
  /// sides: null where there are none.
  CountedFromValues(std::shared_ptr<const ValuedInput> input,
                    std::shared_ptr<const PointwiseDistance> sides)
      : input_(std::move(input)), sides_(std::move(sides)) {}

  DistanceSample at(const Vec3& x) const override {
    const bool inside = sides_ && sides_->value(x) < 0;
    const Vec3 local = input_->frame.local(x);
    const ValuedPoint found = nearest(local, inside);
    DistanceSample sample{found.reach * input_->frame.unit, Vec3::Zero()};
    if (found.distance > 0)
      sample.gradient = (inside ? -1 : 1) * (local - found.point).stableNormalized();
    else if (sides_)
      sample.gradient = sides_->at(x).gradient;
    return sample;
  }
  double value(const Vec3& x) const override { return counted(x, sides_ ? sides_->value(x) : 0); }
  VecX on_grid(const Grid& grid, const Task& task) const override {
    Task stages = task;
    const VecX sides = sides_ ? sides_->on_grid(grid, stages.stage(0.5, "sides")) : VecX();
    return at_points(grid_points(grid), sides, stages.stage(0.5, "distance"));
  }

  /// points x 3; sides: what a method says there, negative inside, or empty.
  VecX at_points(const MatX3& points, const VecX& sides, const Task& task) const {
    VecX out(points.rows());
    const auto n = std::size_t(points.rows());
    parallel_for(n, 1024, [&](std::size_t begin, std::size_t end) {
      task.checkpoint(static_cast<double>(begin) / static_cast<double>(n));
      for (auto i = index(begin); i < index(end); ++i)
        out[i] = counted(points.row(i), sides.size() > 0 ? sides[i] : 0);
    });
    return out;
  }

 private:
  ValuedPoint nearest(const Vec3& local, bool inside) const {
    return inside ? input_->nearest.greatest(local) : input_->nearest.least(local);
  }
  double counted(const Vec3& x, double side) const {
    return nearest(input_->frame.local(x), side < 0).reach * input_->frame.unit;
  }

  std::shared_ptr<const ValuedInput> input_;
  std::shared_ptr<const PointwiseDistance> sides_;
};

/// A method's answer with a number added.
class Shifted final : public PointwiseDistance {
 public:
  Shifted(std::shared_ptr<const PointwiseDistance> distance, double by)
      : distance_(std::move(distance)), by_(by) {}
  DistanceSample at(const Vec3& x) const override {
    DistanceSample sample = distance_->at(x);
    sample.value += by_;
    return sample;
  }
  double value(const Vec3& x) const override { return distance_->value(x) + by_; }
  double value_after(const Vec3& x, int& last) const override {
    return distance_->value_after(x, last) + by_;
  }
  VecX on_grid(const Grid& grid, const Task& task) const override {
    return distance_->on_grid(grid, task).array() + by_;
  }

 private:
  std::shared_ptr<const PointwiseDistance> distance_;
  double by_;
};

void shift(SpaceAnswer& answer, double by) {
  answer.at_nodes.array() += by;
  answer.tets.values.array() += by;
  if (answer.function)
    answer.function = std::make_shared<const Shifted>(std::move(answer.function), by);
}

/// Warns of sources that others reach sooner, c_i > c_j + d(i, j), by corners and middles of faces
/// or by points, unless a method has done so by paths through tets.
void tell_shadowed(const ValuedInput& input, const Task& task, Report& report) {
  for (const Warning& told : report.warnings)
    if (told.code == "source-shadowed") return;
  std::map<double, double> excess;  // value -> largest
  const MatX3i faces = triangles_of(input.surface);
  const auto look = [&](std::size_t source, const Vec3& x) {
    const double value = input.values[source], least = input.nearest.least(x).reach;
    const double over = value - least;
    if (!(over > 1e-9 * (1 + std::abs(value) + std::abs(least)))) return;
    double& most = excess[value];
    most = std::max(most, over);
  };
  for (std::size_t i = 0; i < input.values.size(); ++i) {
    if (i % 1024 == 0) task.checkpoint();
    const auto row = index(i);
    if (faces.rows() == 0) {
      look(i, input.surface.points.row(row));
      continue;
    }
    const MatX3 corners = input.surface.points(faces.row(row), Eigen::all);
    look(i, corners.colwise().mean());
    for (const auto& corner : corners.rowwise()) look(i, corner.transpose());
  }
  std::vector<std::pair<std::string, double>> named;
  for (const auto& [value, most] : excess)
    named.emplace_back("the source of value " + rounded_text(value * input.frame.unit),
                       most * input.frame.unit);
  warn_of_shadowed(named, report);
}

/// The same places, counted from the values.
void count(const std::shared_ptr<const ValuedInput>& input, const SpaceDomain& domain,
           SpaceAnswer& answer, Task task, Report& report) {
  const Stopwatch watch(report, "count from values");
  auto function = std::make_shared<const CountedFromValues>(input, answer.function);
  if (domain.grid)
    answer.at_nodes = function->at_points(grid_points(*domain.grid), answer.at_nodes,
                                          task.stage(0.5, "counting from values"));
  if (domain.tets)
    answer.tets.values = function->at_points(answer.tets.mesh.points, answer.tets.values,
                                             task.stage(0.5, "counting from values"));
  if (answer.function) answer.function = std::move(function);
}

/// Of points without normals.
SpaceAnswer without_sides(const std::string& method, const SpaceDomain& domain,
                          const SpaceSources& sources, const Task& task, Report& report) {
  if (domain.tets)
    throw UnsupportedError(
        "points without normals have values on grids and at points, not through tets");
  report.method = method;
  report.domain = domain.kind();
  if (domain.grid) {
    check_grid(*domain.grid);
    report.sizes.emplace_back("nodes", static_cast<double>(domain.grid->n_nodes()));
  }
  report.sizes.emplace_back("points", sources.soup.n_vertices());
  const auto input = std::make_shared<const ValuedInput>(sources.soup, sources.values);
  tell_shadowed(*input, task, report);
  auto function = std::make_shared<const CountedFromValues>(input, nullptr);
  SpaceAnswer answer;
  const Stopwatch watch(report, "evaluate");
  if (domain.grid) answer.at_nodes = function->on_grid(*domain.grid, task);
  answer.function = std::move(function);
  return answer;
}

}  // namespace

void check_values(const PolygonSoup& input, const std::vector<double>& values) {
  const std::size_t n = n_sources(input);
  if (values.size() > 1 && values.size() != n)
    throw InputError("there are " + std::to_string(values.size()) + " values for " +
                         std::to_string(n) + (input.n_faces() > 0 ? " faces" : " points"),
                     "sizes-differ");
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw InputError(
          "value " + std::to_string(i) + " of the sources, counted from 0, is not finite",
          "not-finite");
}

double reach_of_values(const std::vector<double>& values) {
  double reach = 0;
  for (const double c : values) reach = std::max(reach, -c);
  return reach;
}

SpaceAnswer solve_from_values(const AnyMethod& method, const SpaceDomain& domain,
                              const SpaceSources& sources, Task task, Report& report) {
  const std::vector<double>& values = sources.values;
  if (values.empty()) return solve_once(method, domain, sources, std::move(task), report);
  const PolygonSoup& soup = sources.soup;
  check_values(soup, values);
  const auto chosen = chosen_method<SpaceDomain>(method);
  chosen->options(method);  // complains about those it has not
  const MethodInfo& info = chosen->info;
  const std::string at_points = SpaceDomain{}.kind();
  const bool tells_sides =
      info.different_values &&
      std::find(info.domains.begin(), info.domains.end(), at_points) != info.domains.end();
  if (tells_sides && soup.n_faces() == 0 && soup.normals.rows() == 0 && !sources.estimate_normals)
    return without_sides(info.name, domain, sources, task, report);
  if (std::all_of(values.begin(), values.end(), [&](double c) { return c == values[0]; })) {
    SpaceSources plain = sources;
    plain.values.clear();
    SpaceAnswer answer = solve_once(method, domain, plain, std::move(task), report);
    shift(answer, values.front());
    return answer;
  }
  if (!info.different_values)
    refuse_different_values(info, domain.kind(), Registry<SpaceDomain>::instance().infos());
  SpaceAnswer answer = solve_once(method, domain, sources, task.stage(0.6, "distance"), report);
  const auto input = std::make_shared<const ValuedInput>(soup, values);
  tell_shadowed(*input, task, report);
  if (tells_sides) count(input, domain, answer, task.stage(0.4, "counting from values"), report);
  return answer;
}

}  // namespace littoral
