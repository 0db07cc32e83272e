#pragma once
// The boundary of a set of voxels.

#include <vector>

#include "domain/mesh/surface_mesh.h"
#include "littoral/volume.h"

namespace littoral {

/// Unit squares between voxels inside and outside, with normals that do not know about the grid.
struct VoxelSurface {
  SurfaceMesh mesh;          // quads, counter-clockwise seen from outside
  MatX3 face_normals{0, 3};  // quads x 3, unit, outward: the corrected normals
};

/// The boundary quads of the voxels that are not 0; the outside of the grid is 0. Voxels are
/// centred at the grid's nodes.
///
/// A corrected normal points from the centroid of the voxels inside a ball about the quad's centre
/// to that centre (the integral invariant of Pottmann et al. 2007; multigrid convergent:
/// Coeurjolly, Lachaud, Levallois 2014). The ball's radius is 0.5 n^(2/3) voxels, n being the
/// extent of the set in voxels, within [2.5, 10]. Throws InputError if no voxel is set or the quads
/// are too many to number.
VoxelSurface boundary_of_voxels(const Grid& grid, const std::vector<unsigned char>& inside);

}  // namespace littoral
