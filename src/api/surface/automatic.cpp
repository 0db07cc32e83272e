// Complete, then measure: the default for distance on surfaces.
//
// Where curves break, which side is which is one question and how far is another. Curves are made
// whole first, which settles the sides; then distance to all of that is measured by what is most
// accurate, and takes its sign from the sides.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "api/surface/discretization.h"
#include "api/surface/whole_curves.h"
#include "base/stopwatch.h"
#include "domain/cloud/cloud_surface.h"
#include "domain/mesh/flattened_voxels.h"
#include "domain/mesh/unique_faces.h"
#include "littoral/error.h"
#include "methods/geodesic/exact_polyhedral.h"
#include "methods/geodesic/fast_marching.h"
#include "sources/surface/source_values.h"
#include "sources/surface/triangle_sources.h"

namespace littoral {

namespace {

// Calibrated on damaged curves (docs/measurements/robustness.md).
constexpr double spread = 0.1;
constexpr int many_triangles = 100'000;  // where windows are merged

const OptionTable<Automatic>& automatic_options() {
  using O = Automatic;
  static const OptionTable<O> table =
      OptionTable<O>()
          .choice(&O::completion, "completion", {"auto", "shortest", "heat", "none"},
                  "How broken signed curves become whole: by the shortest curves that make them "
                  "bound, by the zero set of the signed heat method, or not at all; auto: not "
                  "where they bound, by the zero set where they have ends, by the shortest curves "
                  "where pieces are reversed and nothing is missing.")
          .choice(&O::metric, "metric", {"auto", "exact", "fast-marching", "heat"},
                  "What measures distance to the curves made whole: exact polyhedral distance, "
                  "fast marching, or signed heat itself; auto: exact, around clouds on their local "
                  "triangles, around voxels on these without their steps.")
          .toggle(&O::confidence, "confidence",
                  "Beside the distance, how sure its sign is, from 0 on what completes a curve to "
                  "1 far from it.")
          .number(&O::tolerance, "tolerance", "share of a distance", 0, 0.01,
                  "Every exact distance may be off by that share of it on meshes of more than "
                  "100,000 triangles, where exact search takes long; 0: exact.");
  return table;
}

class AutomaticOnTriangles {
 public:
  AutomaticOnTriangles(const SurfaceDomain& domain, SolveHint hint, Report& report)
      : AutomaticOnTriangles(domain, domain, triangulation_of(domain, report), hint) {}
  /// Triangles on the vertices of the input, which sources are given on.
  AutomaticOnTriangles(const SurfaceDomain& input, const SurfaceDomain& triangles,
                       std::shared_ptr<const IntrinsicTriangulation> T, SolveHint hint)
      : input_(input), domain_(triangles), T_(std::move(T)), curves_(triangles, T_, input, hint) {}

  SurfaceAnswer solve(const Sources& given, Automatic& options, Task& task, Report& report) const {
    const PlacedSources placed = place_sources(input_, *domain_.mesh, given,
                                               task.stage(0.05, "placing the sources"), report);
    const WholeSources whole = curves_.complete(given, placed, options.completion,
                                                task.stage(0.4, "completing the curves"), report);
    options.completion = whole.by;
    const TriangleSources on = triangle_sources(*domain_.mesh, *T_, whole.sources);
    const Stopwatch watch(report, "distance");
    const Task measuring = task.stage(0.55, "walking over the mesh");
    if (options.metric == Metric::automatic) options.metric = Metric::exact;
    if (T_->n_faces() <= many_triangles || options.metric != Metric::exact) options.tolerance = 0;
    SurfaceAnswer answer{
        value_range(given).same()
            ? VecX(measured(on, options, measuring, report).cwiseAbs().cwiseProduct(whole.sign))
            : from_values(on, whole, placed.n_curves, options, measuring, report),
        {},
        {}};
    answer.values.array() += 0.0;  // no -0
    if (options.confidence)
      answer.confidence = confidence(placed, whole, options.tolerance, measuring);
    if (input_.mesh == domain_.mesh) return answer;
    answer.shown = domain_.mesh->soup();  // a cloud is shown with its triangles
    answer.shown->scalars["distance"] = answer.values;
    if (options.confidence) answer.shown->scalars["confidence"] = answer.confidence;
    return answer;
  }

 private:
  VecX measured(const TriangleSources& on, const Automatic& options, const Task& task,
                Report& report) const {
    if (options.metric != Metric::exact) return fast_marching(*T_, on, task, report);
    return exact_polyhedral(*T_, on, task, report, {0, options.tolerance}).distance;
  }

  /// The least of c_i + d_i on positive sides, the largest of c_i - d_i on negative ones: viscosity
  /// solutions of |grad phi| = 1 for increasing and decreasing phi (Hopf and Lax). Where no source
  /// is shadowed both are c_i at source i.
  VecX from_values(TriangleSources on, const WholeSources& whole, int n_curves,
                   const Automatic& options, Task task, Report& report) const {
    for (TriangleSources::Segment& segment : on.segments) segment.is_signed = false;
    VecX phi = measured(on, options, task.stage(0.5, "walking over the mesh"), report);
    warn_of_shadowed(*T_, on, whole.sources, n_curves, phi / T_->unit, report);
    if (!(whole.sign.minCoeff() < 0)) return phi;
    for (double& value : on.value) value = -value;
    Report again;
    const VecX below = measured(on, options, task.stage(1, "walking over the mesh"), again);
    for (Eigen::Index v = 0; v < phi.size(); ++v)
      if (whole.sign[v] < 0) phi[v] = -below[v];
    return phi;
  }

