// The heat methods, signed and unsigned, as entries of the registry.

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "api/surface/discontinuous.h"
#include "api/surface/discretization.h"
#include "api/surface/heat_factors.h"
#include "api/surface/heat_points.h"
#include "api/surface/heat_surface.h"
#include "api/surface/quadratic_method.h"
#include "base/stopwatch.h"
#include "methods/heat/sharpen.h"
#include "methods/heat/time_scale.h"
#include "sources/surface/source_values.h"

namespace littoral {

namespace {

/// Throws where there are no polygons to cut into triangles.
void needs_triangles(const std::string& kind, const std::string& option) {
  if (kind != "triangle mesh" && kind != "polygon mesh")
    throw UnsupportedError(
        "option " + option + " works on triangle and polygon meshes, not on a " + kind,
        "options-conflict");
}

/// Throws unless the options go with the domain and with each other.
void check_options(const std::string& kind, const SignedHeat& options) {
  if (options.sharpen != Sharpening::off && options.discontinuous)
    throw InputError(
        "option sharpen makes a continuous distance and does not go with option discontinuous",
        "options-conflict");
  if (options.discontinuous) needs_triangles(kind, "discontinuous");
  if (options.discontinuous && options.constraint == Constraint::level_sets)
    throw UnsupportedError("option discontinuous goes with constraint zero-set or none",
                           "options-conflict");
  if (options.sharpen == Sharpening::quadratic) needs_triangles(kind, "sharpen quadratic");
  if (options.bounding_only) needs_triangles(kind, "bounding-only");
  if (options.intrinsic_delaunay) needs_triangles(kind, "intrinsic-delaunay");
  if (options.discontinuous && options.intrinsic_delaunay)
    throw UnsupportedError(
        "options discontinuous and intrinsic-delaunay exclude each other: the surface is split "
        "along its own edges",
        "options-conflict");
}

/// Throws where values of sources differ and the method or the options know one alone: vectors are
/// diffused equally strong from all curves, which agree where they are level sets of one function.
void check_values(const Sources& sources, const SignedHeat& options) {
  if (value_range(sources).same()) return;
  const std::string different = " does not go with sources of different values";
  if (options.constraint == Constraint::level_sets)
    throw InputError("option constraint: level-sets finds the values of curves and" + different,
                     "options-conflict");
  const std::string option = options.sharpen != Sharpening::off ? "sharpen"
                             : options.discontinuous            ? "discontinuous"
                             : options.bounding_only            ? "bounding-only"
                                                                : "";
  if (!option.empty()) throw UnsupportedError("option " + option + different, "options-conflict");
  const auto is_signed = [](const auto& curve) { return curve.is_signed; };
  const bool all_signed =
      sources.points.empty() &&
      std::all_of(sources.curves.begin(), sources.curves.end(), is_signed) &&
      std::all_of(sources.space_curves.begin(), sources.space_curves.end(), is_signed);
  const bool gradients = sources.curves.empty() && sources.space_curves.empty() &&
                         options.point_sources == PointVectors::gradient &&
                         !options.preserve_normals;
  if (!all_signed && !gradients)
    throw UnsupportedError(
        "signed-heat takes different values of signed curves alone, or of points alone by their "
        "gradients; auto, exact and unsigned-heat take them of all");
}

/// Factors of the operators that solves share, one set for each of them; others serve one solve.
template <class Factors>
class SharedFactors {
 public:
  template <class Make>
  std::shared_ptr<const Factors> of(const std::shared_ptr<const Operators>& ops, bool shared,
                                    const Make& make) const {
    return shared ? kept_.get(ops, make) : make();
  }

 private:
  KeptByKey<std::shared_ptr<const Operators>, Factors> kept_;
};

using Answers = Solver<SurfaceDomain>::Answers;

class SignedHeatOnSurface {
 public:
  SignedHeatOnSurface(const SurfaceDomain& domain, const SignedHeat& options, SolveHint hint,
                      const Task& task, Report& report)
      : surface_(domain, options.intrinsic_delaunay, task, report), hint_(hint) {}
  /// Whose answers are not checked.
  SignedHeatOnSurface(SurfaceDiscretization on, SolveHint hint)
      : surface_(std::move(on)), hint_(hint), checks_(false) {}

