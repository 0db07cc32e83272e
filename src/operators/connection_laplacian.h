#pragma once
// The connection Laplacian of Crouzeix-Raviart vectors on the edges of triangles (signed heat
// method, section 5).

#include <memory>

#include "base/task.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "solve/direct/hermitian_rows.h"

namespace littoral {

/// Edges x edges, lower triangle; for triangulations without seams.
SpMatC connection_laplacian(const IntrinsicTriangulation& T, const Task& task);

/// The same made row by row from the triangulation, which is shared.
std::shared_ptr<const HermitianRows<Complex>> connection_rows(
    std::shared_ptr<const IntrinsicTriangulation> T);

/// The same as 2 x 2 real blocks S_row R S_col with R the rotation-scaling of an entry and S =
/// diag(1, -1) at a seam: conjugation is linear over the reals only.
SpMat connection_laplacian_real(const IntrinsicTriangulation& T);

}  // namespace littoral
