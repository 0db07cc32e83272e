#pragma once
// The boundary of voxels without its steps.

#include "domain/mesh/surface_mesh.h"

namespace littoral {

/// The same faces with vertices moved along their normals, as little as makes edges at right angles
/// to the corrected normals (faces x 3, unit).
///
/// A chord of a smooth surface is at right angles to the sum of the normals at its ends, to third
/// order. So with vertices p_v + h_v n_v, n_v the mean of the normals around, the h minimise
///     sum over edges vw of ((p_w + h_w n_w - p_v - h_v n_v) . m)^2 + stay^2 sum of h_v^2,
/// m the unit vector along n_v + n_w. Lengths on what results are those of the surface that was
/// sampled; on the steps themselves they are up to sqrt(3) times as long, however fine the grid.
PolygonSoup flattened_voxels(const SurfaceMesh& mesh, const MatX3& face_normals);

}  // namespace littoral
