#include "littoral/distance.h"

#include <utility>

#include "api/front/prepared.h"
#include "api/front/running.h"
#include "api/surface/pairs.h"
#include "api/surface/surface_domain.h"
#include "api/surface/winding.h"
#include "base/index.h"
#include "littoral/error.h"
#include "littoral/winding.h"

namespace littoral {

namespace {

Field field_of(const Mesh& mesh, const Sources& sources, SurfaceAnswer answer, Report report) {
  return {mesh,
          sources,
          std::move(answer.values),
          std::move(answer.shown),
          std::move(report),
          std::move(answer.confidence)};
}

/// A report of a preparation as the beginning of a solve's: what was found out, not the seconds.
Report found_out(Report report) {
  report.timings.clear();
  return report;
}

}  // namespace

Field distance(const Mesh& mesh, const Sources& sources, const AnyMethod& method,
               const Context& context) {
  return run(context, [&](const Task& task) {
    Report report;
    SurfaceAnswer answer = solve_once<SurfaceDomain>(method, mesh.domain(), sources, task, report);
    return field_of(mesh, sources, std::move(answer), std::move(report));
  });
}

DistanceSolver::DistanceSolver(Mesh mesh, const AnyMethod& method, const Context& context) {
  prepared_ = run(context, [&](const Task& task) {
    auto prepared = std::make_shared<Prepared>(Prepared{std::move(mesh), {}, {}});
    prepared->solver =
        prepare(method, prepared->mesh.domain(), SolveHint::many_rhs, task, prepared->report);
    return prepared;
  });
}

Field DistanceSolver::solve(const Sources& sources, const Context& context) const {
  return run(context, [&](const Task& task) {
    Report report = found_out(prepared_->report);
    SurfaceAnswer answer = prepared_->solver->solve(sources, task, report);
    return field_of(prepared_->mesh, sources, std::move(answer), std::move(report));
  });
}

const Mesh& DistanceSolver::mesh() const { return prepared_->mesh; }
const Report& DistanceSolver::report() const { return prepared_->report; }

namespace {

int vertex_of(const SurfacePoint& point, const std::string& method) {
  if (point.on != SurfacePoint::On::vertex)
    throw UnsupportedError("method " + method + " has distances between vertices only");
  return point.element;
}

/// Rows of distances, and what is kept of each.
DistanceMatrix rows_of(const Mesh& mesh, const std::vector<SurfacePoint>& from,
                       const AnyMethod& method, const Context& context, const KeptOfRow& kept) {
  for (const SurfacePoint& p : from) mesh.position(p);  // complains before anything is solved
  return run(context, [&](Task task) -> DistanceMatrix {
    Report report;
    if (!Registry<PairsDomain>::instance().has(method.name())) {
      const auto solver =
          prepare(method, mesh.domain(), SolveHint::many_rhs, task.stage(0.1, "preparing"), report);
      MatX values =
          distance_rows(*solver, mesh.domain(), from, task.stage(0.9, "distance"), report, kept);
      return {std::move(values), std::move(report)};
    }
    std::vector<int> vertices;
    for (const SurfacePoint& p : from) vertices.push_back(vertex_of(p, method.name()));
    MatX all(0, mesh.n_vertices());
    if (!from.empty())
      all = pair_distances(mesh.domain(), vertices, method, task, report).distances;
    if (!kept.of) return {std::move(all), std::move(report)};
    MatX values(all.rows(), kept.size);
    for (Eigen::Index i = 0; i < all.rows(); ++i) values.row(i) = kept.of(all.row(i));
    return {std::move(values), std::move(report)};
  });
}

}  // namespace

DistanceMatrix distance_matrix(const Mesh& mesh, const std::vector<SurfacePoint>& from,
                               const AnyMethod& method, const Context& context) {
  return rows_of(mesh, from, method, context, {});
}

DistanceMatrix distance_matrix(const Mesh& mesh, const std::vector<SurfacePoint>& from,
                               const std::vector<SurfacePoint>& to, const AnyMethod& method,
                               const Context& context) {
  for (const SurfacePoint& p : to) mesh.position(p);  // complains before anything is solved
  const auto size = index(to.size());
  return rows_of(mesh, from, method, context, {size, [&](const VecX& row) {
                                                 VecX out(size);
                                                 for (Eigen::Index j = 0; j < size; ++j)
                                                   out[j] = mesh.interpolate(row, to[j]);
                                                 return out;
                                               }});
}

Regions winding(const Mesh& mesh, const Sources& curves, const AnyMethod& method,
                const Context& context) {
  return run(context, [&](const Task& task) -> Regions {
    Report report;
    WindingAnswer answer =
        solve_once<WindingDomain>(method, {mesh.domain().mesh}, curves, task, report);
    Sources bounding = bounding_sources(answer);
    return {mesh,
            std::move(answer.region),
            std::move(answer.shown),
            std::move(answer.bounding),
            std::move(answer.nonbounding),
            std::move(answer.completed),
            std::move(bounding),
            std::move(report)};
  });
}

}  // namespace littoral
