#include "api/tet/tet_domain.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "api/space/space_input.h"
#include "base/counted.h"
#include "base/index.h"
#include "base/platform/memory.h"
#include "base/run_interruptible.h"
#include "sources/space/tet_source_values.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

/// The box of all corners that are finite. Throws InputError where there is no volume.
Box box_of(const TetMesh& mesh) {
  Box box;
  for (int t = 0; t < mesh.n_tets(); ++t)
    for (int k = 0; k < 4; ++k) {
      const int v = mesh.tets(t, k);
      if (v >= 0 && v < mesh.n_vertices() && mesh.points.row(v).allFinite())
        box.add(mesh.points.row(v));
    }
  if (!(box.size().minCoeff() >= 0) || !box.size().allFinite())
    throw InputError("the tet mesh has no volume", "empty-input");
  return box;
}

bool one_value(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [&](double c) { return c == values.front(); });
}

/// One for all or one for each source.
const std::vector<double>& checked_values(const TetSources& sources) {
  const PolygonSoup& surface = sources.surface;
  const int of_surface = surface.n_faces() > 0 ? surface.n_faces() : surface.n_vertices();
  const std::size_t n = sources.vertices.empty() && !sources.boundary
                            ? std::size_t(of_surface)
                            : sources.vertices.size() + (sources.boundary ? 1 : 0);
  const std::vector<double>& values = sources.values;
  if (values.size() > 1 && values.size() != n)
    throw InputError("there are " + std::to_string(values.size()) + " values for " +
                         std::to_string(n) + " sources",
                     "sizes-differ");
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw InputError(
          "value " + std::to_string(i) + " of the sources, counted from 0, is not finite",
          "not-finite");
  return values;
}

}  // namespace

std::vector<int> TetProblem::tets_with_sources() const {
  std::vector<int> tets;
  for (const TetPoint& p : places)
    if (p.tet >= 0 && ops->volumes[p.tet] > 0) tets.push_back(p.tet);
  if (!vertices.empty()) {
    std::vector<char> wanted(std::size_t(mesh->n_vertices()), 0);
    for (int v : vertices) wanted[v] = 1;
    for (int t = 0; t < mesh->n_tets(); ++t)
      for (int k = 0; k < 4; ++k)
        if (ops->volumes[t] > 0 && wanted[mesh->tets(t, k)] != 0) tets.push_back(t);
  }
  std::sort(tets.begin(), tets.end());
  tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
  return tets;
}

std::vector<char> TetProblem::reached() const {
  std::vector<char> out(std::size_t(ops->n_components), 0);
  for (const int t : tets_with_sources()) out[ops->component[mesh->tets(t, 0)]] = 1;
  if (std::count(out.begin(), out.end(), 1) == 0)
    throw InputError("no source vertex belongs to a tet", "nothing-there");
  return out;
}

TetSourceSystem TetProblem::terms() const {
  if (!vertices.empty()) return vertex_source_system(*ops, vertices, values);
  std::vector<int> nearest;
  for (const TetPoint& p : places) {
    const auto corner = std::max_element(p.barycentric.begin(), p.barycentric.end());
    nearest.push_back(
        p.tet < 0 ? -1 : mesh->tets(p.tet, static_cast<int>(corner - p.barycentric.begin())));
  }
  return tet_source_system(*mesh, *ops, samples, places, nearest, part, sample_values);
}

TetProblem TetProblem::of_value(double counted) const {
  TetProblem out = *this;
  out.values.clear();
  out.sample_values.clear();
  std::vector<int> faces;
  std::vector<Eigen::Index> own;
  for (std::size_t f = 0; f < values.size(); ++f)
    if (values[f] == counted) faces.push_back(static_cast<int>(f));
  out.surface = soup_of(surface.points, triangles_of(surface)(faces, Eigen::all));
  out.places.clear();
  for (std::size_t i = 0; i < sample_values.size(); ++i) {
    if (sample_values[i] != counted) continue;
    own.push_back(index(i));
    out.places.push_back(places[i]);
  }
  out.samples = {samples.points(own, Eigen::all), samples.normals(own, Eigen::all),
                 samples.areas(own)};
  return out;
}

std::map<int, TetNodeDistance> TetProblem::known(const std::vector<Eigen::Vector4d>& local,
                                                 const std::function<int(int, int)>& node,
                                                 Around around) const {
  if (!values.empty())
    throw UnsupportedError(
        "sources of different values in tets need one of the methods auto and signed-heat");
  if (!vertices.empty()) {
    std::vector<char> wanted(std::size_t(mesh->n_vertices()), 0);
    for (const int v : vertices) wanted[v] = 1;
    std::map<int, TetNodeDistance> out;
    for (int t = 0; t < mesh->n_tets(); ++t)
      for (int k = 0; k < 4 && ops->volumes[t] > 0; ++k)
        if (wanted[mesh->tets(t, k)] != 0)
          out.emplace(node(t, k), TetNodeDistance{t, Eigen::Vector4d::Unit(k), 0});
    return out;
  }
  std::vector<TetPoint> solid = places;
  for (TetPoint& p : solid)
    if (p.tet >= 0 && !(ops->volumes[p.tet] > 0)) p.tet = -1;
  return distances_around(*mesh, *locator, surface, samples, solid, local, node, around);
}

void check_tet_memory(const TetMesh& mesh, const std::string& what, const std::string& remedy) {
  // The factor of the faces' matrix: about 60 numbers a face were seen.
  check_memory(2.1 * mesh.n_tets() * 60 * 16.0, what + std::to_string(mesh.n_tets()) + " tets",
               remedy);
}

