// The methods of distance in space as entries of the registry.

#include "api/space/space_method.h"
#include "base/error.h"
#include "base/platform/memory.h"
#include "domain/mesh/triangulate.h"
#include "io/read.h"
#include "methods/heat/sharpen.h"
#include "methods/heat/signed_heat_grid.h"
#include "methods/implicit/closest_point.h"
#include "methods/implicit/convolutional_distance.h"
#include "methods/tori/tori.h"

namespace littoral {

namespace {

const std::vector<std::string> inputs = {"triangle mesh", "polygon soup", "point cloud"};

struct ClosestPointOptions {};

struct KernelOptions {
  double sharpness = 2;  // lambda = sharpness / h
};

const OptionTable<ClosestPointOptions>& no_options() {
  static const OptionTable<ClosestPointOptions> table;
  return table;
}

struct ToriOptions {
  bool noisy = false;
  int fit = 0;  // 0 closed, 1 learned
  std::string weights;
  bool drop_outliers = false;
  bool single = false;
};

const OptionTable<ToriOptions>& tori_options() {
  static const OptionTable<ToriOptions> table =
      OptionTable<ToriOptions>()
          .toggle(&ToriOptions::noisy, "noisy",
                  "For noisy clouds: tori are fitted to more neighbours and need not pass through "
                  "their points.")
          .choice(&ToriOptions::fit, "fit", {"closed", "learned"},
                  "Weights of the neighbours that a torus is fitted to: by distance, or by a small "
                  "network that sees how they lie.")
          .text(&ToriOptions::weights, "weights", "file",
                "Weights of that network in place of those that come with the library.")
          .toggle(&ToriOptions::drop_outliers, "drop-outliers",
                  "Leaves out points that hardly any neighbour agrees with.")
          .toggle(&ToriOptions::single, "single",
                  "Sums in single precision, to a millionth of the distance; less memory.");
  return table;
}

TorusFit torus_fit(const ToriOptions& options) {
  if (options.fit == 0) {
    if (!options.weights.empty()) throw InputError("--weights goes with --fit learned");
    return options.noisy ? TorusFit::noisy() : TorusFit::exact();
  }
  if (options.noisy) throw InputError("--noisy goes with --fit closed");
  if (options.weights.empty()) return TorusFit::by(LearnedFit::built_in());
  return TorusFit::by(std::make_shared<const LearnedFit>(
      LearnedFit::parse(io::read_bytes(options.weights), options.weights)));
}

const OptionTable<KernelOptions>& kernel_options() {
  static const OptionTable<KernelOptions> table = OptionTable<KernelOptions>().number(
      &KernelOptions::sharpness, "sharpness", "multiple of 1/h", 1e-3, 1e3,
      "Decay lambda of the kernel times the mean distance h between samples; larger values smooth "
      "less.");
  return table;
}

std::unique_ptr<const PointwiseDistance> closest_point(const SpaceProblem& problem, SignRule rule) {
  return problem.is_cloud()
             ? closest_point_distance(problem.samples, rule)
             : closest_point_distance(problem.surface.points, problem.triangles(), rule);
}

using Kernel = std::unique_ptr<const PointwiseDistance>(const OrientedPoints&, double lambda);

SpaceMethod kernel_method(const std::string& name, const std::string& summary,
                          const std::string& reference, Kernel* kernel) {
  return pointwise_method(
      {name, summary, inputs, {}, reference}, kernel_options(),
      [kernel](const SpaceProblem& problem, const KernelOptions& options, const Task&, Report&) {
        return kernel(problem.samples, options.sharpness / sample_spacing(problem.samples));
      });
}

}  // namespace

MatX3i SpaceProblem::triangles() const { return triangles_of(surface); }

std::vector<SpaceMethod> space_heat_methods() {
  SpaceMethod heat;
  heat.info = {"signed-heat",
               "Signed distance around surfaces that may be broken: diffuses normals, integrates "
               "directions.",
               inputs, space_heat_options().infos(),
               "Feng, Crane: A Heat Method for Generalized Signed Distance (2024)"};
  const MethodInfo info = heat.info;
  heat.check = [info](const OptionTexts& texts) {
    parse_options(info, space_heat_options(), texts);
  };
  heat.on_grid = [info](const SpaceProblem& problem, const Grid& grid, const OptionTexts& texts,
                        Task& task, Report& report) {
    const SpaceHeatOptions options = parse_options(info, space_heat_options(), texts);
    if (options.sharpen)
      check_memory(grid_sharpening_memory(static_cast<double>(grid.n_nodes())),
                   "sharpening on a grid of " + std::to_string(grid.n_nodes()) + " nodes",
                   "use a smaller --resolution or leave out --sharpen");
    VecX phi = signed_heat_grid(grid, problem.samples, options,
                                task.stage(options.sharpen ? 0.2 : 1, "signed heat"), report);
    if (options.sharpen) {
      Operators ops;
      ops.domain = "grid";
      ops.scalar = grid_calculus(grid);
      phi = sharpen_in_space(ops, grid_rows(grid, problem.samples.points, problem.samples.areas).A,
                             phi, SharpenSolver::admm, task.stage(0.8, "sharpening"), report);
    }
    report_options(space_heat_options(), options, report);
    return phi;
  };
  return {heat};
}

std::vector<SpaceMethod> closest_point_methods() {
  return {
      pointwise_method({"winding",
                        "Distance to the nearest point, negative where the winding number exceeds "
                        "1/2.",
                        inputs,
                        {},
                        "Barill et al.: Fast Winding Numbers for Soups and Clouds (2018)"},
                       no_options(),
                       [](const SpaceProblem& problem, const ClosestPointOptions&, const Task&,
                          Report&) { return closest_point(problem, SignRule::winding); }),
      pointwise_method({"closest-point",
                        "Distance to the nearest point, signed by the pseudonormal there; exact on "
                        "closed meshes.",
                        inputs,
                        {},
                        "Baerentzen, Aanaes: Signed Distance Computation Using the Angle Weighted "
                        "Pseudonormal (2005)"},
                       no_options(),
                       [](const SpaceProblem& problem, const ClosestPointOptions&, const Task&,
                          Report&) { return closest_point(problem, SignRule::pseudonormal); }),
  };
}

std::vector<SpaceMethod> convolutional_methods() {
  const std::string thesis = "Feng: Generalized Distance and Winding (2026)";
  return {
      kernel_method("hopf-cole", "Logarithm of the screened winding number (eq. 5.8).", thesis,
                    &hopf_cole_distance),
      kernel_method("planar", "Weighted mean of the distances to the samples' planes (eq. 5.9).",
                    thesis, &planar_distance),
      kernel_method(
          "log-sum-exp",
          "Smooth minimum of the distances to the samples, signed by the winding number.",
          "Madan, Levin: Fast Evaluation of Smooth Distance Constraints on Co-Dimensional "
          "Geometry (2022)",
          &log_sum_exp_distance),
  };
}

std::vector<SpaceMethod> tori_methods() {
  return {pointwise_method(
      {"tori",
       "Blend of the tori that fit the surface around each point best; with clouds and samples of "
       "meshes.",
       inputs,
       {},
       "Feng: Generalized Distance and Winding (2026), chapter 5"},
      tori_options(),
      [](const SpaceProblem& problem, const ToriOptions& options, const Task& task,
         Report& report) {
        const TorusFit fit = torus_fit(options);
        const auto precision = options.single ? ToriPrecision::single : ToriPrecision::full;
        if (!problem.tori.empty())
          return std::make_unique<const Tori>(problem.surface.points, problem.tori, precision);
        const Stopwatch watch(report, "fit");
        return std::make_unique<const Tori>(
            problem.samples, fit, task, report, precision,
            options.drop_outliers ? ToriOutliers::drop : ToriOutliers::keep);
      })};
}

const std::vector<SpaceMethod>& space_methods() {
  static const auto all =
      all_of<SpaceMethod>({space_heat_methods, closest_point_methods, convolutional_methods,
                           tori_methods, regularized_space_methods});
  return all;
}

std::vector<MethodInfo> space_method_infos() {
  std::vector<MethodInfo> infos;
  for (const SpaceMethod& method : space_methods()) infos.push_back(method.info);
  return infos;
}

const SpaceMethod& find_space_method(const std::string& name) {
  std::string known;
  for (const SpaceMethod& method : space_methods()) {
    if (method.info.name == name) return method;
    known += (known.empty() ? "" : ", ") + method.info.name;
  }
  throw InputError("unknown method '" + name + "'; known: " + known);
}

}  // namespace littoral
