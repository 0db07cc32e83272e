#include "api/surface/distance.h"

#include <algorithm>

#include "base/error.h"

namespace littoral {

namespace {

const SurfaceMethod& surface_method_named(const std::string& name) {
  const MethodInfo& info = find_method(name);
  const auto& all = surface_methods();
  return *std::find_if(all.begin(), all.end(),
                       [&](const SurfaceMethod& method) { return method.info.name == info.name; });
}

/// Throws UnsupportedError, saying what would work, unless the method runs on the domain.
void check_domain(const MethodInfo& method, const std::string& domain) {
  auto runs = [&](const MethodInfo& m) {
    return std::find(m.domains.begin(), m.domains.end(), domain) != m.domains.end();
  };
  if (runs(method)) return;
  std::string on, others;
  for (const std::string& d : method.domains) on += (on.empty() ? "a " : ", a ") + d;
  for (const MethodInfo& m : methods())
    if (runs(m)) others += (others.empty() ? "" : ", ") + m.name;
  throw UnsupportedError("method " + method.name + " runs on " + on + ", not on a " + domain +
                         (others.empty() ? "" : ", on which there are: " + others));
}

}  // namespace

std::string SurfaceProblem::domain() const {
  if (face_normals) return "voxel surface";
  if (mesh.n_faces() == 0) return "point cloud";
  return mesh.is_triangle_mesh() ? "triangle mesh" : "polygon mesh";
}

PreparedSources prepared_sources(const SurfaceProblem& problem, Task& task, Report& report) {
  return prepared_sources(problem, problem.mesh, problem.sources, task, report);
}

PreparedSources prepared_sources(const SurfaceProblem& problem, const SurfaceMesh& on,
                                 const SurfaceSources& sources, Task& task, Report& report) {
  const SurfaceMesh& mesh = problem.mesh;
  PreparedSources prepared = [&] {
    const Stopwatch watch(report, "sources");
    return prepare(on, sources, problem.flip, report, task.stage(0.02, "placing the sources"));
  }();
  report.sizes.emplace_back("vertices", mesh.n_vertices());
  report.sizes.emplace_back("faces", mesh.n_faces());
  report.sizes.emplace_back("edges", mesh.n_edges());
  report.sizes.emplace_back("components", on.n_components());
  report.sizes.emplace_back("source_curves", prepared.n_curves);
  report.sizes.emplace_back("source_pieces", static_cast<double>(prepared.pieces.size()));
  report.sizes.emplace_back("source_points", static_cast<double>(prepared.points.size()));
  return prepared;
}

void check_request(const DistanceRequest& request) {
  surface_method_named(request.method).check(request.options);
}

SurfaceResult solve_distance(const SurfaceMesh& mesh, const SurfaceSources& sources,
                             const DistanceRequest& request, Task task, Report& report,
                             const MatX3* face_normals) {
  check_request(request);
  if (face_normals && face_normals->rows() != mesh.n_faces())
    throw InputError("there are " + std::to_string(face_normals->rows()) + " normals for " +
                     std::to_string(mesh.n_faces()) + " faces");
  report.method = request.method;
  const SurfaceProblem problem{mesh, sources, request.flip, face_normals};
  report.domain = problem.domain();
  const SurfaceMethod& method = surface_method_named(request.method);
  check_domain(method.info, report.domain);
  return method.run(problem, request.options, task, report);
}

VecX surface_distance(const SurfaceMesh& mesh, const SurfaceSources& sources,
                      const DistanceRequest& request, Task task, Report& report,
                      const MatX3* face_normals) {
  return solve_distance(mesh, sources, request, std::move(task), report, face_normals).values;
}

}  // namespace littoral