  SurfaceAnswer solve(const Sources& given, SignedHeat& options, Task& task, Report& report) const {
    check_values(given, options);
    if (!options.bounding_only) return solve_all(given, options, task, report);
    return solve_all(
        without_nonbounding(surface_.domain(), given, task.stage(0.3, "bounding curves"), report),
        options, task, report);
  }

  /// Many at once if they are points by gradients of scalar heat and nothing but heat is wanted.
  AtOnce at_once(const SignedHeat& options) const {
    const bool plain = hint_ == SolveHint::many_rhs && !options.discontinuous &&
                       !options.bounding_only && options.sharpen == Sharpening::off &&
                       options.soft == 0 && !options.preserve_normals &&
                       options.point_sources == PointVectors::gradient;
    if (!plain) return {};
    return {strip_width, HeatStrips::bytes(surface_.nodes())};
  }
  Answers together(std::span<const Sources> sources, std::span<SignedHeat> options,
                   const Task& task, std::span<Report> reports) const {
    SourceSystem points;
    points.only_points = true;
    const bool given = options[0].time_scale > 0;
    const double scale = given ? options[0].time_scale : automatic_time_scale(points);
    double megabytes = 0;
    const auto strips_at = [&](const std::shared_ptr<const Operators>& ops, double at) {
      const auto factors = factors_of(ops, true);
      const Diffusions of_points{.vectors = false, .scalars = true};
      megabytes = factors->at(at, of_points, Task())->factor_megabytes();
      return factors->strips(at, Task());
    };
    std::vector<double> scales(sources.size(), scale);
    Answers answers = FromPoints(surface_, HeatStrips::Values::any, strips_at)
                          .solve(sources, scale, given, scales, task, reports);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      options[i].time_scale = scales[i];
      if (answers[i]) reports[i].sizes.emplace_back("factor_mb", megabytes);
    }
    return answers;
  }

 private:
  std::shared_ptr<const SignedHeatFactors> factors_of(const std::shared_ptr<const Operators>& ops,
                                                      bool shared) const {
    return factors_.of(ops, shared,
                       [&] { return std::make_shared<const SignedHeatFactors>(ops, hint_); });
  }
  SurfaceAnswer solve_all(const Sources& sources, SignedHeat& options, Task& task,
                          Report& report) const {
    const auto needs = [&](const PlacedSources& placed) {
      const bool gradients = placed.pieces.empty() && !options.preserve_normals &&
                             options.point_sources == PointVectors::gradient;
      return gradients ? Diffused::functions : Diffused::vectors;
    };
    bool shared = false;
    const HeatProblem problem = surface_.problem(sources, needs, shared, task, report);
    const Operators& ops = *problem.ops;
    const SourceSystem& terms = problem.terms;
    const bool checks = checks_ && !options.discontinuous && options.sharpen == Sharpening::off;
    const auto marching = checks ? surface_.marching(sources, hint_, task) : nullptr;
    const bool rises = may_rise(options.time_scale, ops);
    if (options.time_scale == 0) options.time_scale = automatic_time_scale(terms, ops);
    const auto factors = factors_of(problem.ops, shared);
    const Diffusions needed = needed_diffusions(terms, options);
    const auto first = [&] {
      const Stopwatch watch(report, "factor");
      return factors->at(options.time_scale, needed, task.stage(0.5, "factoring"));
    }();
    if (options.discontinuous) {
      Report quiet;  // they have been placed before
      return discontinuous_distance(*surface_.domain().mesh, *surface_.plain().triangulation(), ops,
                                    place_sources(surface_.domain(), sources, task, quiet), terms,
                                    *first, options, task, report);
    }
    const std::function<VecX(const SignedHeatSolver&, const Task&, Report&)> solve =
        [&](const SignedHeatSolver& heat, const Task& stage, Report& r) {
          return heat.solve(terms, options, stage, r);
        };
    const Task solving = task.stage(0.3, "solving");
    VecX phi;
    if (rises) {
      const std::function<std::shared_ptr<const SignedHeatSolver>(double, const Task&)> longer =
          [&](double scale, const Task& stage) { return factors->at(scale, needed, stage); };
      phi = solve_raising(first, longer, options.time_scale, solve, solving, report);
    } else {
      phi = solve(*first, solving, report);
      warn_misaligned(report);
    }
    if (checks) surface_.check(marching.get(), phi, task.stage(0.5, "checking"), report);
    if (options.sharpen == Sharpening::quadratic) {
      const auto elements =
          elements_.get([&] { return QuadraticOnSurface(surface_.domain(), report); });
      return elements->solve_signed(sources, surface_.at_input(phi).values, {},
                                    task.stage(1, "sharpening"), report);
    }
    if (options.sharpen == Sharpening::on) {
      SharpenOptions how;
      how.solver = options.sharpen_solver;
      phi = sharpen(ops, terms, phi, how, task.stage(1, "sharpening"), report);
    }
    return surface_.at_input(phi);
  }

