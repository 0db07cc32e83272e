// Regularized distance in space: through tets and on grids (Edelstein et al. 2023, section 7.4).

#include <cmath>
#include <memory>
#include <string>

#include "api/space/space_domain.h"
#include "api/tet/tet_domain.h"
#include "base/platform/memory.h"
#include "base/stopwatch.h"
#include "littoral/error.h"
#include "methods/heat/finalize.h"
#include "methods/regularized/regularized.h"
#include "operators/grid.h"
#include "sources/space/space_distances.h"
#include "spatial/grid_values.h"
#include "spatial/winding_number.h"

namespace littoral {

namespace {

/// Distance at the nodes from where it is known, not negative; +inf where nothing is, and listed.
/// With `sign` (1 or -1 at the nodes) the same with that sign, which passes through zero between
/// nodes. Dirichlet energy of linear functions, whatever else the options say.
VecX regularized_in_space(const Calculus& C, const KnownDistances& known,
                          const Regularized& options, const Task& task, Report& report,
                          const VecX* sign = nullptr) {
  const auto ops = std::make_shared<Operators>();
  ops->scalar = C;
  const Stopwatch watch(report, "solve");
  const RegularizedSolver method(ops, Regularizer::dirichlet, {}, task, SolveHint::single_rhs,
                                 ConstrainedSystem::Rows::many);
  AdmmState state;
  const AdmmResult result = method.minimize(known, options, state, task, sign);
  report_admm(result, report);
  VecX u = sign ? VecX(result.u.cwiseProduct(*sign).cwiseMax(0.0).cwiseProduct(*sign))
                : VecX(result.u.cwiseMax(0.0));
  set_unreached(u, C.component, method.reached(known), report);
  return u;
}

/// A factor of n nodes in space has about 13 n^(4/3) numbers, as seen from 16^3 to 48^3.
double factor_memory(double nodes) { return 8 * 13 * std::pow(nodes, 4.0 / 3) + 600 * nodes; }

/// 1 outside and -1 inside, at the nodes of a grid.
VecX winding_signs(const SpaceInput& input, const Grid& grid, const Task& task) {
  const OrientedPoints& s = input.samples;
  const WindingNumber winding = input.is_cloud()
                                    ? WindingNumber(s.points, s.normals, s.areas)
                                    : WindingNumber(input.surface.points, input.triangles());
  return grid_values(grid, task,
                     [&](const Vec3& x, int&) { return winding(x, 2.3) > 0.5 ? -1 : 1; });
}

Regularized linear(double alpha, double tolerance, double gap, int max_iterations) {
  Regularized out;
  out.alpha = alpha;
  out.tolerance = tolerance;
  out.gap = gap;
  out.max_iterations = max_iterations;
  return out;
}
Regularized linear(const SpaceRegularized& o) {
  return linear(o.alpha, o.tolerance, o.gap, o.max_iterations);
}
Regularized linear(const SpaceBelyaevFayolle& o) {
  return linear(0, o.tolerance, o.gap, o.max_iterations);
}

VecX on_grid(const SpaceInput& input, const Grid& grid, const Regularized& options, Task& task,
             Report& report) {
  const auto nodes = static_cast<double>(grid.n_nodes());
  check_memory(factor_memory(nodes),
               "a factorization on a grid of " + std::to_string(grid.n_nodes()) + " nodes",
               "lower option resolution, or take another method");
  const NearestSource nearest(input.surface, input.samples);
  const KnownDistances known = known_distances(grid, nearest, input.samples);
  if (known.empty()) throw InputError("the box holds no sample of the input", "nothing-there");
  const VecX sign = winding_signs(input, grid, task.stage(0.1, "signs"));
  return regularized_in_space(grid_calculus(grid), known, options, task.stage(0.9, "distance"),
                              report, &sign);
}

template <class S>
Method<SpaceDomain> grid_method(const std::string& summary, const std::string& reference,
                                const OptionTable<S>& table) {
  return make_grid_method(
      {S::method, summary, {}, {}, reference}, table,
      [](const SpaceInput& input, const Grid& grid, const S& options, Task& task, Report& report) {
        return on_grid(input, grid, linear(options), task, report);
      });
}

const std::vector<Eigen::Vector4d> corners = {Eigen::Vector4d::Unit(0), Eigen::Vector4d::Unit(1),
                                              Eigen::Vector4d::Unit(2), Eigen::Vector4d::Unit(3)};

template <class S>
Method<TetDomain> through_tets(const std::string& summary, const std::string& reference,
                               const OptionTable<S>& table) {
  return make_tet_method(
      {S::method, summary, {}, {}, reference}, table,
      [](const std::shared_ptr<const TetDiscretization>& on, const S&, SolveHint) {
        return [C = std::make_shared<const Calculus>(tet_calculus(on->operators()))](
                   const TetProblem& problem, const S& options, Task& task, Report& report) {
          const auto vertex = [&mesh = *problem.mesh](int t, int k) { return mesh.tets(t, k); };
          KnownDistances known;
          for (const auto& [v, at] : problem.known(corners, vertex, Around::with_neighbours))
            known.emplace(v, at.distance);
          if (known.empty()) throw InputError("no source vertex belongs to a tet", "nothing-there");
          return regularized_in_space(*C, known, linear(options), task.stage(0.9, "distance"),
                                      report);
        };
      });
}

constexpr const char* edelstein =
    "Edelstein, Guillen, Solomon, Ben-Chen: A Convex Optimization Framework for Regularized "
    "Geodesic Distances (2023)";
constexpr const char* belyaev =
    "Belyaev, Fayolle: An ADMM-based scheme for distance function approximation (2020)";

}  // namespace

std::vector<Method<SpaceDomain>> regularized_space_methods() {
  return {grid_method("Distance that is smooth at the medial axis, as large as a unit gradient "
                      "allows, signed by the winding number; small grids.",
                      edelstein, space_regularized_options()),
          grid_method("The same without smoothing: the largest function of gradient at most 1.",
                      belyaev, space_belyaev_fayolle_options())};
}

std::vector<Method<TetDomain>> regularized_tet_methods() {
  return {through_tets("Unsigned distance that is smooth where it has no single nearest source.",
                       edelstein, space_regularized_options()),
          through_tets("Unsigned distance as the largest function of gradient at most 1.", belyaev,
                       space_belyaev_fayolle_options())};
}

}  // namespace littoral
