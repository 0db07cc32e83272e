#include "littoral/space.h"

#include <algorithm>
#include <utility>

#include "api/front/running.h"
#include "api/space/csg.h"
#include "api/space/input_queries.h"
#include "api/space/isosurfaces.h"
#include "api/space/sampled_distance.h"
#include "api/space/sdf.h"
#include "api/space/valued_sources.h"
#include "api/space/volume_meaning.h"
#include "base/lazy.h"
#include "littoral/error.h"

namespace littoral {

/// One shape or several. A method that answers anywhere is prepared; others have the input, to be
/// sampled on grids.
struct Sdf::Impl {
  CsgShapes shapes;
  std::shared_ptr<const PointwiseDistance> function;  // null where a grid is needed
  Report report;
  Kept<NearestOnInput> nearest;
  Kept<WindingOfInput> winding;

  /// The only input, where there is but one.
  const Shape& input() const {
    if (shapes.all.size() != 1 || shapes.all.front().field)
      throw UnsupportedError("closest points and winding numbers are those of one input, not of " +
                             std::string(shapes.all.size() == 1 ? "a volume" : "a combination"));
    return shapes.all.front();
  }
  std::shared_ptr<const WindingOfInput> winding_of_input(const Task& task) const {
    return winding.get([&] {
      Report ignored;  // the preparation's holds the same
      const Shape& shape = input();
      return std::make_shared<const WindingOfInput>(
          shape.surface, Orientation{shape.request.flip, shape.request.estimate_normals}, task,
          ignored);
    });
  }

