#include "domain/mesh/covering_mesh.h"

#include <algorithm>

#include "domain/intrinsic/tufted_cover.h"

namespace littoral {

CoveringMesh covering_mesh(const SurfaceMesh& mesh, const IntrinsicTriangulation& T) {
  const TuftedCover cover(MatX3(mesh.points() / T.unit), T.faces.matrix());
  const int n = cover.faces().size();
  PolygonSoup soup;
  soup.points = mesh.points();
  std::vector<int> edge_of_side;
  for (int f = 0; f < n; ++f) {
    soup.add_face(cover.faces()[f].v);
    for (int k = 0; k < 3; ++k)
      edge_of_side.push_back(std::min(3 * f + k, cover.faces()[f].twin[k]));
  }
  CoveringMesh out{SurfaceMesh(std::move(soup), edge_of_side), T};
  IntrinsicTriangulation& C = out.T;
  C.edges = out.mesh.shared_edges();
  C.faces = out.mesh.shared_faces();
  C.side_edge = out.mesh.shared_side_edges();
  C.along.resize(n, 3);
  C.length.resize(n, 3);
  C.orientation.assign(n, 1);
  C.seams.resize(0, 3);
  C.edge_use.assign(C.n_edges(), 2);
  C.triangle_of_face = FaceTriangles(n);
  for (int f = 0; f < n; ++f)
    for (int k = 0; k < 3; ++k) {
      C.along(f, k) = out.mesh.side_along(f, k) ? 1 : -1;
      C.length(f, k) = T.length(f / 2, f % 2 ? 2 - k : k);
    }
  return out;
}

}  // namespace littoral
