#include "api/surface/discontinuous.h"

#include <cmath>

#include "api/surface/winding.h"
#include "base/error.h"
#include "domain/mesh/tear.h"
#include "methods/heat/discontinuous.h"
#include "methods/heat/shift.h"

namespace littoral {

SurfaceResult discontinuous_distance(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                     const Operators& ops, const SourceTerms& terms,
                                     const SignedHeat& method, const SignedHeatOptions& options,
                                     Task& task, Report& report) {
  const VecX Y = [&] {
    const Stopwatch watch(report, "diffuse");
    return method.directions(terms, options, task.stage(0.3, "diffuse"), report);
  }();
  const Stopwatch watch(report, "integrate");
  const JumpCalculus J = jump_calculus(T);
  const double h = T.mean_edge_length, tear_above = options.tear * h;
  DiscontinuousField field = integrate_discontinuous(J, Y, tear_above, options.smoothing * h * h,
                                                     task.stage(0.7, "integrate"), report);

  // One value a vertex, their mean; zero in the mean along the sources.
  VecX mean = VecX::Zero(T.n_vertices), count = mean;
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) {
      mean[T.faces(f, k)] += field.phi(f, k);
      count[T.faces(f, k)] += 1;
    }
  mean = mean.cwiseQuotient(count.cwiseMax(1));
  VecX shifted = mean;
  shift_to_mean_zero(ops.scalar, terms, shifted);
  SurfaceResult result{finish_field(ops, terms, shifted, report), {}};

  Rows<std::int64_t, 3> key = Rows<std::int64_t, 3>::Constant(mesh.n_faces(), 3, -1);
  for (int f = 0; f < mesh.n_faces(); ++f)
    if (const int t = T.triangle_of_face[f]; t >= 0)
      key.row(f) = field.piece.row(t).cast<std::int64_t>();
  TornSurface torn = tear(mesh, key);
  VecX distance(static_cast<Eigen::Index>(torn.corner.size()));
  for (Eigen::Index i = 0; i < distance.size(); ++i) {
    const auto [f, k] = torn.corner[i];
    const int v = mesh.face(f)[k], t = T.triangle_of_face[f];
    distance[i] = t < 0 || !std::isfinite(result.values[v])
                      ? result.values[v]
                      : T.unit * (field.phi(t, k) + shifted[v] - mean[v]);
  }
  torn.soup.scalars["distance"] = distance;
  result.shown = std::move(torn.soup);
  double length = 0;
  for (int e = 0; e < J.n_edges; ++e)
    if (std::abs(field.jump[e]) >= tear_above) length += T.unit * J.length[e];
  report.sizes.emplace_back("torn_length", length);
  return result;
}

SurfaceSources without_nonbounding(const SurfaceProblem& problem, const Task& task,
                                   Report& report) {
  const Stopwatch watch(report, "bounding curves");
  Report winding;
  SurfaceSources kept = bounding_sources(
      surface_winding(problem.mesh, problem.sources, {{}, problem.flip}, task, winding));
  for (const SurfaceCurve& curve : problem.sources.curves)
    if (!curve.is_signed) kept.curves.push_back(curve);
  for (const SpaceCurve& curve : problem.sources.space_curves)
    if (!curve.is_signed) kept.space_curves.push_back(curve);
  kept.points = problem.sources.points;
  if (kept.empty())
    throw InputError("no part of the curves bounds a region; --discontinuous takes such curves");
  for (const auto& [name, value] : winding.sizes)
    if (name.ends_with("bounding_length")) report.sizes.emplace_back(name, value);
  return kept;
}

}  // namespace littoral
