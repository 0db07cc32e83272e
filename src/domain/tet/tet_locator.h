#pragma once
// Which tet of any tet mesh holds a point.

#include <vector>

#include "domain/tet/tet_lattice.h"
#include "spatial/cluster_tree.h"

namespace littoral {

/// Boxes over the tets of a mesh, which may overlap, be inverted or have gaps; flat tets and those
/// with a corner that is not finite hold nothing. Keeps a reference to the mesh. Immutable.
class TetLocator {
 public:
  explicit TetLocator(const TetMesh& mesh);

  /// The tet that holds x most centrally (of those that share a face, either); tet -1 where the
  /// smallest barycentric coordinate is below -1e-6 in all.
  TetPoint locate(const Vec3& x) const;

 private:
  struct Box {
    Vec3 low, high;
  };
  const TetMesh& mesh_;
  std::vector<int> tets_;   // that count
  ClusterTree tree_;        // over tets_
  std::vector<Box> boxes_;  // per cluster
};

/// Mean length of the edges of the tets [length], each tet's edges counted; 0 without tets.
double mean_edge(const TetMesh& mesh, const std::vector<int>& tets);

/// The faces that one tet alone has, outward: faces x 3 by vertex.
MatX3i boundary_faces(const TetMesh& mesh);

}  // namespace littoral
