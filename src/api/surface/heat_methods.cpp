// The heat methods, signed and unsigned, as entries of the registry.

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "api/surface/discontinuous.h"
#include "api/surface/signed_quadratic.h"
#include "api/surface/surface_method.h"
#include "api/surface/translated.h"
#include "base/error.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "domain/mesh/covering_mesh.h"
#include "domain/mesh/triangulate.h"
#include "methods/heat/sharpen.h"
#include "methods/heat/signed_heat.h"
#include "methods/heat/time_scale.h"
#include "methods/heat/unsigned_heat.h"
#include "operators/triangles.h"
#include "sources/carried_sources.h"
#include "sources/refined_sources.h"
#include "sources/triangle_source_terms.h"

namespace littoral {

namespace {

/// What the method diffuses from the sources: functions can use a cover, vectors cannot.
enum class Diffused { functions, vectors };
using Needs = std::function<Diffused(const PreparedSources&)>;

/// Throws where there are no polygons to cut into triangles.
void needs_triangles(const SurfaceProblem& problem, const std::string& option) {
  if (problem.domain() != "triangle mesh" && problem.domain() != "polygon mesh")
    throw UnsupportedError("option " + option + " works on triangle and polygon meshes, not on a " +
                           problem.domain());
}

/// A polygon mesh cut into triangles on its own vertices, with the same sources.
struct CutProblem {
  SurfaceMesh mesh;
  SurfaceSources sources;
};

CutProblem cut_into_triangles(const SurfaceProblem& problem, Report& report) {
  const SurfaceMesh& input = problem.mesh;
  CutProblem cut{SurfaceMesh(triangulate(input.soup())), {}};
  std::vector<int> face_offsets{0};  // n corners give n - 2 triangles
  for (int f = 0; f < input.n_faces(); ++f)
    face_offsets.push_back(face_offsets.back() + static_cast<int>(input.face(f).size()) - 2);
  cut.sources = refined_sources(input, cut.mesh, face_offsets, problem.sources);
  report.warn("the polygons were cut into triangles, as the options ask for these");
  return cut;
}

/// Throws unless the options go with the domain and with each other.
void check_options(const SurfaceProblem& problem, const SignedHeatOptions& options) {
  const bool quadratic = static_cast<Sharpening>(options.sharpen) == Sharpening::quadratic;
  if (options.sharpen != 0 && options.discontinuous)
    throw InputError("--sharpen makes a continuous distance; leave out --discontinuous");
  if (options.discontinuous) needs_triangles(problem, "discontinuous");
  if (quadratic) needs_triangles(problem, "sharpen quadratic");
  if (options.bounding_only) needs_triangles(problem, "bounding-only");
  if (options.intrinsic_delaunay) needs_triangles(problem, "intrinsic-delaunay");
  if (options.discontinuous && options.intrinsic_delaunay)
    throw UnsupportedError(
        "options discontinuous and intrinsic-delaunay exclude each other: the surface is torn "
        "along its own edges");
}

bool is_nonmanifold(const IntrinsicTriangulation& T) {
  return std::any_of(T.edge_use.begin(), T.edge_use.end(), [](int n) { return n > 2; });
}

Translated translate_triangles(const SurfaceProblem& problem, bool retriangulate, Needs needs,
                               Task& task, Report& report) {
  const PreparedSources prepared = prepared_sources(problem, task, report);
  task.checkpoint();
  const auto T = [&] {
    const Stopwatch watch(report, "triangulation");
    return std::make_shared<const IntrinsicTriangulation>(
        intrinsic_triangulation(problem.mesh, report));
  }();
  const Task stage = task.stage(0.03, "operators");
  stage.checkpoint();
  if (!retriangulate) {
    const Stopwatch watch(report, "operators");
    auto ops = std::make_shared<const Operators>(triangle_operators(T, stage));
    SourceTerms terms = source_terms(problem.mesh, *T, prepared);
    return {std::move(ops), std::move(terms), T, nullptr};
  }
  const Retriangulated fine = [&] {
    const Stopwatch watch(report, "retriangulation");
    if (needs(prepared) == Diffused::vectors || !is_nonmanifold(*T))
      return retriangulated(problem.mesh, *T, prepared, {}, report, stage);
    const CoveringMesh cover = covering_mesh(problem.mesh, *T);
    return retriangulated(cover.mesh, cover.T, covering_sources(problem.mesh, *T, cover, prepared),
                          {}, report, stage);
  }();
  const Stopwatch watch(report, "operators");
  auto ops = std::make_shared<const Operators>(triangle_operators(fine.T));
  return {std::move(ops), source_terms(fine.mesh, fine.T, fine.sources), nullptr, nullptr};
}

/// The problem as operators and source terms: the first 10 % of a task.
Translated translate(const SurfaceProblem& problem, bool retriangulate, Needs needs, Task& task,
                     Report& report) {
  const bool triangles = problem.domain() == "triangle mesh";
  Translated out = triangles ? translate_triangles(problem, retriangulate, needs, task, report)
                             : translate_nodes(problem, task, report);
  task.stage(0.05, "heat method").checkpoint();
  return out;
}

/// Solves at a time scale that may rise, or at the given one. Vectors at nodes do not show what
/// makes it rise elsewhere, and unsigned curves are wrong there at larger ones.
template <class Method>
VecX at_time_scale(
    bool may_rise, Method& method, double& time_scale,
    const std::type_identity_t<std::function<VecX(const Method&, const Task&, Report&)>>& solve,
    const Task& task, Report& report) {
  if (may_rise) return solve_raising(method, time_scale, solve, task, report);
  VecX phi = solve(method, task, report);
  warn_against(report);
  return phi;
}

SurfaceResult signed_heat(const SurfaceProblem& problem, SignedHeatOptions& options, Task& task,
                          Report& report) {
  check_options(problem, options);
  if (problem.domain() == "polygon mesh" &&
      (options.discontinuous || options.bounding_only || options.intrinsic_delaunay ||
       static_cast<Sharpening>(options.sharpen) == Sharpening::quadratic)) {
    const CutProblem cut = cut_into_triangles(problem, report);
    return signed_heat({cut.mesh, cut.sources, problem.flip}, options, task, report);
  }
  if (options.bounding_only) {
    const SurfaceSources kept =
        without_nonbounding(problem, task.stage(0.3, "bounding curves"), report);
    SignedHeatOptions all = options;
    all.bounding_only = false;
    SurfaceResult result = signed_heat({problem.mesh, kept}, all, task, report);
    options.time_scale = all.time_scale;
    return result;
  }
  const auto needs = [&](const PreparedSources& sources) {
    const bool gradients = sources.pieces.empty() && !options.preserve_normals &&
                           static_cast<PointVectors>(options.points) == PointVectors::gradient;
    return gradients ? Diffused::functions : Diffused::vectors;
  };
  const auto [ops, terms, T, faces] =
      translate(problem, options.intrinsic_delaunay, needs, task, report);
  const bool automatic = options.time_scale == 0, may_rise = automatic && !ops->vector.at_nodes;
  if (automatic) options.time_scale = automatic_time_scale(terms, *ops);
  auto method = [&, &operators = ops, &source = terms] {
    const Stopwatch watch(report, "factor");
    return SignedHeat(operators, options.time_scale, task.stage(0.65, "factoring"),
                      needed_diffusions(source, options), Expect::one_solve);
  }();
  if (options.discontinuous)
    return discontinuous_distance(problem.mesh, *T, *ops, terms, method, options, task, report);
  VecX phi = at_time_scale(
      may_rise, method, options.time_scale,
      [&, &source = terms](const SignedHeat& heat, const Task& stage, Report& r) {
        return heat.solve(source, options, stage, r);
      },
      task.stage(0.25, "solving"), report);
  if (static_cast<Sharpening>(options.sharpen) == Sharpening::quadratic)
    return signed_quadratic(problem, at_input(problem, nullptr, phi).values, {},
                            task.stage(1, "sharpening"), report);
  if (static_cast<Sharpening>(options.sharpen) == Sharpening::on) {
    SharpenOptions how;
    how.solver = static_cast<SharpenSolver>(options.sharpen_solver);
    phi = sharpen(*ops, terms, phi, how, task.stage(1, "sharpening"), report);
  }
  return at_input(problem, faces.get(), phi);
}

SurfaceResult unsigned_heat(const SurfaceProblem& problem, UnsignedHeatOptions& options, Task& task,
                            Report& report) {
  if (options.intrinsic_delaunay) {
    needs_triangles(problem, "intrinsic-delaunay");
    if (problem.domain() == "polygon mesh") {
      const CutProblem cut = cut_into_triangles(problem, report);
      return unsigned_heat({cut.mesh, cut.sources, problem.flip}, options, task, report);
    }
  }
  const auto needs = [](const PreparedSources&) { return Diffused::functions; };
  const auto [ops, terms, T, faces] =
      translate(problem, options.intrinsic_delaunay, needs, task, report);
  const bool automatic = options.time_scale == 0, may_rise = automatic && !ops->vector.at_nodes;
  if (automatic) options.time_scale = 1;
  auto method = [&, &operators = ops] {
    const Stopwatch watch(report, "factor");
    return UnsignedHeat(operators, options, task.stage(0.65, "factoring"), Expect::one_solve);
  }();
  const Stopwatch watch(report, "solve");
  const VecX phi = at_time_scale(
      may_rise, method, options.time_scale,
      [&source = terms](const UnsignedHeat& heat, const Task& stage, Report& r) {
        return heat.solve(source, stage, r);
      },
      task.stage(0.25, "solving"), report);
  return at_input(problem, faces.get(), phi);
}

}  // namespace

std::vector<SurfaceMethod> heat_methods() {
  return {surface_method(
              {"signed-heat",
               "Signed distance to curves that may be broken, unsigned to points and unsigned "
               "curves.",
               all_surfaces(),
               {},
               "Feng, Crane: A Heat Method for Generalized Signed Distance (2024)"},
              signed_heat_options(), signed_heat),
          surface_method({"unsigned-heat",
                          "Unsigned distance to curves and points.",
                          all_surfaces(),
                          {},
                          "Crane, Weischedel, Wardetzky: Geodesics in Heat (2013)"},
                         unsigned_heat_options(), unsigned_heat)};
}

}  // namespace littoral
