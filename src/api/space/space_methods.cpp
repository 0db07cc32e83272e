// The methods of distance in space as entries of the registry.

#include "api/space/space_domain.h"
#include "api/space/tori_cloud.h"
#include "base/platform/memory.h"
#include "base/stopwatch.h"
#include "io/read.h"
#include "littoral/error.h"
#include "methods/heat/sharpen.h"
#include "methods/heat/signed_heat_grid.h"
#include "methods/implicit/closest_point.h"
#include "methods/implicit/convolutional_distance.h"
#include "methods/tori/tori.h"
#include "sources/space/parts_of_samples.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {}  // namespace

const OptionTable<Tori>& tori_options() {
  static const OptionTable<Tori> table =
      OptionTable<Tori>()
          .toggle(&Tori::noisy, "noisy",
                  "For noisy clouds: tori are fitted to more neighbours and need not pass through "
                  "their points.")
          .choice(&Tori::fit, "fit", {"closed", "learned"},
                  "Weights of the neighbours that a torus is fitted to: by distance, or by a small "
                  "network that sees how they lie.")
          .text(&Tori::weights, "weights", "file",
                "Weights of that network in place of those that come with the library.")
          .toggle(&Tori::drop_outliers, "drop-outliers",
                  "Leaves out points that hardly any neighbour agrees with.")
          .toggle(&Tori::single, "single",
                  "Sums in single precision, to a millionth of the distance; less memory.");
  return table;
}

namespace {

TorusFit torus_fit(const Tori& options) {
  if (options.fit == TorusWeights::closed) {
    if (!options.weights.empty())
      throw InputError("option weights goes with fit learned", "options-conflict");
    return options.noisy ? TorusFit::noisy() : TorusFit::exact();
  }
  if (options.noisy) throw InputError("option noisy goes with fit closed", "options-conflict");
  if (options.weights.empty()) return TorusFit::by(LearnedFit::built_in());
  return TorusFit::by(std::make_shared<const LearnedFit>(
      LearnedFit::parse(io::FileBytes(options.weights).view(), options.weights)));
}

template <class S>
const OptionTable<S>& kernel_options() {
  static const OptionTable<S> table = OptionTable<S>().number(
      &S::sharpness, "sharpness", "multiple of 1/h", 1e-3, 1e3,
      "Decay lambda of the kernel times the mean distance h between samples; larger values smooth "
      "less.");
  return table;
}

/// A method without options whose sign follows a rule.
template <class S>
Method<SpaceDomain> closest_point_method(const std::string& summary, const std::string& reference,
                                         SignRule rule) {
  static const OptionTable<S> none;
  return make_pointwise_method({S::method, summary, {}, {}, reference, true}, none,
                               [rule](const SpaceInput& input, const S&, const Task&, Report&) {
                                 return input.is_cloud()
                                            ? closest_point_distance(input.samples, rule)
                                            : closest_point_distance(input.surface.points,
                                                                     input.triangles(), rule);
                               });
}

using Kernel = std::unique_ptr<const PointwiseDistance>(const OrientedPoints&, double lambda);

template <class S>
Method<SpaceDomain> kernel_method(const std::string& summary, const std::string& reference,
                                  Kernel* kernel) {
  return make_pointwise_method(
      {S::method, summary, {}, {}, reference}, kernel_options<S>(),
      [kernel](const SpaceInput& input, const S& options, const Task&, Report&) {
        return kernel(input.samples, options.sharpness / sample_spacing(input.samples));
      });
}

}  // namespace

std::vector<int> parts_to_hold(const SpaceInput& input, const SpaceSignedHeat& options) {
  if (options.constraint != SpaceConstraint::level_sets) return {};
  return parts_of_samples(input.surface, input.samples);
}