  const PointwiseDistance& anywhere() const {
    if (!function)
      throw UnsupportedError("method " + shapes.all.front().request.method.name() +
                             " cannot be asked at single points: sample it on a grid");
    return *function;
  }
};

namespace {

bool answers_anywhere(const AnyMethod& method) {
  const auto& domains = chosen_method<SpaceDomain>(method)->info.domains;
  return std::find(domains.begin(), domains.end(), SpaceDomain{}.kind()) != domains.end();
}

Sdf made_of(CsgShapes shapes, const Context& context) {
  auto impl = std::make_shared<Sdf::Impl>();
  impl->shapes = std::move(shapes);
  bool anywhere = true;
  for (Shape& shape : impl->shapes.all) {
    if (shape.field) continue;
    check_method<SpaceDomain>(shape.request.method);
    anywhere = anywhere && answers_anywhere(shape.request.method);
  }
  if (!anywhere) {
    longest_side(impl->shapes);  // complains about inputs that cannot be measured from
    for (const Shape& shape : impl->shapes.all) check_values(shape.surface, shape.request.values);
    return Sdf(std::move(impl));
  }
  impl->function = run(context, [&](const Task& task) {
    return pointwise_distance(impl->shapes, task, impl->report);
  });
  return Sdf(std::move(impl));
}

/// Combinations of combinations: the shapes of b after those of a.
Sdf combined(const Sdf& a, const Sdf& b, Boolean how, double blend) {
  const auto function = [](const Sdf& f) {
    f.impl().anywhere();
    return f.impl().function;
  };
  auto impl = std::make_shared<Sdf::Impl>();
  impl->function =
      std::make_shared<const Combined>(std::vector{function(a), function(b)}, Csg{{how}, blend, 0});
  impl->shapes = a.impl().shapes;  // for bounds
  const CsgShapes& other = b.impl().shapes;
  impl->shapes.all.insert(impl->shapes.all.end(), other.all.begin(), other.all.end());
  impl->report = a.impl().report;
  impl->report.merge(b.impl().report);
  return Sdf(std::move(impl));
}

}  // namespace

double Sdf::operator()(const Vec3& x) const { return impl_->anywhere().value(x); }
Vec3 Sdf::gradient(const Vec3& x) const { return impl_->anywhere().at(x).gradient; }

namespace {

/// body(first, queries, task) for blocks of the queries: none is copied, sorted or checked as a
/// whole, so that many take little memory and can be stopped.
template <class Body>
void in_blocks(const Queries& points, Task task, const Body& body) {
  constexpr Eigen::Index most = 1 << 18;
  for (Eigen::Index first = 0; first < points.rows(); first += most) {
    const MatX3 block = points.middleRows(first, std::min(most, points.rows() - first));
    check_queries(block, first);
    body(first, block, task.stage(double(block.rows()) / double(points.rows()), "queries"));
  }
}

}  // namespace

VecX Sdf::at(const Queries& points, const Context& context) const {
  VecX out(points.rows());
  run(context, [&](const Task& task) {
    const PointwiseDistance& function = impl_->anywhere();
    in_blocks(points, task, [&](Eigen::Index first, const MatX3& block, const Task& part) {
      out.segment(first, block.rows()) = evaluate(function, block, nullptr, part);
    });
  });
  return out;
}

DistanceSamples Sdf::with_gradients(const Queries& points, const Context& context) const {
  DistanceSamples out{VecX(points.rows()), MatX3(points.rows(), 3)};
  run(context, [&](const Task& task) {
    const PointwiseDistance& function = impl_->anywhere();
    in_blocks(points, task, [&](Eigen::Index first, const MatX3& block, const Task& part) {
      MatX3 gradients;
      out.values.segment(first, block.rows()) = evaluate(function, block, &gradients, part);
      out.gradients.middleRows(first, block.rows()) = gradients;
    });
  });
  return out;
}

NearestPoints Sdf::closest(const Queries& points, const Context& context) const {
  const Eigen::Index n = points.rows();
  NearestPoints out{MatX3(n, 3), VecXi(n), MatX3i(n, 3), MatX3(n, 3), VecX(n)};
  run(context, [&](const Task& task) {
    const PolygonSoup& surface = impl_->input().surface;
    const auto tree =
        impl_->nearest.get([&] { return std::make_shared<const NearestOnInput>(surface); });
    in_blocks(points, task, [&](Eigen::Index first, const MatX3& block, const Task& part) {
      const NearestPoints found = tree->at(block, part);
      out.points.middleRows(first, block.rows()) = found.points;
      out.elements.segment(first, block.rows()) = found.elements;
      out.corners.middleRows(first, block.rows()) = found.corners;
      out.barycentric.middleRows(first, block.rows()) = found.barycentric;
      out.distances.segment(first, block.rows()) = found.distances;
    });
  });
  return out;
}

VecX Sdf::winding_number(const Queries& points, const Context& context) const {
  VecX out(points.rows());
  run(context, [&](const Task& task) {
    const auto winding = impl_->winding_of_input(task);
    in_blocks(points, task, [&](Eigen::Index first, const MatX3& block, const Task& part) {
      out.segment(first, block.rows()) = winding->at(block, part);
    });
  });
  return out;
}

VecX Sdf::confidence(const Queries& points, const Context& context) const {
  VecX out(points.rows());
  run(context, [&](const Task& task) {
    const auto winding = impl_->winding_of_input(task);
    in_blocks(points, task, [&](Eigen::Index first, const MatX3& block, const Task& part) {
      out.segment(first, block.rows()) = winding->confidence(block, part);
    });
  });
  return out;
}

Volume Sdf::sample(const Grid& grid, const Context& context) const {
  return run(context, [&](const Task& task) -> Volume {
    Report report;
    if (!impl_->function) return {grid, grid_distance(impl_->shapes, grid, task, report)};
    check_grid(grid);
    return {grid, evaluate(*impl_->function, grid, task)};
  });
}

Eigen::Matrix<double, 2, 3> Sdf::bounds() const {
  const Box box = bounding_box(impl_->shapes);
  Eigen::Matrix<double, 2, 3> out;
  out.row(0) = box.low;
  out.row(1) = box.high;
  return out;
}

const Report& Sdf::report() const { return impl_->report; }

Sdf signed_distance(const PolygonSoup& input, const AnyMethod& method,
                    const Orientation& orientation, const Context& context) {
  return signed_distance(input, std::vector<double>{}, method, orientation, context);
}

Sdf signed_distance(const PolygonSoup& input, std::vector<double> values, const AnyMethod& method,
                    const Orientation& orientation, const Context& context) {
  CsgShapes shapes;
  shapes.all.push_back(
      {input, {}, {method, orientation.flip, orientation.estimate_normals, std::move(values)}});
  return made_of(std::move(shapes), context);
}

Sdf signed_distance(const Mesh& input, const AnyMethod& method, const Orientation& orientation,
                    const Context& context) {
  return signed_distance(input.soup(), method, orientation, context);
}

Sdf signed_distance(const Volume& volume) {
  CsgShapes shapes;
  shapes.all.push_back({{}, volume, {}});
  return made_of(std::move(shapes), {});
}

Sdf signed_distance(const Volume& volume, VolumeMeaning meaning,
                    const std::optional<double>& threshold, const Context& context) {
  CsgShapes shapes;
  shapes.all.push_back(shape_of(volume, meaning, threshold));
  return made_of(std::move(shapes), context);
}

Sdf unite(const Sdf& a, const Sdf& b, double blend) {
  return combined(a, b, Boolean::unite, blend);
}
Sdf intersect(const Sdf& a, const Sdf& b, double blend) {
  return combined(a, b, Boolean::intersect, blend);
}
Sdf subtract(const Sdf& a, const Sdf& b, double blend) {
  return combined(a, b, Boolean::subtract, blend);
}

VecX winding_number(const PolygonSoup& input, const MatX3& points, const Orientation& orientation,
                    const Context& context) {
  return run(context, [&](const Task& task) {
    Report report;
    return query_winding(input, points, {{}, orientation.flip, orientation.estimate_normals}, task,
                         report);
  });
}

PolygonSoup fit_tori(const PolygonSoup& cloud, const AnyMethod& tori,
                     const Orientation& orientation, const Context& context) {
  return run(context, [&](const Task& task) {
    Report report;
    return fit_tori_cloud(cloud, {tori, orientation.flip, orientation.estimate_normals}, task,
                          report);
  });
}

Mesh isosurface(const Volume& volume, double level, bool close_at_box, const Context& context) {
  return run(context, [&](const Task& task) {
    Report report;
    return Mesh(isosurfaces(volume, {level}, close_at_box, report, task).front().surface);
  });
}

std::vector<Mesh> offset(const Volume& distance, const std::vector<double>& distances,
                         const Morphology& morphology, const Context& context) {
  return run(context, [&](const Task& task) {
    Report report;
    std::vector<Mesh> out;
    for (Isosurface& each :
         offset_isosurfaces(distance, distances, morphology, false, report, task))
      out.emplace_back(std::move(each.surface));
    return out;
  });
}

std::vector<Mesh> offset(const Sdf& shape, const Grid& grid, const std::vector<double>& distances,
                         const Morphology& morphology, const Context& context) {
  constexpr double sampled = 0.8;
  const Volume distance = shape.sample(grid, part_of(context, 0, sampled));
  return run(part_of(context, sampled, 1), [&](const Task& task) {
    Report report;
    std::vector<Mesh> out;
    for (Isosurface& each : offset_isosurfaces(distance, distances, morphology, false, report, task,
                                               shape.impl().function.get()))
      out.emplace_back(std::move(each.surface));
    return out;
  });
}

Mesh wall(const Volume& distance, double thickness, double at, const Morphology& morphology,
          const Context& context) {
  return run(context, [&](const Task& task) {
    Report report;
    return Mesh(std::move(
        wall_isosurfaces(distance, {at}, thickness, morphology, false, report, task)[0].surface));
  });
}

Grid Grid::around(const Sdf& distance, const GridOptions& options) {
  const CsgShapes& shapes = distance.impl().shapes;
  PolygonSoup corners;
  corners.points = distance.bounds();
  return shapes.plain() ? choose_grid(shapes, options) : choose_grid(corners, options);
}

Grid Grid::around(const PolygonSoup& input, const GridOptions& options) {
  return choose_grid(input, options);
}

}  // namespace littoral