  HeatSurface surface_;
  SolveHint hint_;
  bool checks_ = true;
  SharedFactors<SignedHeatFactors> factors_;
  Kept<QuadraticOnSurface> elements_;
};

class UnsignedHeatOnSurface {
 public:
  UnsignedHeatOnSurface(const SurfaceDomain& domain, const UnsignedHeat& options, SolveHint hint,
                        const Task& task, Report& report)
      : surface_(domain, options.intrinsic_delaunay, task, report), hint_(hint) {}

  AtOnce at_once(const UnsignedHeat&) const {
    if (hint_ != SolveHint::many_rhs) return {};
    return {strip_width, HeatStrips::bytes(surface_.nodes())};
  }
  Answers together(std::span<const Sources> sources, std::span<UnsignedHeat> options,
                   const Task& task, std::span<Report> reports) const {
    const bool given = options[0].time_scale > 0;
    if (!given) options[0].time_scale = 1;
    const UnsignedHeat first = options[0];
    const auto strips_at = [&](const std::shared_ptr<const Operators>& ops, double at) {
      return factors_of(ops, true, first)->strips(at, Task());
    };
    std::vector<double> scales(sources.size(), first.time_scale);
    Answers answers = FromPoints(surface_, HeatStrips::Values::not_negative, strips_at)
                          .solve(sources, first.time_scale, given, scales, task, reports);
    for (std::size_t i = 0; i < answers.size(); ++i) options[i].time_scale = scales[i];
    return answers;
  }

  SurfaceAnswer solve(const Sources& sources, UnsignedHeat& options, Task& task,
                      Report& report) const {
    const auto needs = [](const PlacedSources&) { return Diffused::functions; };
    bool shared = false;
    const HeatProblem problem = surface_.problem(sources, needs, shared, task, report);
    const auto marching = surface_.marching(sources, hint_, task);
    const bool rises = may_rise(options.time_scale, *problem.ops);
    if (options.time_scale == 0) options.time_scale = 1;
    const auto factors = factors_of(problem.ops, shared, options);
    const auto first = [&] {
      const Stopwatch watch(report, "factor");
      return factors->first(task.stage(0.5, "factoring"));
    }();
    const Stopwatch watch(report, "solve");
    const std::function<VecX(const UnsignedHeatSolver&, const Task&, Report&)> solve =
        [&](const UnsignedHeatSolver& heat, const Task& stage, Report& r) {
          return heat.solve(problem.terms, stage, r);
        };
    const Task solving = task.stage(0.4, "solving");
    VecX phi;
    if (rises) {
      const std::function<std::shared_ptr<const UnsignedHeatSolver>(double, const Task&)> longer =
          [&](double scale, const Task& stage) { return factors->longer(scale, stage); };
      phi = solve_raising(first, longer, options.time_scale, solve, solving, report);
    } else {
      phi = solve(*first, solving, report);
      warn_misaligned(report);
    }
    surface_.check(marching.get(), phi, task.stage(0.5, "checking"), report);
    return surface_.at_input(phi);
  }

