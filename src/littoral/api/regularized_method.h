#pragma once
// The regularized method of one mesh, for callers that measure from many sources.

#include <memory>

#include "littoral/base/report.h"
#include "littoral/base/task.h"
#include "littoral/domain/intrinsic_triangulation.h"
#include "littoral/domain/surface_mesh.h"
#include "littoral/methods/regularized.h"

namespace littoral {

/// Reads and interpolates what the options name and factors what all sources share. ops: those of
/// T, which is the mesh's. Throws InputError for bad directions.
Regularized regularized_on(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                           const std::shared_ptr<const Operators>& ops,
                           const RegularizedOptions& options, const Task& task, Report& report);

}  // namespace littoral
