#include "methods/heat/signed_heat_grid.h"

#include <cmath>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "base/run_interruptible.h"
#include "base/stopwatch.h"
#include "littoral/error.h"
#include "methods/heat/convolve.h"
#include "solve/multigrid/cosine_transform.h"
#include "solve/multigrid/grid_multipliers.h"
#include "solve/multigrid/held_grid.h"
#include "solve/poisson/constrained_poisson.h"

namespace littoral {

namespace {
constexpr double zero_set_tolerance = 1e-2;  // in grid spacings, root mean square
constexpr Eigen::Index least_rows_for_blocks = 2000;
}  // namespace

const OptionTable<SpaceSignedHeat>& space_heat_options() {
  using O = SpaceSignedHeat;
  static const OptionTable<O> table =
      OptionTable<O>()
          .number(
              &O::time_scale, "time-scale", "multiple of h^2", 1e-4, 1e6,
              "Diffusion time t as a multiple of h^2, h being the mean distance between samples "
              "of the input; larger values smooth more and close wider gaps.")
          .choice(
              &O::constraint, "constraint", {"automatic", "none", "zero-set", "soft", "level-sets"},
              "Values at the source: shifted to mean zero, zero in every grid cell, drawn to zero "
              "by a penalty on their squares, or constant along each connected part of a surface. "
              "Automatic: zero-set through tets that are "
              "given or follow the input, where no weight is given, otherwise soft.")
          .number(&O::soft, "soft", "weight, 0 = 10", 0, 1e12,
                  "Weight of that penalty; larger values follow the source more closely, with its "
                  "noise.")
          .toggle(&O::sharpen, "sharpen",
                  "Afterwards makes the distance as large as a unit gradient allows, with the same "
                  "zero "
                  "set.");
  return table;
}

SpaceSignedHeat settled(SpaceSignedHeat options, bool conforming) {
  if (options.constraint == SpaceConstraint::automatic)
    options.constraint =
        conforming && !(options.soft > 0) ? SpaceConstraint::zero_set : SpaceConstraint::soft;
  if (!(options.soft > 0)) options.soft = 10;
  return options;
}

void check_level_sets(const SpaceSignedHeat& options, bool different_values) {
  const bool level_sets = options.constraint == SpaceConstraint::level_sets;
  if (level_sets && options.sharpen)
    throw InputError("option sharpen holds one zero set and does not go with constraint level-sets",
                     "options-conflict");
  if (!different_values) return;
  if (level_sets)
    throw InputError(
        "option constraint: level-sets finds the values of surfaces and does not go with sources "
        "of different values",
        "options-conflict");
  if (options.sharpen)
    throw UnsupportedError("option sharpen does not go with sources of different values",
                           "options-conflict");
}

HeldRows held_rows(const SpaceSignedHeat& options, const VecX& weight, double scale,
                   const std::vector<int>& part) {
  HeldRows held{VecX::Zero(weight.size()), {}};
  if (options.constraint == SpaceConstraint::soft)
    held.softness = scale / (options.soft * weight.array());
  if (options.constraint == SpaceConstraint::level_sets) {
    held.group = part;
    held.group.resize(std::size_t(weight.size()), 0);
  }
  return held;
}

VecX signed_heat_grid(const Grid& grid, const OrientedPoints& source, const SpaceSignedHeat& given,
                      Task task, Report& report, const std::vector<int>& part,
                      const std::vector<double>& value) {
  const SpaceSignedHeat options = settled(given, false);
  const double h = sample_spacing(source);
  const double root_t = std::sqrt(options.time_scale) * h;
  const Task diffuse_stage = task.stage(0.5, "diffusing normals");
  const Task solve_stage = task.stage(0.2, "integrating");
  const Task constrain_stage = task.stage(0.3, "holding the zero set");

  // Steps I and II: X_t by convolution, Y = X / |X|.
  Directions Y;
  {
    const Stopwatch watch(report, "diffuse");
    const auto X =
        run_interruptible(diffuse_stage, [source, root_t] { return Convolution(source, root_t); });
    Y = sample_directions(
        grid, [&X](const Vec3* x, int n, Flow* out) { (*X)(x, n, out); }, diffuse_stage, report);
  }

  // Step III: L phi = G^T Y.
  const Stopwatch watch(report, "integrate");
  VecX phi = grid_divergence(grid, Y, solve_stage);
  Y.resize(0, 3);
  GridPoisson(grid.n, grid.spacing).solve(phi, solve_stage);
  solve_stage.checkpoint(1);
  const GridRows rows = grid_rows(grid, source.points, source.areas, part, value);
  constrain_stage.checkpoint();
  if (rows.A.rows() == 0) {
    report.warn("box-misses-input",
                "the box holds no sample of the input, so that distances are known up to a "
                "constant only; take option bounds that hold a part of it");
    return phi;
  }
  const auto constraint = options.constraint;
  const auto shift_to_mean_zero = [&] {
    phi.array() -= rows.weight.dot(rows.A * phi - rows.value) / rows.weight.sum();
  };
  if (constraint == SpaceConstraint::none) {
    shift_to_mean_zero();
    return phi;
  }
  // L is the integral over space divided by the volume of a cell.
  HeldRows held = held_rows(options, rows.weight, grid.spacing.prod() * h, rows.part);
  const ConstraintRows constraints{rows.A, std::move(held.softness),
                                   zero_set_tolerance * grid.spacing.minCoeff(),
                                   std::move(held.group), rows.value};
  // Rows that are held exactly nearly depend on one another, which blocks do not help.
  const bool by_blocks =
      constraint == SpaceConstraint::soft && rows.A.rows() >= least_rows_for_blocks;
  HeldGrid held_grid(grid.n, grid.spacing, rows.A);
  ConstraintSolver solver{
      [&](const VecX& v) { return held_grid.across(v, constrain_stage); },
      [&](VecX& x, const VecX& v) { held_grid.subtract(x, v, constrain_stage); }};
  std::optional<GridMultipliers> blocks;
  if (by_blocks) {
    blocks.emplace(grid.n, grid.spacing, rows.A, rows.weight, constraints.softness);
    solver.precondition = [&](const VecX& r) { return (*blocks)(r, constrain_stage); };
  }
  phi = solve_constrained(solver, std::move(phi), constraints, constrain_stage, report);
  if (constraint == SpaceConstraint::level_sets) shift_to_mean_zero();
  return phi;
}

}  // namespace littoral
