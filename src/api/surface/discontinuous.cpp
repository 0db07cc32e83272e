#include "api/surface/discontinuous.h"

#include <cmath>

#include "api/surface/winding.h"
#include "base/stopwatch.h"
#include "domain/mesh/split_at_jumps.h"
#include "littoral/error.h"
#include "methods/heat/discontinuous.h"
#include "methods/heat/finalize.h"

namespace littoral {

SurfaceAnswer discontinuous_distance(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                     const Operators& ops, const SourceSystem& terms,
                                     const SignedHeatSolver& method, const SignedHeat& options,
                                     Task& task, Report& report) {
  const VecX Y = [&] {
    const Stopwatch watch(report, "diffuse");
    return method.directions(terms, options, task.stage(0.3, "diffuse"), report);
  }();
  const Stopwatch watch(report, "integrate");
  const JumpCalculus J = jump_calculus(T);
  const double h = T.mean_edge_length, jump_threshold = options.jump_threshold * h;
  DiscontinuousField field = integrate_discontinuous(
      J, Y, jump_threshold, options.smoothing * h * h, task.stage(0.7, "integrate"), report);

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
  SurfaceAnswer result{finalize_field(ops, terms, shifted, report), {}};

  Rows<std::int64_t, 3> key = Rows<std::int64_t, 3>::Constant(mesh.n_faces(), 3, -1);
  for (int f = 0; f < mesh.n_faces(); ++f)
    if (const int t = T.triangle_of_face[f]; t >= 0)
      key.row(f) = field.piece.row(t).cast<std::int64_t>();
  SplitSurface split = split_at_jumps(mesh, key);
  VecX distance(static_cast<Eigen::Index>(split.corner.size()));
  for (Eigen::Index i = 0; i < distance.size(); ++i) {
    const auto [f, k] = split.corner[i];
    const int v = mesh.face(f)[k], t = T.triangle_of_face[f];
    distance[i] = t < 0 || !std::isfinite(result.values[v])
                      ? result.values[v]
                      : T.unit * (field.phi(t, k) + shifted[v] - mean[v]);
  }
  split.soup.scalars["distance"] = distance;
  result.shown = std::move(split.soup);
  double length = 0;
  for (int e = 0; e < J.n_edges; ++e)
    if (std::abs(field.jump[e]) >= jump_threshold) length += T.unit * J.length[e];
  report.sizes.emplace_back("jump_length", length);
  return result;
}

Sources without_nonbounding(const SurfaceDomain& domain, const Sources& sources, const Task& task,
                            Report& report) {
  const Stopwatch watch(report, "bounding curves");
  Report winding;
  Sources kept = bounding_sources(
      solve_once<WindingDomain>(SurfaceWinding{}, {domain.mesh}, sources, task, winding));
  for (const Curve& curve : sources.curves)
    if (!curve.is_signed) kept.curves.push_back(curve);
  for (const SpaceCurve& curve : sources.space_curves)
    if (!curve.is_signed) kept.space_curves.push_back(curve);
  kept.points = sources.points;
  if (kept.empty())
    throw InputError(
        "no part of the curves bounds a region; option discontinuous takes such curves");
  for (const auto& [name, value] : winding.sizes)
    if (name.ends_with("bounding_length")) report.sizes.emplace_back(name, value);
  return kept;
}

}  // namespace littoral
