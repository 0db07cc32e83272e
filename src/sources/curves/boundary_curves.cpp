#include "sources/curves/boundary_curves.h"

#include <string>

namespace littoral {

std::vector<Curve> boundary_curves(const SurfaceMesh& mesh) {
  std::vector<std::vector<int>> at(mesh.n_vertices());  // edges
  std::vector<int> on_boundary;
  for (int e = 0; e < mesh.n_edges(); ++e) {
    if (mesh.edge_faces(e).size() != 1 || mesh.edges()(e, 0) == mesh.edges()(e, 1)) continue;
    on_boundary.push_back(e);
    for (int k = 0; k < 2; ++k) at[mesh.edges()(e, k)].push_back(e);
  }
  std::vector<char> walked(mesh.n_edges(), 0);
  std::vector<Curve> curves;
  for (int first : on_boundary) {
    if (walked[first]) continue;
    Curve curve;
    curve.is_signed = false;
    curve.origin = "boundary loop " + std::to_string(curves.size());
    int v = mesh.edges()(first, 0);
    curve.nodes.push_back(SurfacePoint::at_vertex(v));
    // Every vertex has an even number of these edges, but for faces that repeat a vertex: a walk
    // ends where it began, or at such a face.
    for (int e = first; e >= 0;) {
      walked[e] = 1;
      v = mesh.edges()(e, 0) == v ? mesh.edges()(e, 1) : mesh.edges()(e, 0);
      curve.nodes.push_back(SurfacePoint::at_vertex(v));
      e = -1;
      for (int other : at[v])
        if (!walked[other]) {
          e = other;
          break;
        }
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace littoral
