#include "api/space/traced_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "api/space/sampled_distance.h"
#include "api/space/tori_cloud.h"
#include "base/index.h"
#include "base/option_table.h"
#include "io/render/volume_scene.h"
#include "littoral/error.h"
#include "methods/implicit/sphere_trace.h"

namespace littoral {

namespace {

constexpr int most_tori = 200000;       // in a page
constexpr std::size_t most_clouds = 8;  // as its shader has room for (viewer/src/trace-shader.ts)
constexpr double part_of_pixel = 0.1;

/// The field near the level set; farther away what its samples on the grid promise, which costs a
/// hundredth: trilinear values less what the field can differ from them, which has the right sign.
class Sketched final : public PointwiseDistance {
 public:
  Sketched(std::shared_ptr<const PointwiseDistance> field, const Volume& samples, double level,
           double steepness)
      : field_(std::move(field)),
        samples_(samples),
        level_(level),
        margin_(steepness * samples.grid.spacing.norm()) {}
  DistanceSample at(const Vec3& x) const override { return field_->at(x); }
  double value(const Vec3& x) const override {
    const double away = samples_.value(x) - level_;
    if (!(std::abs(away) > 1.5 * margin_)) return field_->value(x);
    return level_ + (away > 0 ? away - margin_ : away + margin_);
  }

 private:
  std::shared_ptr<const PointwiseDistance> field_;
  SampledDistance samples_;
  double level_, margin_;
};

/// Clouds for which no method was asked are traced by their tori, as in pages: their completion has
/// the same zero set, but jumps beside parts thinner than the grid.
void trace_clouds_by_tori(CsgShapes& shapes) {
  for (Shape& shape : shapes.all)
    if (!shape.field && shape.surface.n_faces() == 0 && shape.request.method.name().empty())
      shape.request.method = Tori{};
}

/// Clouds become their tori, which pages trace, so that they are fitted once.
void fit_for_page(CsgShapes& shapes, Task task, Report& report) {
  if (shapes.all.size() > most_clouds)
    throw UnsupportedError("pages trace at most " + std::to_string(most_clouds) +
                           " clouds; these are " + std::to_string(shapes.all.size()));
  int points = 0;
  for (std::size_t s = 0; s < shapes.all.size(); ++s) {
    Shape& shape = shapes.all[s];
    Report spare;
    const std::string name = shape.request.method.name();
    const bool by_tori = name.empty() || name == SpaceAutomatic::method || name == Tori::method;
    if (shape.field || !by_tori || shape.surface.n_faces() > 0)
      throw UnsupportedError(
          "pages trace point clouds by their tori (method tori); pictures trace all "
          "shapes, and a volume of distance shows them on a grid");
    if (name != Tori::method) shape.request.method = Tori{};
    shape.surface = fit_tori_cloud(
        shape.surface, shape.request,
        task.stage(1 / static_cast<double>(shapes.all.size()), "fitting"), s == 0 ? report : spare);
    add_report_of(s, spare, report);
    shape.request.flip = shape.request.estimate_normals = false;  // they are that way now
    shape.request.method = Tori{};
    points += shape.surface.n_vertices();
  }
  if (points > most_tori)
    throw UnsupportedError("pages trace at most " + std::to_string(most_tori) +
                           " points; there are " + std::to_string(points));
}

std::string name_of(Boolean operation) {
  switch (operation) {
    case Boolean::unite:
      return "unite";
    case Boolean::intersect:
      return "intersect";
    case Boolean::subtract:
      break;
  }
  return "subtract";
}

/// The clouds as a page traces them, each with its own distance on the grid.
std::vector<io::TracedCloud> clouds_for_page(const CsgShapes& shapes, const Grid& grid, Task task) {
  std::vector<io::TracedCloud> clouds(shapes.all.size());
  for (std::size_t s = 0; s < clouds.size(); ++s) {
    Task part = task.stage(1 / static_cast<double>(clouds.size()), "sampling");
    const MatX3& points = shapes.all[s].surface.points;
    const std::vector<Torus> tori = tori_of_cloud(shapes.all[s].surface);
    io::TracedCloud& cloud = clouds[s];
    cloud.operation = name_of(s == 0 ? Boolean::unite : shapes.csg.operations[s - 1]);
    cloud.tori.resize(points.rows(), 16);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const Torus& t = tori[i];
      cloud.tori.row(i) << points.row(i), t.rho, t.q.transpose(), t.log_weight, t.n.transpose(),
          t.k1, t.e1.transpose(), t.k2;
    }
    if (shapes.plain()) break;  // the volume's values are its own
    Report spare;
    const CsgShapes alone{{shapes.all[s]}, {}};
    cloud.samples = evaluate(*pointwise_distance(alone, part.stage(0.2, "preparing"), spare), grid,
                             part.stage(0.8, "sampling"));
  }
  return clouds;
}

/// Triangles from `first` on are not drawn, but still frame the picture.
void hide_triangles(io::Scene& scene, Eigen::Index first) {
  for (Eigen::Index t = first; t < scene.triangles.rows(); ++t)
    scene.triangles(t, 1) = scene.triangles(t, 2) = scene.triangles(t, 0);
}

/// Parts that are thinner than the grid's cells frame the picture by their vertices, unless they
/// may have been taken away.
void frame_thin_parts(const CsgShapes& shapes, const Grid& grid, double level, io::Scene& scene) {
  const auto unites = [](Boolean operation) { return operation == Boolean::unite; };
  if (level < 0 || shapes.csg.offset < 0 || !std::ranges::all_of(shapes.csg.operations, unites))
    return;
  const Vec3 high = grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1);
  std::vector<Vec3> inside;
  for (const Shape& shape : shapes.all)
    for (const Vec3 x : shape.surface.points.rowwise())
      if ((x.array() >= grid.origin.array() && x.array() <= high.array()).all())
        inside.push_back(x);
  const Eigen::Index points = scene.points.rows(), triangles = scene.triangles.rows();
  const auto n = index(inside.size());
  scene.points.conservativeResize(points + n, 3);
  scene.triangles.conservativeResize(triangles + n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    scene.points.row(points + i) = inside[i].transpose();
    scene.triangles.row(triangles + i).setConstant(static_cast<int>(points + i));
  }
}

}  // namespace

