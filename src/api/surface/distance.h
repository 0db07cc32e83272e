#pragma once
// Distance on a surface in one call: from a mesh and sources to one value a vertex.

#include <string>

#include "api/surface/surface_method.h"
#include "base/report.h"
#include "base/task.h"
#include "base/types.h"
#include "domain/mesh/surface_mesh.h"
#include "sources/surface_sources.h"

namespace littoral {

/// What to compute, in words.
struct DistanceRequest {
  std::string method = "signed-heat";
  OptionTexts options;  // name, value as text; others default
  bool flip = false;    // reverse every signed curve
};

/// Throws InputError if there is no such method, it lacks an option, or a value is out of range.
void check_request(const DistanceRequest& request);

/// Distance at the vertices (vertices), of triangle meshes, polygon meshes, point clouds (meshes
/// without faces, normals in the soup where there are any) and the boundaries of voxels (with their
/// corrected normals, see boundary_of_voxels) [length of the input], +inf on components of the mesh
/// that no source reaches and at vertices without a face.
///
/// The report gets method, domain, all options with the values used, sizes and seconds per stage,
/// and the components without a source. Throws InputError and UnsupportedError for bad input before
/// anything is factored, SolveError if a solve breaks down, Cancelled.
VecX surface_distance(const SurfaceMesh& mesh, const SurfaceSources& sources,
                      const DistanceRequest& request, Task task, Report& report,
                      const MatX3* face_normals = nullptr);

/// The same, with what the method has to show beside the values.
SurfaceResult solve_distance(const SurfaceMesh& mesh, const SurfaceSources& sources,
                             const DistanceRequest& request, Task task, Report& report,
                             const MatX3* face_normals = nullptr);

}  // namespace littoral