  /// How sure the signs are. The curve that is missing in a gap lies beside its completion, at a
  /// distance like a normal variable of deviation `spread` times the gap's length.
  VecX confidence(const PlacedSources& given, const WholeSources& whole, double tolerance,
                  const Task& task) const {
    PlacedSources completion;
    std::map<int, double> gap;  // curve -> length
    for (std::size_t i = given.pieces.size(); i < whole.sources.pieces.size(); ++i) {
      const CurvePiece& piece = whole.sources.pieces[i];
      completion.pieces.push_back(piece);
      gap[piece.curve] += piece.length;
    }
    VecX sure = VecX::Ones(domain_.mesh->n_vertices());
    if (completion.pieces.empty()) return sure;
    Report quiet;
    const ExactDistance to = exact_polyhedral(*T_, triangle_sources(*domain_.mesh, *T_, completion),
                                              task, quiet, {0, tolerance});
    for (int v = 0; v < sure.size(); ++v)
      if (to.nearest[v] >= 0) {
        const double width = spread * gap[completion.pieces[to.nearest[v]].curve];
        sure[v] = std::erf(to.distance[v] / (width * std::numbers::sqrt2));
      }
    return sure;
  }

  SurfaceDomain input_, domain_;
  std::shared_ptr<const IntrinsicTriangulation> T_;
  WholeCurves curves_;
};

using SolveAutomatic = std::function<SurfaceAnswer(const Sources&, Automatic&, Task&, Report&)>;

/// Signed heat completes and measures at once.
SolveAutomatic by_heat(const SurfaceDomain& domain, const Automatic& options, SolveHint hint,
                       const Task& task, Report& report) {
  if (options.confidence)
    throw UnsupportedError("option confidence: there is none with metric heat", "options-conflict");
  if (options.completion != Completion::automatic && options.completion != Completion::heat)
    throw UnsupportedError("option completion: with metric heat there is heat only",
                           "options-conflict");
  return [heat = prepare<SurfaceDomain>(SignedHeat{}, domain, hint, task, report)](
             const Sources& sources, Automatic& used, Task& t, Report& r) {
    used.completion = Completion::heat;
    used.metric = Metric::heat;
    const std::string name = r.method;
    SurfaceAnswer answer = heat->solve(sources, t, r);
    r.method = name;
    const auto is_signed = [](const auto& curve) { return curve.is_signed; };
    if (std::none_of(sources.curves.begin(), sources.curves.end(), is_signed) &&
        std::none_of(sources.space_curves.begin(), sources.space_curves.end(), is_signed)) {
      answer.values = answer.values.cwiseMax(0.0);
      if (answer.shown) {
        VecX& shown = answer.shown->scalars.at("distance");
        shown = shown.cwiseMax(0.0);
      }
    }
    return answer;
  };
}

/// What lies there twice is there once: jumps along copies of faces would contradict each other.
SolveAutomatic on_triangles(const SurfaceDomain& domain, SolveHint hint, Report& report) {
  const auto unique = std::make_shared<const UniqueFaces>(domain.mesh);
  return [mesh = domain.mesh, unique,
          method = std::make_shared<const AutomaticOnTriangles>(
              SurfaceDomain{unique->mesh, {}}, hint, report)](const Sources& sources,
                                                              Automatic& used, Task& t, Report& r) {
    if (!unique->any_copies()) return method->solve(sources, used, t, r);
    r.sizes.emplace_back("copies of faces", unique->n_copies());
    return method->solve(unique->on_mesh(*mesh, sources), used, t, r);
  };
}

/// Polygons cut into triangles.
SolveAutomatic on_polygons(const SurfaceDomain& domain, SolveHint hint, Report& report) {
  Report quiet;  // that polygons are cut needs no warning where nobody asked for triangles
  auto cut = std::make_shared<const CutPolygons>(cut_into_triangles(domain, quiet));
  return [cut, solve = on_triangles(cut->triangles, hint, report)](
             const Sources& sources, Automatic& used, Task& t, Report& r) {
    return solve(cut->cut(sources), used, t, r);
  };
}

SolveAutomatic automatic(const SurfaceDomain& domain, const Automatic& options, SolveHint hint,
                         const Task& task, Report& report) {
  if (options.metric == Metric::heat) return by_heat(domain, options, hint, task, report);
  const std::string kind = domain.kind();
  if (kind == "polygon mesh") return on_polygons(domain, hint, report);
  if (kind == "voxel surface") {
    const Stopwatch watch(report, "triangulation");
    return on_polygons(
        {std::make_shared<const SurfaceMesh>(flattened_voxels(*domain.mesh, *domain.face_normals)),
         {}},
        hint, report);
  }
  if (kind == "triangle mesh") return on_triangles(domain, hint, report);
  const auto on_cloud = [&] {
    const Stopwatch watch(report, "triangulation");
    const NodalSurface S =
        cloud_surface(domain.mesh->points(), domain.mesh->soup().normals, report, task);
    return std::make_shared<const AutomaticOnTriangles>(domain, SurfaceDomain{S.refined, {}},
                                                        S.place, hint);
  };
  return [method = on_cloud()](const Sources& sources, Automatic& used, Task& t, Report& r) {
    return method->solve(sources, used, t, r);
  };
}

}  // namespace

std::vector<Method<SurfaceDomain>> automatic_methods() {
  return {make_method<SurfaceDomain>(
      {Automatic::method,
       "Signed distance to curves that may be broken and unsigned distance to others and to "
       "points: curves are made whole, then distance is measured exactly where the surface allows.",
       all_surfaces(),
       {},
       "completion: Feng, Crane (2024) and Feng, Gillespie, Crane (2023); distance: Mitchell, "
       "Mount, Papadimitriou (1987)",
       true},
      automatic_options(), automatic)};
}

}  // namespace littoral
