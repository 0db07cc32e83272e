#pragma once
// The regularized method of one triangle mesh, for callers that measure from many sources.

#include <memory>

#include "base/report.h"
#include "base/task.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "domain/mesh/surface_mesh.h"
#include "methods/regularized/regularized.h"
#include "operators/p2.h"
#include "sources/pieces.h"

namespace littoral {

/// Everything that sources share: directions read and interpolated, elements, one factorization.
/// Immutable.
class RegularizedSurface {
 public:
  /// mesh and T are referred to. Throws InputError for bad directions, UnsupportedError for a
  /// regularizer that the elements do not have.
  RegularizedSurface(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                     const RegularizedOptions& options, const Task& task, Report& report);

  /// At the nodes [length of the input]: those of the vertices come first.
  VecX solve(const PreparedSources& sources, const RegularizedOptions& options, const Task& task,
             Report& report) const;

  /// The quadratic elements, if those were asked for.
  const P2Elements<2>* quadratic() const { return elements_.get(); }

 private:
  const SurfaceMesh& mesh_;
  const IntrinsicTriangulation& T_;
  std::shared_ptr<const P2Elements<2>> elements_;
  std::unique_ptr<const Regularized> method_;
};

}  // namespace littoral
