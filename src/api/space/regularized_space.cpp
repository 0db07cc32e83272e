#include "api/space/regularized_space.h"

#include <cmath>
#include <memory>
#include <string>

#include "api/tet/tet_method.h"
#include "base/error.h"
#include "base/platform/memory.h"
#include "domain/volume/grid_values.h"
#include "methods/heat/shift.h"
#include "operators/grid.h"
#include "spatial/winding_number.h"

namespace littoral {

namespace {

/// A factor of n nodes in space has about 13 n^(4/3) numbers, as seen from 16^3 to 48^3.
double factor_memory(double nodes) { return 8 * 13 * std::pow(nodes, 4.0 / 3) + 600 * nodes; }

/// 1 outside and -1 inside, at the nodes of a grid.
VecX winding_signs(const SpaceProblem& problem, const Grid& grid, const Task& task) {
  const OrientedPoints& s = problem.samples;
  const WindingNumber winding = problem.is_cloud()
                                    ? WindingNumber(s.points, s.normals, s.areas)
                                    : WindingNumber(problem.surface.points, problem.triangles());
  return grid_values(grid, task,
                     [&](const Vec3& x, int&) { return winding(x, 2.3) > 0.5 ? -1 : 1; });
}

VecX on_grid(const SpaceProblem& problem, const Grid& grid, const RegularizedOptions& options,
             Task& task, Report& report) {
  const auto nodes = static_cast<double>(grid.n_nodes());
  check_memory(factor_memory(nodes),
               "a factorization on a grid of " + std::to_string(grid.n_nodes()) + " nodes",
               "use a smaller --resolution or another --method");
  const GridRows rows = grid_rows(grid, problem.samples.points, problem.samples.areas);
  if (rows.A.rows() == 0) throw InputError("the box holds no sample of the input");
  // An unsigned distance would have to vanish at all nodes of the cells that hold the surface: the
  // rows are met by functions that pass through zero there.
  const VecX sign = winding_signs(problem, grid, task.stage(0.1, "signs"));
  return regularized_in_space(grid_calculus(grid), rows.A, options, task.stage(0.9, "distance"),
                              report, &sign);
}

SpaceMethod grid_method(const std::string& name, const std::string& summary,
                        const OptionTable<RegularizedOptions>& table, double alpha) {
  SpaceMethod method;
  method.info = {name,
                 summary,
                 {"triangle mesh", "polygon soup", "point cloud"},
                 table.infos(),
                 find_method(name).reference};
  const MethodInfo info = method.info;
  method.check = [info, &table](const OptionTexts& texts) { parse_options(info, table, texts); };
  method.on_grid = [info, &table, alpha](const SpaceProblem& problem, const Grid& grid,
                                         const OptionTexts& texts, Task& task, Report& report) {
    RegularizedOptions options = parse_options(info, table, texts);
    if (alpha == 0) options.alpha = 0;
    VecX phi = on_grid(problem, grid, options, task, report);
    report_options(table, options, report);
    return phi;
  };
  return method;
}

TetMethod through_tets(const std::string& name, const OptionTable<RegularizedOptions>& table,
                       bool smooth) {
  const auto read = [name, &table](const OptionTexts& texts) {
    return parse_options(find_method(name), table, texts);
  };
  const auto run = [smooth](const TetProblem& problem, RegularizedOptions& options, Task& task,
                            Report& report) {
    if (!smooth) options.alpha = 0;
    const SpMat rows = problem.terms().A;
    if (rows.rows() == 0) throw InputError("no source vertex belongs to a tet");
    return regularized_in_space(tet_calculus(problem.ops), rows, options,
                                task.stage(0.9, "distance"), report);
  };
  return tet_method(name, table, read, run);
}

}  // namespace

VecX regularized_in_space(const Calculus& C, const SpMat& rows, const RegularizedOptions& options,
                          const Task& task, Report& report, const VecX* sign) {
  if (options.alpha > 0 && static_cast<Regularizer>(options.regularizer) != Regularizer::dirichlet)
    throw UnsupportedError(
        "in space there is the regularizer dirichlet only; the others need a triangle mesh");
  if (static_cast<Elements>(options.elements) != Elements::linear)
    throw UnsupportedError("quadratic elements need a triangle mesh");
  const auto ops = std::make_shared<Operators>();
  ops->scalar = C;
  const Stopwatch watch(report, "solve");
  const Regularized method(ops, Regularizer::dirichlet, {}, task, HeldSystem::Rows::many);
  AdmmState state;
  const AdmmResult result = method.minimize(rows, options, state, task, sign);
  report_admm(result, report);
  std::vector<char> reached(static_cast<std::size_t>(C.n_components), 0);
  for (const int i : unknowns_of(rows))
    if (C.component[static_cast<std::size_t>(i)] >= 0)
      reached[static_cast<std::size_t>(C.component[static_cast<std::size_t>(i)])] = 1;
  VecX u = sign ? VecX(result.u.cwiseProduct(*sign).cwiseMax(0.0).cwiseProduct(*sign))
                : VecX(result.u.cwiseMax(0.0));
  set_unreached(u, C.component, reached, report);
  return u;
}

std::vector<SpaceMethod> regularized_space_methods() {
  return {grid_method("regularized",
                      "Distance that is smooth at the medial axis, as large as slope 1 allows, "
                      "signed by the winding number; small grids.",
                      grid_regularized_options(), 1),
          grid_method("belyaev-fayolle",
                      "The same without smoothing: the largest function of slope at most 1.",
                      grid_constrained_options(), 0)};
}

std::vector<TetMethod> regularized_tet_methods() {
  return {through_tets("regularized", regularized_options(), true),
          through_tets("belyaev-fayolle", constrained_options(), false)};
}

}  // namespace littoral
