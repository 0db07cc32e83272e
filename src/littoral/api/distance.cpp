#include "littoral/api/distance.h"

#include <algorithm>

namespace littoral {

namespace {

const SurfaceMethod& surface_method_named(const std::string& name) {
  const MethodInfo& info = find_method(name);
  const auto& all = surface_methods();
  return *std::find_if(all.begin(), all.end(),
                       [&](const SurfaceMethod& method) { return method.info.name == info.name; });
}

}  // namespace

PreparedSources prepared_sources(const SurfaceProblem& problem, Task& task, Report& report) {
  const SurfaceMesh& mesh = problem.mesh;
  PreparedSources prepared = [&] {
    const Stopwatch watch(report, "sources");
    return prepare(mesh, problem.sources, problem.flip, report,
                   task.stage(0.02, "placing the sources"));
  }();
  report.sizes.emplace_back("vertices", mesh.n_vertices());
  report.sizes.emplace_back("faces", mesh.n_faces());
  report.sizes.emplace_back("edges", mesh.n_edges());
  report.sizes.emplace_back("components", mesh.n_components());
  report.sizes.emplace_back("source_curves", prepared.n_curves);
  report.sizes.emplace_back("source_pieces", static_cast<double>(prepared.pieces.size()));
  report.sizes.emplace_back("source_points", static_cast<double>(prepared.points.size()));
  return prepared;
}

void check_request(const DistanceRequest& request) {
  surface_method_named(request.method).check(request.options);
}

SurfaceResult solve_distance(const SurfaceMesh& mesh, const SurfaceSources& sources,
                             const DistanceRequest& request, Task task, Report& report) {
  check_request(request);
  report.method = request.method;
  report.domain = "triangle mesh";
  return surface_method_named(request.method)
      .run({mesh, sources, request.flip}, request.options, task, report);
}

VecX surface_distance(const SurfaceMesh& mesh, const SurfaceSources& sources,
                      const DistanceRequest& request, Task task, Report& report) {
  return solve_distance(mesh, sources, request, std::move(task), report).values;
}

}  // namespace littoral
