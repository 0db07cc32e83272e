#include "api/surface/discontinuous.h"

#include <algorithm>
#include <cmath>

#include "api/surface/winding.h"
#include "base/index.h"
#include "base/stopwatch.h"
#include "domain/mesh/split_at_jumps.h"
#include "littoral/error.h"
#include "methods/heat/discontinuous.h"
#include "methods/heat/finalize.h"
#include "methods/heat/time_scale.h"
#include "sources/surface/triangle_sources.h"

namespace littoral {

namespace {

/// Sources where phi is to be 0, for constraint zero-set or a penalty; none for constraint none.
HeldSource held_source(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                       const PlacedSources& placed, const SignedHeat& options) {
  // Ten times what the jumps round a face may save.
  constexpr double hold = 10;
  const double h = T.mean_edge_length;
  const double by_length = options.soft > 0 ? options.soft / h : hold;
  HeldSource held;
  if (options.soft == 0 && options.constraint == Constraint::none) return held;
  const TriangleSources on = triangle_sources(mesh, T, placed);
  for (const TriangleSources::Segment& s : on.segments) {
    const TriangleShape shape = T.shape(s.triangle);
    HeldPoint middle{s.triangle, {}, 0};
    Complex along = 0;
    for (int k = 0; k < 3; ++k) {
      middle.b[k] = 0.5 * (s.a[k] + s.b[k]);
      along += (s.b[k] - s.a[k]) * shape.p[k];
    }
    middle.weight = by_length * std::abs(along);
    held.points.push_back(middle);
    const auto a = std::find(s.a.begin(), s.a.end(), 1), b = std::find(s.b.begin(), s.b.end(), 1);
    if (options.soft > 0 || a == s.a.end() || b == s.b.end()) continue;
    held.corners.push_back({s.triangle, static_cast<int>(a - s.a.begin())});
    held.corners.push_back({s.triangle, static_cast<int>(b - s.b.begin())});
  }
  for (const PointInFace& p : on.isolated.inside)
    held.points.push_back({p.face, p.b, by_length * h});
  std::vector<char> at_vertex(T.n_vertices, 0);
  for (const int v : on.isolated.vertices) at_vertex[v] = 1;
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) {
      if (!at_vertex[T.faces(f, k)]) continue;
      HeldPoint corner{f, {}, by_length * h};
      corner.b[k] = 1;
      held.points.push_back(corner);
      if (options.soft == 0) held.corners.push_back({f, k});
    }
  return held;
}

/// One value a vertex, the mean of its corners'.
VecX vertex_means(const IntrinsicTriangulation& T, const MatX3& phi) {
  VecX mean = VecX::Zero(T.n_vertices), count = mean;
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) {
      mean[T.faces(f, k)] += phi(f, k);
      count[T.faces(f, k)] += 1;
    }
  return mean.cwiseQuotient(count.cwiseMax(1));
}

}  // namespace

SurfaceAnswer discontinuous_distance(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                     const Operators& ops, const PlacedSources& placed,
                                     const SourceSystem& terms, const SignedHeatSolver& method,
                                     const SignedHeat& options, Task& task, Report& report) {
  VecX Y = [&] {
    const Stopwatch watch(report, "diffuse");
    return method.directions(terms, options, task.stage(0.3, "diffuse"), report);
  }();
  const Stopwatch watch(report, "integrate");
  const JumpCalculus J = jump_calculus(T);
  const HeldSource held = held_source(mesh, T, placed, options);
  const double h = T.mean_edge_length, jump_threshold = options.jump_threshold * h;
  const Task integrating = task.stage(0.7, "integrate");
  DiscontinuousField field;
  VecX mean;
  std::vector<char> reached = method.reached_pieces(terms, options);
  do {
    Report r;
    field = integrate_discontinuous(J, T.faces.matrix(), Y, held, jump_threshold,
                                    options.smoothing * h * h, integrating, r);
    mean = vertex_means(T, field.phi);
    if (!method.add_across_pinches(mean, reached, Y, integrating, report)) {
      report.merge(r);
      break;
    }
  } while (true);
  report.residuals.emplace_back(misaligned_area_fraction, misaligned_fraction(J, field.phi, Y));
  warn_misaligned(report);

  // Without zero along the sources, zero in the mean along them.
  VecX shifted = mean;
  if (held.points.empty()) shift_to_mean_zero(ops.scalar, terms, shifted);
  SurfaceAnswer result{finalize_field(ops, terms, shifted, report), {}};

  Rows<std::int64_t, 3> key = Rows<std::int64_t, 3>::Constant(mesh.n_faces(), 3, -1);
  for (int f = 0; f < mesh.n_faces(); ++f)
    if (const int t = T.triangle_of_face[f]; t >= 0)
      key.row(f) = field.piece.row(t).cast<std::int64_t>();
  SplitSurface split = split_at_jumps(mesh, key);
  VecX distance(index(split.corner.size()));
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
        "no part of the curves bounds a region; option discontinuous takes such curves",
        "options-conflict");
  for (const auto& [name, value] : winding.sizes)
    if (name.ends_with("bounding_length")) report.sizes.emplace_back(name, value);
  return kept;
}

}  // namespace littoral
