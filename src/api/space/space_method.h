#pragma once
// How a method of distance in space joins the program: one entry in a list, as on surfaces.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "api/surface/surface_method.h"
#include "base/report.h"
#include "base/task.h"
#include "domain/mesh/polygon_soup.h"
#include "domain/volume/grid.h"
#include "methods/implicit/pointwise.h"
#include "methods/tori/torus.h"
#include "sources/oriented_points.h"

namespace littoral {

/// What every method of distance in space is given: the surface moved and scaled to about unit size
/// about the origin, as triangles or, of a cloud, as points with normals.
struct SpaceProblem {
  PolygonSoup surface;      // triangles, or points with normals and no faces
  OrientedPoints samples;   // of it, as fine as the grid asks for
  std::vector<Torus> tori;  // at the points, where the file held fitted ones; or empty
  bool is_cloud() const { return surface.n_faces() == 0; }
  MatX3i triangles() const;  // faces x 3
};

/// One method. `on_grid` gives values at the nodes; where it is empty, `pointwise` is asked at
/// each. A method without `pointwise` cannot answer queries.
struct SpaceMethod {
  MethodInfo info;
  std::function<void(const OptionTexts&)> check;  // throws InputError unless all can be read
  std::function<VecX(const SpaceProblem&, const Grid&, const OptionTexts&, Task&, Report&)> on_grid;
  std::function<std::unique_ptr<const PointwiseDistance>(const SpaceProblem&, const OptionTexts&,
                                                         const Task&, Report&)>
      pointwise;
};

/// An entry from a table of options S and `make(problem, options, task, report)`.
template <class S, class Make>
SpaceMethod pointwise_method(MethodInfo info, const OptionTable<S>& table, Make make) {
  info.options = table.infos();
  SpaceMethod method;
  method.check = [info, &table](const OptionTexts& texts) { parse_options(info, table, texts); };
  method.pointwise = [info, &table, make](const SpaceProblem& problem, const OptionTexts& texts,
                                          const Task& task, Report& report) {
    // On the heap: GCC 12 takes members of a one-number struct for uninitialized otherwise.
    const auto options = std::make_unique<const S>(parse_options(info, table, texts));
    auto distance = make(problem, *options, task, report);
    report_options(table, *options, report);
    return distance;
  };
  method.info = std::move(info);
  return method;
}

/// All methods of distance in space, the default first. Each family is a function of its own.
const std::vector<SpaceMethod>& space_methods();
std::vector<SpaceMethod> space_heat_methods();
std::vector<SpaceMethod> closest_point_methods();
std::vector<SpaceMethod> convolutional_methods();
std::vector<SpaceMethod> tori_methods();
std::vector<SpaceMethod> regularized_space_methods();

/// What the world may know about each of them.
std::vector<MethodInfo> space_method_infos();

/// The method of that name; throws InputError listing the known ones.
const SpaceMethod& find_space_method(const std::string& name);

}  // namespace littoral
