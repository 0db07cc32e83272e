#pragma once
// A surface as operators, made once, and sources on it as right-hand sides, for methods that see
// nothing else.

#include <memory>
#include <string>
#include <vector>

#include "api/surface/surface_domain.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "domain/mesh/nodal_surface.h"
#include "operators/calculus.h"
#include "operators/jump_calculus.h"
#include "sources/surface/known_distances.h"
#include "sources/surface/pieces.h"
#include "sources/systems/source_system.h"

namespace littoral {

/// The kinds of surfaces that `SurfaceDiscretization` knows.
const std::vector<std::string>& all_surfaces();

/// Places the sources on the mesh `on`: the domain's or a finer one with sources of its own. The
/// report gets sizes and seconds.
PlacedSources place_sources(const SurfaceDomain& domain, const SurfaceMesh& on,
                            const Sources& sources, const Task& task, Report& report);
PlacedSources place_sources(const SurfaceDomain& domain, const Sources& sources, const Task& task,
                            Report& report);

/// The triangulation of a triangle mesh by lengths, with its seconds in the report.
std::shared_ptr<const IntrinsicTriangulation> triangulation_of(const SurfaceDomain& domain,
                                                               Report& report);

/// A polygon mesh cut into triangles on its own vertices; sources follow.
struct CutPolygons {
  SurfaceDomain input, triangles;
  std::vector<int> face_offsets;  // faces of the input + 1, into triangles

  Sources cut(const Sources& sources) const;
};
CutPolygons cut_into_triangles(const SurfaceDomain& domain, Report& report);

/// Thin triangles as they are, or made less thin (`without_needles`).
enum class Needles { given, thicker };

/// Operators of any surface; immutable. Vectors live on edges of triangle meshes and at nodes
/// elsewhere. Nodes need normals: polygon meshes that are not orientable are cut into triangles.
class SurfaceDiscretization {
 public:
  /// T: the triangulation of a triangle mesh, if it is there already.
  SurfaceDiscretization(SurfaceDomain domain, Task task, Report& report,
                        std::shared_ptr<const IntrinsicTriangulation> T = nullptr,
                        Needles needles = Needles::given);

  const SurfaceDomain& domain() const { return domain_; }
  const std::shared_ptr<const Operators>& operators() const { return ops_; }
  /// Of triangle meshes; null elsewhere.
  const std::shared_ptr<const IntrinsicTriangulation>& triangulation() const { return T_; }

  SourceSystem system(const Sources& sources, const Task& task, Report& report) const;
  /// Distances known at nodes around the sources [units].
  KnownDistances known(const Sources& sources, const Task& task, Report& report) const;

  /// Values at the vertices of the input, which come first among the nodes; a cloud is shown with
  /// triangles.
  SurfaceAnswer at_input(const VecX& values) const;

 private:
  /// On a nodal surface's refined mesh.
  PlacedSources placed(const Sources& sources, const Task& task, Report& report) const;

  SurfaceDomain domain_;
  std::shared_ptr<const CutPolygons> cut_;  // of polygons that are not orientable
  std::shared_ptr<const IntrinsicTriangulation> T_;
  std::shared_ptr<const NodalSurface> nodal_;  // of all but triangle meshes
  std::shared_ptr<const Operators> ops_;
};

/// A triangle mesh as operators of functions that jump across edges.
struct JumpSurface {
  IntrinsicTriangulation T;
  std::shared_ptr<const JumpCalculus> J;

  JumpSurface(const SurfaceMesh& mesh, Report& report);
};

}  // namespace littoral
