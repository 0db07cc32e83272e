#pragma once
// Space as a domain of methods: where distance is wanted, at the nodes of a grid, through tets that
// fill its box, or at any point.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/method.h"
#include "api/space/space_input.h"
#include "base/stopwatch.h"
#include "littoral/through_tets.h"
#include "littoral/volume.h"
#include "methods/implicit/pointwise.h"

namespace littoral {

/// Tets that fill the box of a grid: a lattice, small near the input and larger far from it (thesis
/// 4.5), or tets whose faces follow the input, made by the program tetgen.
struct TetFilling {
  enum class By { lattice, tetgen } by = By::lattice;
  std::string program = "tetgen";  // a path, or a name in PATH
  double timeout = 600;            // seconds by the clock
};

/// Signed distance in space, negative inside [length].
struct SpaceAnswer {
  VecX at_nodes;                                      // of the grid, where there is one
  std::shared_ptr<const PointwiseDistance> function;  // at any point, where a method has it
  TetField tets;                                      // where tets fill the grid's box
  PolygonSoup completion;  // triangles over holes, where a method has them
};

/// Values scale with the input and do not change when it is moved with the grid. Errors: InputError
/// for bad input (nothing to measure from, a box that misses it, ...), IoError where memory will
/// not do, Cancelled.
struct SpaceDomain {
  using Sources = SpaceSources;
  using Answer = SpaceAnswer;
  static constexpr const char* title = "Distance in space";

  std::optional<Grid> grid;        // without one, any point
  std::optional<TetFilling> tets;  // solve through these, and sample them on the grid

  /// "grid", "tet lattice", "tetgen mesh" or "set of points".
  std::string kind() const;
};

template <>
std::vector<Method<SpaceDomain>> library_methods();
// Its families:
std::vector<Method<SpaceDomain>> automatic_space_methods();
std::vector<Method<SpaceDomain>> space_heat_methods();
std::vector<Method<SpaceDomain>> closest_point_methods();
std::vector<Method<SpaceDomain>> convolutional_methods();
std::vector<Method<SpaceDomain>> tori_methods();
std::vector<Method<SpaceDomain>> regularized_space_methods();

/// The method for domains whose grid's box is filled with tets: by a lattice as small as the grid's
/// cells near the input and larger far from it (thesis 4.5), or by tetgen, whose tets have the
/// triangles of the input as faces and sides that grow from one grid spacing next to it to eight at
/// the box.
///
/// Through tetgen's: throws UnsupportedError for clouds and where the program is not installed;
/// InputError if the box does not hold the whole input; SolveError if the program fails, crashes,
/// hangs or answers nonsense, which it does for surfaces that cross themselves.
Method<SpaceDomain> heat_filling_method(MethodInfo info);

/// The part of the input that each sample belongs to where the options tell parts apart.
std::vector<int> parts_to_hold(const SpaceInput& input, const SpaceSignedHeat& options);

/// A field in a frame's units, asked in those of the input.
std::shared_ptr<const PointwiseDistance> placed(std::unique_ptr<const PointwiseDistance> distance,
                                                const Frame& frame);

/// Values of a field at the nodes of a grid.
VecX evaluate(const PointwiseDistance& distance, const Grid& grid, const Task& task);

/// A method from `on_grid(input, grid, options, task, report)`, which gives values at the nodes,
/// all in the input's frame.
template <class S, class OnGrid>
Method<SpaceDomain> make_grid_method(MethodInfo info, const OptionTable<S>& table, OnGrid on_grid) {
  info.domains = {"grid"};
  return make_method<SpaceDomain>(
      std::move(info), table,
      [on_grid](const SpaceDomain& domain, const S&, SolveHint, const Task&, Report& report) {
        check_grid(*domain.grid);
        report.sizes.emplace_back("nodes", static_cast<double>(domain.grid->n_nodes()));
        return [on_grid, grid = *domain.grid](const SpaceSources& sources, S& options, Task& task,
                                              Report& r) {
          const Frame frame(box_on_grid(sources.soup, grid));
          const Grid local = frame.local(grid);
          // Errors at edges and corners are proportional to the spacing of samples: it must not
          // exceed the grid's.
          const SpaceInput input = make_input(sources, frame, local.spacing.minCoeff(), task, r);
          Task rest = task.stage(0.95, "distance");
          SpaceAnswer answer{on_grid(input, local, options, rest, r), {}, {}, {}};
          answer.at_nodes *= frame.unit;
          return answer;
        };
      });
}

/// A method from `make(input, options, task, report)`, which gives a field that can be asked
/// anywhere, in the input's frame; on a grid it is asked at each node.
template <class S, class Make>
Method<SpaceDomain> make_pointwise_method(MethodInfo info, const OptionTable<S>& table, Make make) {
  info.domains = {"grid", "set of points"};
  return make_method<SpaceDomain>(
      std::move(info), table,
      [make](const SpaceDomain& domain, const S&, SolveHint, const Task&, Report& report) {
        if (domain.grid) {
          check_grid(*domain.grid);
          report.sizes.emplace_back("nodes", static_cast<double>(domain.grid->n_nodes()));
        }
        return [make, grid = domain.grid](const SpaceSources& sources, S& options, Task& task,
                                          Report& r) {
          const Frame frame(grid ? box_on_grid(sources.soup, *grid) : bounding_box(sources.soup));
          const double side = grid ? frame.local(*grid).spacing.minCoeff() : frame.query_side();
          const SpaceInput input = make_input(sources, frame, side, task, r);
          auto distance = make(input, options, task.stage(grid ? 0.3 : 0.95, "preparing"), r);
          SpaceAnswer answer;
          if (grid) {
            const Stopwatch watch(r, "evaluate");
            answer.at_nodes =
                evaluate(*distance, frame.local(*grid), task.stage(0.65, "distance")) * frame.unit;
          }
          answer.function = placed(std::move(distance), frame);
          return answer;
        };
      });
}

}  // namespace littoral