TetDiscretization::TetDiscretization(const TetMesh& mesh, Task task, Report& report)
    : frame_((check_tet_memory(mesh, "a mesh of ", "use a coarser mesh"), box_of(mesh))) {
  report.sizes.emplace_back("tets", mesh.n_tets());
  report.sizes.emplace_back("vertices", mesh.n_vertices());
  mesh_ = std::make_shared<const TetMesh>(TetMesh{frame_.local(mesh.points), mesh.tets});
  ops_ = run_interruptible(task.stage(1, "building operators"),
                           [local = mesh_] { return tet_operators(*local); });
}

TetProblem TetDiscretization::problem(const TetSources& sources, Task task, Report& report) const {
  const bool from_vertices = !sources.vertices.empty() || sources.boundary;
  if (from_vertices && (sources.surface.n_faces() > 0 || sources.surface.n_vertices() > 0))
    throw UnsupportedError(
        "distance through tets is signed, from surfaces, or unsigned, from vertices: not both");
  if (!from_vertices && sources.surface.n_faces() == 0 && sources.surface.n_vertices() == 0)
    throw InputError("there is nothing to measure from: no surface, cloud, vertex or boundary",
                     "nothing-given");
  for (const int v : sources.vertices)
    if (v < 0 || v >= mesh_->n_vertices())
      throw InputError("there is no vertex " + std::to_string(v) +
                           " to measure from; the mesh has " +
                           counted(mesh_->n_vertices(), "vertex", "vertices") + ", counted from 0",
                       "no-such-element");
  TetProblem problem;
  problem.mesh = mesh_;
  problem.ops = ops_;
  std::vector<double> values = checked_values(sources);
  if (one_value(values)) {  // added in the end
    problem.value = values.empty() ? 0 : values.front();
    values.clear();
  }
  for (double& c : values) c /= frame_.unit;
  std::vector<int>& vertices = problem.vertices;
  vertices = sources.vertices;
  if (from_vertices && !values.empty()) {
    problem.values = values;
    problem.values.resize(vertices.size());
  }
  if (sources.boundary) {
    const MatX3i faces = boundary_faces(*mesh_);
    vertices.insert(vertices.end(), faces.data(), faces.data() + faces.size());
    if (!values.empty()) problem.values.resize(vertices.size(), values.back());
  }
  if (sources.boundary || !values.empty()) merge_vertices(vertices, problem.values);
  if (vertices.empty()) place(problem, sources, values, task, report);
  for (const int v : vertices)
    if (ops_->component[v] < 0)
      report.warn("sources-outside",
                  "source vertex " + std::to_string(v) + " belongs to no tet and is left out");
  if (!problem.values.empty()) warn_of_shadowed(problem, report);
  return problem;
}

void TetDiscretization::warn_of_shadowed(const TetProblem& problem, Report& report) const {
  std::vector<ValuedPlace> sources;
  for (std::size_t i = 0; i < problem.sample_values.size(); ++i)
    sources.push_back({problem.places[i], problem.sample_values[i]});
  std::map<int, double> value_at;
  for (std::size_t i = 0; i < problem.vertices.size(); ++i)
    value_at.emplace(problem.vertices[i], problem.values[i]);
  for (int t = 0; t < mesh_->n_tets(); ++t)
    for (int k = 0; k < 4 && ops_->volumes[t] > 0; ++k) {
      const auto at = value_at.find(mesh_->tets(t, k));
      if (at == value_at.end()) continue;
      TetPoint corner{t, {0, 0, 0, 0}};
      corner.barycentric[k] = 1;
      sources.push_back({corner, at->second});
      value_at.erase(at);
    }
  littoral::warn_of_shadowed(*mesh_, *ops_, sources, frame_.unit, report);
}

/// The surface, sampled, and where the samples lie in the mesh.
void TetDiscretization::place(TetProblem& placed, const TetSources& sources,
                              const std::vector<double>& values, Task& task, Report& report) const {
  std::vector<int> all(std::size_t(mesh_->n_tets()));
  std::iota(all.begin(), all.end(), 0);
  const double max_side = mean_edge(*mesh_, all);
  bounding_box(sources.surface);  // complains about what cannot be placed
  const SpaceInput input = make_input({sources.surface, sources.flip, sources.estimate_normals},
                                      frame_, max_side, task, report);
  placed.surface = input.surface;
  placed.h = sample_spacing(input.samples);
  Report again;
  placed.samples = input.is_cloud()
                       ? input.samples
                       : sample_faces(input.surface, max_side, again, SamplesPerTriangle::three);
  if (!values.empty()) {
    placed.values = input.is_cloud() ? values : values_of_triangles(sources.surface, values);
    placed.sample_values = values_of_samples(placed.surface, placed.samples, placed.values);
  }
  placed.locator = locator_.get(
      [&] { return run_interruptible(task, [mesh = mesh_] { return TetLocator(*mesh); }); });
  int outside = 0;
  for (Eigen::Index i = 0; i < placed.samples.size(); ++i) {
    if (i % 1024 == 0) task.checkpoint();
    placed.places.push_back(placed.locator->locate(placed.samples.points.row(i)));
    outside += placed.places.back().tet < 0 ? 1 : 0;
  }
  if (outside == placed.samples.size())
    throw InputError("no source lies within the tets", "nothing-there");
  if (outside > 0)
    report.warn("sources-outside", std::to_string(outside) + " of " +
                                       counted(placed.samples.size(), "sample", "samples") +
                                       " of the sources lie outside the tets and are left out");
}

}  // namespace littoral
