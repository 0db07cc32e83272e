#pragma once
// Surfaces as a domain of methods, and what they answer there.

#include <memory>
#include <optional>
#include <string>

#include "api/method.h"
#include "domain/mesh/surface_mesh.h"
#include "littoral/polygon_soup.h"
#include "littoral/sources.h"

namespace littoral {

/// Distance at the vertices of a surface.
struct SurfaceAnswer {
  VecX values;                       // vertices of the input [length], +inf where no source reaches
  std::optional<PolygonSoup> shown;  // a finer or cut surface with a scalar "distance", where that
                                     // says more than values at the input's vertices
  VecX confidence{};                 // vertices of the input, 0 to 1: how sure the sign is; empty
                                     // unless asked for
};

/// A triangle mesh, polygon mesh, point cloud (a mesh without faces, normals in its soup where
/// there are any) or the boundary of voxels.
struct SurfaceDomain {
  using Sources = littoral::Sources;
  using Answer = SurfaceAnswer;
  static constexpr const char* title = "Distance on surfaces";

  std::shared_ptr<const SurfaceMesh> mesh;
  std::shared_ptr<const MatX3> face_normals;  // faces x 3; of voxels: corrected, otherwise null

  /// "triangle mesh", "polygon mesh", "point cloud" or "voxel surface".
  std::string kind() const;
};

/// A mesh that outlives the domain. Throws InputError if normals are given, not one for each face.
SurfaceDomain domain_of(const SurfaceMesh& mesh, const MatX3* face_normals = nullptr);

/// Methods measure from the least value. One that is common to all sources is added afterwards, for
/// any method; where values differ and the method cannot, UnsupportedError.
template <>
std::shared_ptr<const Solver<SurfaceDomain>> with_additions<SurfaceDomain>(
    const MethodInfo& info, const SurfaceDomain& domain,
    std::shared_ptr<const Solver<SurfaceDomain>> solver);

template <>
std::vector<Method<SurfaceDomain>> library_methods();
// Its families:
std::vector<Method<SurfaceDomain>> automatic_methods();  // completes, then measures
std::vector<Method<SurfaceDomain>> heat_methods();       // signed and unsigned
std::vector<Method<SurfaceDomain>> geodesic_methods();   // exact polyhedral, fast marching
std::vector<Method<SurfaceDomain>> quadratic_methods();  // quadratic-order geodesics
std::vector<Method<SurfaceDomain>> regularized_methods();

}  // namespace littoral
