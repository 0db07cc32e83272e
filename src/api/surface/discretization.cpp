#include "api/surface/discretization.h"

#include "base/stopwatch.h"
#include "domain/cloud/cloud_surface.h"
#include "domain/intrinsic/lengthened_sides.h"
#include "domain/mesh/face_orientation.h"
#include "domain/mesh/polygon_surface.h"
#include "operators/nodal.h"
#include "operators/triangles.h"
#include "sources/surface/refined_sources.h"
#include "sources/surface/source_values.h"
#include "sources/systems/nodal_source_system.h"
#include "sources/systems/triangle_source_system.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

NodalSurface nodal_surface(const SurfaceDomain& domain, const Task& task, Report& report) {
  const SurfaceMesh& mesh = *domain.mesh;
  if (domain.face_normals) return voxel_surface(mesh, *domain.face_normals, report);
  return mesh.n_faces() ? polygon_surface(mesh, report)
                        : cloud_surface(mesh.points(), mesh.soup().normals, report, task);
}

}  // namespace

const std::vector<std::string>& all_surfaces() {
  static const std::vector<std::string> names = {"triangle mesh", "polygon mesh", "point cloud",
                                                 "voxel surface"};
  return names;
}

PlacedSources place_sources(const SurfaceDomain& domain, const SurfaceMesh& on,
                            const Sources& sources, const Task& task, Report& report) {
  const SurfaceMesh& mesh = *domain.mesh;
  PlacedSources placed = [&] {
    const Stopwatch watch(report, "sources");
    const bool faces = domain.kind() == "triangle mesh" || domain.kind() == "polygon mesh";
    return place_sources(on, sources, report, task, faces ? SidesBy::faces : SidesBy::normals);
  }();
  report.sizes.emplace_back("vertices", mesh.n_vertices());
  report.sizes.emplace_back("faces", mesh.n_faces());
  report.sizes.emplace_back("edges", mesh.n_edges());
  report.sizes.emplace_back("components", on.n_components());
  report.sizes.emplace_back("source_curves", placed.n_curves);
  report.sizes.emplace_back("source_pieces", static_cast<double>(placed.pieces.size()));
  report.sizes.emplace_back("source_points", static_cast<double>(placed.points.size()));
  return placed;
}

PlacedSources place_sources(const SurfaceDomain& domain, const Sources& sources, const Task& task,
                            Report& report) {
  return place_sources(domain, *domain.mesh, sources, task, report);
}

std::shared_ptr<const IntrinsicTriangulation> triangulation_of(const SurfaceDomain& domain,
                                                               Report& report) {
  const Stopwatch watch(report, "triangulation");
  return std::make_shared<const IntrinsicTriangulation>(
      intrinsic_triangulation(*domain.mesh, report));
}

SurfaceDiscretization::SurfaceDiscretization(SurfaceDomain domain, Task task, Report& report,
                                             std::shared_ptr<const IntrinsicTriangulation> T,
                                             Needles needles)
    : domain_(std::move(domain)), T_(std::move(T)) {
  task.checkpoint();
  if (domain_.kind() == "polygon mesh") {
    Report quiet;
    CutPolygons cut = cut_into_triangles(domain_, quiet);
    if (!face_orientation(*cut.triangles.mesh).orientable) {
      report.warn("polygons-cut",
                  "the polygons were cut into triangles, as the surface is not orientable");
      cut_ = std::make_shared<const CutPolygons>(std::move(cut));
      domain_ = cut_->triangles;
    }
  }
  if (domain_.kind() == "triangle mesh") {
    if (!T_) T_ = triangulation_of(domain_, report);
    if (needles == Needles::thicker) T_ = without_needles(T_, report);
  } else {
    const Stopwatch watch(report, "triangulation");
    NodalSurface nodal = nodal_surface(domain_, task.stage(0.5, "triangulation"), report);
    if (needles == Needles::thicker) nodal.cells = without_needles(nodal.cells, report);
    nodal_ = std::make_shared<const NodalSurface>(std::move(nodal));
  }
  const Task stage = task.stage(0.5, "operators");
  stage.checkpoint();
  const Stopwatch watch(report, "operators");
  ops_ = std::make_shared<const Operators>(T_ ? triangle_operators(T_, stage)
                                              : nodal_operators(*nodal_));
}

PlacedSources SurfaceDiscretization::placed(const Sources& sources, const Task& task,
                                            Report& report) const {
  const SurfaceMesh& mesh = *domain_.mesh;
  if (T_) return place_sources(domain_, cut_ ? cut_->cut(sources) : sources, task, report);
  const SurfaceMesh& refined = *nodal_->refined;
  return place_sources(domain_, refined,
                       refined_sources(mesh, refined, nodal_->face_offsets, sources), task, report);
}

SourceSystem SurfaceDiscretization::system(const Sources& sources, const Task& task,
                                           Report& report) const {
  const PlacedSources on = placed(sources, task, report);
  warn_of_shadowed(T_ ? *domain_.mesh : *nodal_->refined, T_ ? *T_ : *nodal_->place, on, report);
  return T_ ? source_system(*domain_.mesh, *T_, on) : nodal_source_system(*nodal_, on);
}

KnownDistances SurfaceDiscretization::known(const Sources& sources, const Task& task,
                                            Report& report) const {
  const PlacedSources on = placed(sources, task, report);
  if (T_)
    return known_distances(*T_, triangle_sources(*domain_.mesh, *T_, on), TriangleNodes::corners);
  return known_distances(*nodal_, triangle_sources(*nodal_->refined, *nodal_->place, on));
}

SurfaceAnswer SurfaceDiscretization::at_input(const VecX& values) const {
  SurfaceAnswer out{values.head(domain_.mesh->n_vertices()), {}};
  if (nodal_ && domain_.mesh->n_faces() == 0) {
    out.shown = nodal_->refined->soup();
    out.shown->scalars["distance"] = out.values;
  }
  return out;
}

JumpSurface::JumpSurface(const SurfaceMesh& mesh, Report& report)
    : T(intrinsic_triangulation(mesh, report)) {
  const Stopwatch watch(report, "operators");
  J = std::make_shared<const JumpCalculus>(jump_calculus(T));
}

CutPolygons cut_into_triangles(const SurfaceDomain& domain, Report& report) {
  const SurfaceMesh& input = *domain.mesh;
  CutPolygons cut{
      domain, {std::make_shared<const SurfaceMesh>(triangulate(input.soup())), {}}, {0}};
  for (int f = 0; f < input.n_faces(); ++f)  // n corners give n - 2 triangles
    cut.face_offsets.push_back(cut.face_offsets.back() + static_cast<int>(input.face(f).size()) -
                               2);
  report.warn("polygons-cut", "the polygons were cut into triangles, as the options ask for these");
  return cut;
}

Sources CutPolygons::cut(const Sources& sources) const {
  return refined_sources(*input.mesh, *triangles.mesh, face_offsets, sources);
}

}  // namespace littoral
