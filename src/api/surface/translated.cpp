#include "api/surface/translated.h"

#include "domain/cloud/cloud_surface.h"
#include "domain/mesh/polygon_surface.h"
#include "operators/nodal.h"
#include "sources/nodal_source_terms.h"
#include "sources/refined_sources.h"

namespace littoral {

namespace {

NodalSurface nodal_surface(const SurfaceProblem& problem, const Task& task, Report& report) {
  const SurfaceMesh& mesh = problem.mesh;
  if (problem.face_normals) return voxel_surface(mesh, *problem.face_normals, report);
  return mesh.n_faces() ? polygon_surface(mesh, report)
                        : cloud_surface(mesh.points(), mesh.soup().normals, report, task);
}

}  // namespace

const std::vector<std::string>& all_surfaces() {
  static const std::vector<std::string> names = {"triangle mesh", "polygon mesh", "point cloud",
                                                 "voxel surface"};
  return names;
}

Translated translate_nodes(const SurfaceProblem& problem, Task& task, Report& report) {
  const NodalSurface S = [&] {
    const Stopwatch watch(report, "triangulation");
    return nodal_surface(problem, task, report);
  }();
  task.stage(0.03, "operators").checkpoint();
  const PreparedSources prepared = prepared_sources(
      problem, *S.refined,
      refined_sources(problem.mesh, *S.refined, S.face_offsets, problem.sources), task, report);
  const Stopwatch watch(report, "operators");
  return {std::make_shared<const Operators>(nodal_operators(S)), nodal_source_terms(S, prepared),
          nullptr, problem.mesh.n_faces() ? nullptr : S.refined};
}

SurfaceResult at_input(const SurfaceProblem& problem, const SurfaceMesh* faces,
                       const VecX& values) {
  SurfaceResult out{values.head(problem.mesh.n_vertices()), {}};
  if (faces) {
    out.shown = faces->soup();
    out.shown->scalars["distance"] = out.values;
  }
  return out;
}

}  // namespace littoral