namespace {

VecX heat_on_grid(const SpaceInput& input, const Grid& grid, SpaceSignedHeat& options, Task& task,
                  Report& report) {
  options = settled(options, false);
  check_level_sets(options, !input.values.empty());
  if (options.sharpen)
    check_memory(grid_sharpening_memory(static_cast<double>(grid.n_nodes())),
                 "sharpening on a grid of " + std::to_string(grid.n_nodes()) + " nodes",
                 "lower option resolution, or leave out option sharpen");
  VecX phi = signed_heat_grid(grid, input.samples, options,
                              task.stage(options.sharpen ? 0.2 : 1, "signed heat"), report,
                              parts_to_hold(input, options), input.sample_values);
  if (!options.sharpen) return phi;
  Operators ops;
  ops.domain = "grid";
  ops.scalar = grid_calculus(grid);
  return sharpen_in_space(ops, grid_rows(grid, input.samples.points, input.samples.areas).A, phi,
                          SharpenSolver::admm, task.stage(0.8, "sharpening"), report);
}

}  // namespace

std::vector<Method<SpaceDomain>> space_heat_methods() {
  const MethodInfo info = {
      SpaceSignedHeat::method,
      "Signed distance around surfaces that may be broken: diffuses normals, integrates "
      "directions.",
      {},
      {},
      "Feng, Crane: A Heat Method for Generalized Signed Distance (2024)",
      true};
  Method<SpaceDomain> heat = make_grid_method(info, space_heat_options(), heat_on_grid);
  heat.info.domains = {"grid", "tet lattice", "tetgen mesh"};
  heat.prepare = [on_grid = heat.prepare, through_tets = heat_filling_method(info).prepare](
                     const SpaceDomain& domain, const std::any& options, SolveHint hint,
                     const Task& task, Report& report) {
    return (domain.tets ? through_tets : on_grid)(domain, options, hint, task, report);
  };
  return {heat};
}

std::vector<Method<SpaceDomain>> closest_point_methods() {
  return {closest_point_method<WindingSign>(
              "Distance to the nearest point, negative where the winding number exceeds 1/2.",
              "Barill et al.: Fast Winding Numbers for Soups and Clouds (2018)", SignRule::winding),
          closest_point_method<ClosestPoint>(
              "Distance to the nearest point, signed by the pseudonormal there; exact on closed "
              "meshes.",
              "Baerentzen, Aanaes: Signed Distance Computation Using the Angle Weighted "
              "Pseudonormal (2005)",
              SignRule::pseudonormal)};
}

std::vector<Method<SpaceDomain>> convolutional_methods() {
  const std::string thesis = "Feng: Generalized Distance and Winding (2026)";
  return {kernel_method<HopfCole>("Logarithm of the screened winding number (eq. 5.8).", thesis,
                                  &hopf_cole_distance),
          kernel_method<Planar>("Weighted mean of the distances to the samples' planes (eq. 5.9).",
                                thesis, &planar_distance),
          kernel_method<LogSumExp>(
              "Smooth minimum of the distances to the samples, signed by the winding number.",
              "Madan, Levin: Fast Evaluation of Smooth Distance Constraints on Co-Dimensional "
              "Geometry (2022)",
              &log_sum_exp_distance)};
}

std::vector<Method<SpaceDomain>> tori_methods() {
  return {make_pointwise_method(
      {Tori::method,
       "Blend of the tori that fit the surface around each point best; with clouds and samples of "
       "meshes.",
       {},
       {},
       "Feng: Generalized Distance and Winding (2026), chapter 5"},
      tori_options(),
      [](const SpaceInput& input, const Tori& options, const Task& task, Report& report) {
        return fit_tori(input, options, task, report);
      })};
}

std::unique_ptr<const ToriDistance> fit_tori(const SpaceInput& input, const Tori& options,
                                             const Task& task, Report& report) {
  const TorusFit fit = torus_fit(options);
  const auto precision = options.single ? ToriPrecision::single : ToriPrecision::full;
  if (!input.tori.empty())
    return std::make_unique<const ToriDistance>(input.surface.points, input.tori, precision);
  const Stopwatch watch(report, "fit");
  return std::make_unique<const ToriDistance>(
      input.samples, fit, task, report, precision,
      options.drop_outliers ? ToriOutliers::drop : ToriOutliers::keep);
}

}  // namespace littoral