io::Scene traced_scene(const CsgShapes& shapes, const Grid& grid, const TracedView& view, Task task,
                       Report& report) {
  if (!std::isfinite(view.level))
    throw InputError("the level must be a finite number", "option-value");
  CsgShapes used = shapes;
  if (view.for_page)
    fit_for_page(used, task.stage(0.2, "fitting"), report);
  else if (view.level == 0 && used.csg.offset == 0)
    trace_clouds_by_tori(used);
  const auto field = pointwise_distance(used, task.stage(0.2, "preparing"), report);
  const Volume volume{grid, evaluate(*field, grid, task.stage(0.3, "sampling"))};
  if (!(volume.values.minCoeff() < view.level && volume.values.maxCoeff() > view.level))
    throw InputError("the distance does not pass level " + number_text(view.level) +
                         " in the box: it is from " + rounded_text(volume.values.minCoeff()) +
                         " to " + rounded_text(volume.values.maxCoeff()),
                     "nothing-there");

  io::VolumeView shown;
  shown.axis = view.axis;
  shown.level = view.level;
  shown.position = view.position.value_or(grid.origin[view.axis]);
  io::Scene scene = io::make_volume_scene(volume, shown);
  const Eigen::Index slice = 2 * (Eigen::Index{grid.n[(view.axis + 1) % 3]} - 1) *
                             (Eigen::Index{grid.n[(view.axis + 2) % 3]} - 1);
  const bool with_slice = view.position.has_value() || view.for_page;
  auto trace = std::make_shared<io::SceneTrace>();
  trace->triangles = scene.triangles.bottomRows(scene.triangles.rows() - slice);
  hide_triangles(scene, slice);
  if (!with_slice) {
    scene.triangles = scene.triangles.bottomRows(scene.triangles.rows() - slice).eval();
    scene.values.resize(0);
    scene.volume.reset();
    frame_thin_parts(shapes, grid, view.level, scene);
  }

  trace->low = grid.origin;
  trace->high = grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1);
  if (with_slice) {
    const int layer = scene.volume->slice;
    trace->low[view.axis] = grid.origin[view.axis] + layer * grid.spacing[view.axis];
  }
  trace->level = view.level;
  trace->steepness = trace_steepness(*field, trace->low, trace->high, view.level);
  const double size = (trace->high - trace->low).norm();
  const auto sketch = std::make_shared<const Sketched>(field, volume, view.level, trace->steepness);
  trace->hit = [sketch, level = view.level, steepness = trace->steepness, size](
                   const Vec3& origin, const Vec3& direction, double from, double to, double pixel,
                   Vec3& normal) {
    TraceOptions options;
    options.level = level;
    options.steepness = steepness;
    options.tolerance = std::max(part_of_pixel * pixel, 1e-7 * size);
    const TraceHit hit = sphere_trace(*sketch, origin, direction, from, to, options);
    normal = hit.normal;
    return hit.found ? hit.t : infinity;
  };
  if (view.for_page) {
    trace->clouds = clouds_for_page(used, scene.volume->thin.grid, task.stage(0.3, "sampling"));
    trace->blend = used.csg.blend;
    trace->offset = used.csg.offset;
  }
  scene.trace = std::move(trace);
  return scene;
}

}  // namespace littoral