 private:
  std::shared_ptr<const UnsignedHeatFactors> factors_of(const std::shared_ptr<const Operators>& ops,
                                                        bool shared,
                                                        const UnsignedHeat& options) const {
    return factors_.of(ops, shared, [&] {
      return std::make_shared<const UnsignedHeatFactors>(ops, options, hint_);
    });
  }

  HeatSurface surface_;
  SolveHint hint_;
  SharedFactors<UnsignedHeatFactors> factors_;
};

/// What solves for a method on a surface; on a polygon mesh whose options need triangles, on these.
template <class OnSurface, class Options>
Solves<SurfaceDomain, Options> prepared(const SurfaceDomain& domain, const Options& options,
                                        bool triangles, SolveHint hint, const Task& task,
                                        Report& report) {
  std::shared_ptr<const CutPolygons> cut;  // or null
  if (triangles && domain.kind() == "polygon mesh")
    cut = std::make_shared<const CutPolygons>(cut_into_triangles(domain, report));
  auto method =
      std::make_shared<const OnSurface>(cut ? cut->triangles : domain, options, hint, task, report);
  const auto one = [cut, method](const Sources& sources, Options& used, Task& t, Report& r) {
    return method->solve(cut ? cut->cut(sources) : sources, used, t, r);
  };
  const auto together = [cut, method](std::span<const Sources> sources, std::span<Options> used,
                                      const Task& t, std::span<Report> r) {
    if (!cut) return method->together(sources, used, t, r);
    std::vector<Sources> on_triangles;
    for (const Sources& each : sources) on_triangles.push_back(cut->cut(each));
    return method->together(on_triangles, used, t, r);
  };
  return {one, method->at_once(options), together};
}

auto signed_heat(const SurfaceDomain& domain, const SignedHeat& options, SolveHint hint,
                 const Task& task, Report& report) {
  check_options(domain.kind(), options);
  const bool triangles = options.discontinuous || options.bounding_only ||
                         options.intrinsic_delaunay || options.sharpen == Sharpening::quadratic;
  return prepared<SignedHeatOnSurface>(domain, options, triangles, hint, task, report);
}

auto unsigned_heat(const SurfaceDomain& domain, const UnsignedHeat& options, SolveHint hint,
                   const Task& task, Report& report) {
  if (options.intrinsic_delaunay) needs_triangles(domain.kind(), "intrinsic-delaunay");
  return prepared<UnsignedHeatOnSurface>(domain, options, options.intrinsic_delaunay, hint, task,
                                         report);
}

}  // namespace

std::function<VecX(const Sources&, Task, Report&)> unchecked_signed_heat(
    const SurfaceDomain& domain, std::shared_ptr<const IntrinsicTriangulation> T,
    const SignedHeat& options, SolveHint hint, Task task, Report& report) {
  auto method = std::make_shared<const SignedHeatOnSurface>(
      SurfaceDiscretization(domain, std::move(task), report, std::move(T)), hint);
  return [method, options](const Sources& sources, Task t, Report& r) {
    SignedHeat used = options;
    return method->solve(sources, used, t, r).values;
  };
}

std::vector<Method<SurfaceDomain>> heat_methods() {
  return {make_method<SurfaceDomain>(
              {SignedHeat::method,
               "Signed distance to curves that may be broken, unsigned to points and unsigned "
               "curves.",
               all_surfaces(),
               {},
               "Feng, Crane: A Heat Method for Generalized Signed Distance (2024)",
               true},
              signed_heat_options(), signed_heat),
          make_method<SurfaceDomain>({UnsignedHeat::method,
                                      "Unsigned distance to curves and points.",
                                      all_surfaces(),
                                      {},
                                      "Crane, Weischedel, Wardetzky: Geodesics in Heat (2013)",
                                      true},
                                     unsigned_heat_options(), unsigned_heat)};
}

}  // namespace littoral
