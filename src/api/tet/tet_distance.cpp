#include "api/tet/tet_distance.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <string>

#include "api/space/space_problem.h"
#include "api/tet/tet_method.h"
#include "base/error.h"
#include "base/made.h"
#include "base/platform/memory.h"
#include "domain/tet/tet_locator.h"

namespace littoral {

namespace {

/// The surface, sampled, and where the samples lie in the mesh.
void place(TetProblem& placed, const TetSources& sources, const SpaceRequest& request,
           const Frame& frame, Task& task, Report& report) {
  std::vector<int> all(static_cast<std::size_t>(placed.mesh->n_tets()));
  std::iota(all.begin(), all.end(), 0);
  const double max_side = mean_edge(*placed.mesh, all);
  bounding_box(sources.surface);  // complains about what cannot be placed
  const SpaceProblem problem =
      make_problem(sources.surface, request, frame, max_side, task, report);
  placed.surface = sources.surface;
  placed.surface.points = frame.local(placed.surface.points);
  placed.h = sample_spacing(problem.samples);
  Report again;
  placed.samples = problem.is_cloud()
                       ? problem.samples
                       : sample_faces(problem.surface, max_side, again, SamplesPerTriangle::three);
  const auto locator = made(task, [mesh = placed.mesh] { return TetLocator(*mesh); });
  int outside = 0;
  for (Eigen::Index i = 0; i < placed.samples.size(); ++i) {
    if (i % 1024 == 0) task.checkpoint();
    placed.places.push_back(locator->locate(placed.samples.points.row(i)));
    outside += placed.places.back().tet < 0 ? 1 : 0;
  }
  if (outside == placed.samples.size()) throw InputError("no source lies within the tets");
  if (outside > 0)
    report.warn(std::to_string(outside) + " of " + std::to_string(placed.samples.size()) +
                " samples of the sources lie outside the tets and are left out");
}

}  // namespace

std::vector<int> TetProblem::tets_with_sources() const {
  std::vector<int> tets;
  for (const TetPoint& p : places)
    if (p.tet >= 0 && ops->volumes[p.tet] > 0) tets.push_back(p.tet);
  if (!vertices.empty()) {
    std::vector<char> wanted(static_cast<std::size_t>(mesh->n_vertices()), 0);
    for (int v : vertices) wanted[static_cast<std::size_t>(v)] = 1;
    for (int t = 0; t < mesh->n_tets(); ++t)
      for (int k = 0; k < 4; ++k)
        if (ops->volumes[t] > 0 && wanted[static_cast<std::size_t>(mesh->tets(t, k))] != 0)
          tets.push_back(t);
  }
  std::sort(tets.begin(), tets.end());
  tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
  return tets;
}

TetSourceTerms TetProblem::terms() const {
  if (!vertices.empty()) return vertex_source_terms(*ops, vertices);
  std::vector<int> nearest;
  for (const TetPoint& p : places) {
    const auto corner = std::max_element(p.barycentric.begin(), p.barycentric.end());
    nearest.push_back(
        p.tet < 0 ? -1 : mesh->tets(p.tet, static_cast<int>(corner - p.barycentric.begin())));
  }
  return tet_source_terms(*mesh, *ops, samples, places, nearest);
}

const std::vector<TetMethod>& tet_methods() {
  static const auto all =
      all_of<TetMethod>({heat_tet_methods, regularized_tet_methods, quadratic_tet_methods});
  return all;
}

void throw_not_on_tets(const std::string& method) {
  const auto& all = tet_methods();
  std::string others;
  for (std::size_t i = 1; i < all.size(); ++i)
    others += (i == 1 ? "" : i + 1 < all.size() ? ", " : " and ") + all[i].name;
  throw UnsupportedError("method " + method + " does not run on tets; " + all[0].name +
                         " does, and through tets that are given " + others + ", too");
}

void check_tet_memory(const TetMesh& mesh, const std::string& what, const std::string& remedy) {
  // The factor of the faces' matrix: about 60 numbers a face were seen.
  check_memory(2.1 * mesh.n_tets() * 60 * 16.0, what + std::to_string(mesh.n_tets()) + " tets",
               remedy);
}

VecX tet_mesh_distance(const TetMesh& mesh, const TetSources& sources, const SpaceRequest& request,
                       Task task, Report& report) {
  const auto& all = tet_methods();
  const auto method = std::find_if(
      all.begin(), all.end(), [&](const TetMethod& each) { return each.name == request.method; });
  if (method == all.end()) throw_not_on_tets(request.method);
  method->check(request.options);
  const bool from_vertices = !sources.vertices.empty() || sources.boundary;
  if (from_vertices && (sources.surface.n_faces() > 0 || sources.surface.n_vertices() > 0))
    throw UnsupportedError(
        "distance through tets is signed, from surfaces, or unsigned, from vertices: not both");
  for (const int v : sources.vertices)
    if (v < 0 || v >= mesh.n_vertices())
      throw InputError("there is no vertex " + std::to_string(v) +
                       " to measure from, the mesh has " + std::to_string(mesh.n_vertices()));
  report.method = request.method;
  report.domain = "tet mesh";
  report.sizes.emplace_back("tets", mesh.n_tets());
  report.sizes.emplace_back("vertices", mesh.n_vertices());
  check_tet_memory(mesh, "a mesh of ", "use a coarser mesh");

  Task building = task.stage(0.1, "building operators");
  Box box;
  for (int t = 0; t < mesh.n_tets(); ++t)
    for (int k = 0; k < 4; ++k) {
      const int v = mesh.tets(t, k);
      if (v >= 0 && v < mesh.n_vertices() && mesh.points.row(v).allFinite())
        box.add(mesh.points.row(v));
    }
  if (!(box.size().minCoeff() >= 0) || !box.size().allFinite())
    throw InputError("the tet mesh has no volume");
  const Frame frame(box);
  TetProblem problem;
  problem.mesh = std::make_shared<const TetMesh>(TetMesh{frame.local(mesh.points), mesh.tets});
  problem.ops = made(building, [local = problem.mesh] { return tet_operators(*local); });
  std::vector<int>& vertices = problem.vertices;
  vertices = sources.vertices;
  if (sources.boundary) {
    const MatX3i faces = boundary_faces(*problem.mesh);
    vertices.insert(vertices.end(), faces.data(), faces.data() + faces.size());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
  if (vertices.empty()) place(problem, sources, request, frame, building, report);
  for (const int v : vertices)
    if (problem.ops->component[static_cast<std::size_t>(v)] < 0)
      report.warn("source vertex " + std::to_string(v) + " belongs to no tet and is left out");
  return method->run(problem, request.options, task, report) * frame.unit;
}

}  // namespace littoral
