#pragma once
// A problem on a surface as operators and source terms, for methods that see nothing else.

#include <memory>
#include <string>
#include <vector>

#include "api/surface/surface_method.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "operators/calculus.h"
#include "sources/source_terms.h"

namespace littoral {

/// The domains that `translate_nodes` knows, and triangle meshes.
const std::vector<std::string>& all_surfaces();

struct Translated {
  std::shared_ptr<const Operators> ops;
  SourceTerms terms;
  std::shared_ptr<const IntrinsicTriangulation> triangulation;  // of the input itself, or none
  std::shared_ptr<const SurfaceMesh> faces;                     // of a cloud: something to look at
};

/// A polygon mesh, a point cloud or a voxel surface, with vectors at nodes: the first 5 % of a
/// task.
Translated translate_nodes(const SurfaceProblem& problem, Task& task, Report& report);

/// Values at the vertices of the input, which come first; a cloud is shown with triangles.
SurfaceResult at_input(const SurfaceProblem& problem, const SurfaceMesh* faces, const VecX& values);

}  // namespace littoral
